//! Maps of space that round nothing, applied to trees, objects and lines.

use glam::DVec3;

use crate::geom::{Aabb, Axis, Cone, Line, Objects, Polygon, Sphere, Triangle};
use crate::kd::{Node, NodeKind, Tree};
use crate::study::AXES;

/// A map of space that rounds nothing.
#[derive(Clone, Copy, Debug)]
pub struct Transform {
    /// Power of two that lengths are multiplied by.
    exponent: i32,
    /// Which axes are turned round.
    reflected: [bool; 3],
    /// The axis that becomes x, y and z.
    axes: [Axis; 3],
}

pub(super) const NONE: Transform = Transform {
    exponent: 0,
    reflected: [false; 3],
    axes: [0, 1, 2],
};

pub(super) const fn scale(exponent: i32) -> Transform {
    Transform { exponent, ..NONE }
}

const fn reflect(reflected: [bool; 3]) -> Transform {
    Transform { reflected, ..NONE }
}

const fn permute(axes: [Axis; 3]) -> Transform {
    Transform { axes, ..NONE }
}

/// The transforms that are tried.
pub const TRANSFORMS: [Transform; 14] = [
    scale(-100),
    scale(-30),
    scale(10),
    scale(40),
    scale(100),
    reflect([true, false, false]),
    reflect([false, true, false]),
    reflect([false, false, true]),
    reflect([true; 3]),
    permute([1, 2, 0]),
    permute([2, 0, 1]),
    permute([0, 2, 1]),
    permute([1, 0, 2]),
    permute([2, 1, 0]),
];

impl Transform {
    /// The name in files.
    pub fn name(&self) -> String {
        if self.exponent != 0 {
            return format!("scale 2^{}", self.exponent);
        }
        let turned: String = (0..3)
            .filter(|&k| self.reflected[k])
            .map(|k| AXES[k])
            .collect();
        if turned.is_empty() {
            format!("axes {}", self.axes.map(|k| AXES[k]).concat())
        } else {
            format!("reflect {turned}")
        }
    }

    pub(super) fn scale(&self) -> f64 {
        libm::ldexp(1.0, self.exponent)
    }

    /// A direction: not scaled, so that t is.
    fn direction(&self, d: DVec3) -> DVec3 {
        let turned = |k: Axis| if self.reflected[k] { -d[k] } else { d[k] };
        DVec3::from_array(self.axes.map(turned))
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.scale() * self.direction(p)
    }

    fn bounds(&self, b: &Aabb) -> Aabb {
        Aabb::around([self.point(b.lo), self.point(b.hi)])
    }

    pub(super) fn line(&self, line: &Line) -> Line {
        Line::new(self.point(line.origin), self.direction(line.direction))
    }

    /// The tree, and the new number of each of its nodes: below a plane that is turned round, the children trade places.
    pub(super) fn tree(&self, tree: &Tree) -> (Tree, Vec<u32>) {
        let mut number: Vec<u32> = (0..tree.nodes.len() as u32).collect();
        let mut moved = tree.clone();
        for (i, node) in tree.nodes.iter().enumerate() {
            let new = number[i] as usize;
            moved.boxes[new] = self.bounds(&tree.boxes[i]);
            moved.nodes[new] = *node;
            if let NodeKind::Inner { axis, split, left } = node.kind() {
                let mut plane = DVec3::ZERO;
                plane[axis] = split;
                let to = self.axes.iter().position(|&k| k == axis).unwrap_or(axis);
                moved.nodes[new] = Node::inner(to, self.point(plane)[to], left);
                if self.reflected[axis] {
                    number.swap(left as usize, left as usize + 1);
                }
            }
        }
        moved.world = self.bounds(&tree.world);
        (moved, number)
    }

    pub(super) fn objects(&self, objects: &Objects) -> Option<Objects> {
        let s = self.scale();
        let polygon =
            |p: &Polygon| Polygon::new(p.corners().iter().map(|&c| self.point(c)).collect());
        Some(Objects {
            triangles: objects
                .triangles
                .iter()
                .map(|t| Triangle(t.0.map(|p| self.point(p))))
                .collect(),
            spheres: objects
                .spheres
                .iter()
                .map(|sphere| Sphere {
                    centre: self.point(sphere.centre),
                    radius: s * sphere.radius,
                })
                .collect(),
            cones: objects
                .cones
                .iter()
                .map(|cone| Cone {
                    base: self.point(cone.base),
                    base_radius: s * cone.base_radius,
                    apex: self.point(cone.apex),
                    apex_radius: s * cone.apex_radius,
                })
                .collect(),
            polygons: objects
                .polygons
                .iter()
                .map(polygon)
                .collect::<Result<_, _>>()
                .ok()?,
        })
    }

    /// Whether sums of three products keep their order.
    pub(super) fn keeps_order(&self) -> bool {
        self.axes == [0, 1, 2]
    }
}
