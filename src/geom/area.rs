//! Areas of objects and of their parts in a box.

use super::{Aabb, Clipper, Object, Objects};

impl Object<'_> {
    /// Area of the surface, one side of it.
    pub fn area(self) -> f64 {
        match self {
            Self::Triangle(triangle) => triangle.area(),
            Self::Sphere(sphere) => sphere.area(),
            Self::Cone(cone) => cone.area(),
            Self::Polygon(polygon) => polygon.area(),
        }
    }

    /// Whether a line may cross it twice, as it does a sphere or a cone.
    pub fn is_round(self) -> bool {
        matches!(self, Self::Sphere(_) | Self::Cone(_))
    }
}

impl Objects {
    /// Area of the part of object `number` inside `region`, given the object's box. Exact for triangles and polygons; of
    /// spheres and cones the region is given the share of the area that it has of the box.
    ///
    /// For a sphere cut by planes across one axis that share is exact too (Archimedes).
    pub fn area_within(
        &self,
        number: u32,
        bounds: &Aabb,
        region: &Aabb,
        clipper: &mut Clipper,
    ) -> f64 {
        let object = self.get(number);
        let whole = object.area();
        if region.contains(bounds) {
            return whole;
        }
        // Rounding gives no part more than the whole, and none to what has no area.
        match object {
            Object::Triangle(triangle) => clipper.area(&triangle.0, region).min(whole),
            Object::Polygon(polygon) => clipper.area(polygon.corners(), region).min(whole),
            Object::Sphere(_) | Object::Cone(_) => whole * share(bounds, region),
        }
    }
}

/// The share of a box that lies in a region; along sides without length, all.
fn share(bounds: &Aabb, region: &Aabb) -> f64 {
    let common = bounds.hi.min(region.hi) - bounds.lo.max(region.lo);
    let extent = bounds.extent();
    let along = |k: usize| {
        if extent[k] > 0.0 {
            common[k].max(0.0) / extent[k]
        } else {
            1.0
        }
    };
    along(0) * along(1) * along(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Cone, Polygon, Sphere, Triangle};
    use glam::DVec3;

    fn v(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// A slanted triangle, a sphere, a cone, and a U with arms up to y = 2 and a notch down to y = 1.
    fn objects() -> Objects {
        let u = [
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 2.0),
            (2.0, 2.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 2.0),
            (0.0, 2.0),
        ];
        Objects {
            triangles: vec![Triangle([
                v(0.1, 0.7, -0.3),
                v(1.3, -0.2, 0.4),
                v(-0.6, 0.05, 1.1),
            ])],
            spheres: vec![Sphere {
                centre: v(1.0, 2.0, 3.0),
                radius: 2.0,
            }],
            cones: vec![Cone {
                base: DVec3::ZERO,
                base_radius: 1.0,
                apex: v(0.3, -0.4, 2.0),
                apex_radius: 0.5,
            }],
            polygons: vec![Polygon::new(u.map(|(x, y)| v(x, y, 0.0)).into()).expect("a polygon")],
        }
    }

    #[test]
    fn parts_add_up_to_the_whole() {
        let objects = objects();
        let mut clipper = Clipper::default();
        for number in 0..4 {
            let bounds = objects.get(number).bounds();
            let mut sum = 0.0;
            let (below, above) = bounds.split(0, 0.7 * bounds.lo.x + 0.3 * bounds.hi.x);
            for half in [below, above] {
                let (front, back) = half.split(1, 0.4 * bounds.lo.y + 0.6 * bounds.hi.y);
                for region in [front, back] {
                    sum += objects.area_within(number, &bounds, &region, &mut clipper);
                }
            }
            let area = objects.get(number).area();
            assert!(
                (sum / area - 1.0).abs() < 1e-14,
                "{number}: {sum} of {area}"
            );
        }
    }

    #[test]
    fn parts_known_by_hand() {
        let objects = objects();
        let within = |number, lo: DVec3, hi: DVec3| {
            let bounds = objects.get(number).bounds();
            let region = Aabb::new(lo, hi);
            objects.area_within(number, &bounds, &region, &mut Clipper::default())
        };
        // Both arms of the U above its notch, and nothing between them.
        assert_eq!(within(3, v(0.0, 1.5, -1.0), v(3.0, 2.0, 1.0)), 1.0);
        assert_eq!(within(3, v(1.25, 1.5, -1.0), v(1.75, 2.0, 1.0)), 0.0);
        // A sphere's slice by Archimedes: its share of the height.
        let slice = within(1, v(-1.0, 0.0, 1.0), v(3.0, 4.0, 2.0));
        assert!((slice / objects.get(1).area() - 0.25).abs() < 1e-15);
        // Nothing of it far away, all of it inside.
        assert_eq!(within(1, v(5.0, 5.0, 5.0), v(6.0, 6.0, 6.0)), 0.0);
        assert_eq!(
            within(1, v(-9.0, -9.0, -9.0), v(9.0, 9.0, 9.0)),
            objects.get(1).area()
        );
    }
}
