//! A city in a thin slab: towers of rectangles, houses of triangles and trees of spheres on one floor polygon.
//!
//! The scene's box is 1 x 1 x 0.05, so that the long axes matter and the short one hardly does; the floor is larger
//! than all else together and lies in a face of the box.

use glam::DVec3;

use crate::geom::{Objects, Polygon, Sphere, Triangle};
use crate::scene::Random;

/// Objects of a tower (rectangles), a house (triangles) and a tree (a sphere).
const BLOCK: usize = 5 + 10 + 1;

/// Height of the tallest towers.
const HEIGHT: f64 = 0.05;

/// The floor, as many blocks of tower, house and tree as there is room for, and trees for the rest.
pub(super) fn objects(n: usize, mut random: Random) -> Objects {
    let floor = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut objects = Objects {
        polygons: vec![polygon(floor.map(|[x, y]| DVec3::new(x, y, 0.0)))],
        ..Objects::default()
    };
    // One lot per building or tree, on a square grid.
    let (blocks, rest) = ((n - 1) / BLOCK, (n - 1) % BLOCK);
    let lots = 3 * blocks + rest;
    let mut side = 1;
    while side * side < lots {
        side += 1;
    }
    let width = 1.0 / side as f64;
    for lot in 0..lots {
        let corner = DVec3::new((lot % side) as f64, (lot / side) as f64, 0.0) * width;
        let kind = if lot < 3 * blocks { lot % 3 } else { 2 };
        if kind == 2 {
            let radius = random.between(0.1, 0.3) * width.min(HEIGHT);
            let room = width - 2.0 * radius;
            let aside = DVec3::new(random.uniform(), random.uniform(), 0.0);
            let centre = corner + radius + room * aside;
            objects.spheres.push(Sphere { centre, radius });
            continue;
        }
        // A building leaves some of its lot free on every side.
        let lo = corner + width * 0.3 * DVec3::new(random.uniform(), random.uniform(), 0.0);
        let size = DVec3::new(random.between(0.4, 0.65), random.between(0.4, 0.65), 0.0);
        let hi = lo + width * size;
        let height = HEIGHT
            * if kind == 0 {
                random.between(0.3, 1.0)
            } else {
                random.between(0.05, 0.3)
            };
        for face in open_box(lo, hi.with_z(height)) {
            if kind == 0 {
                objects.polygons.push(polygon(face));
            } else {
                let [a, b, c, d] = face;
                objects
                    .triangles
                    .extend([Triangle([a, b, c]), Triangle([a, c, d])]);
            }
        }
    }
    objects
}

fn polygon(corners: [DVec3; 4]) -> Polygon {
    Polygon::new(corners.into()).expect("a rectangle is a polygon")
}

/// The roof and the four walls of a box, seen counter-clockwise from outside.
fn open_box(lo: DVec3, hi: DVec3) -> [[DVec3; 4]; 5] {
    let ground = [lo, lo.with_x(hi.x), hi.with_z(lo.z), lo.with_y(hi.y)];
    let wall = |i: usize| {
        let (a, b) = (ground[i], ground[(i + 1) % 4]);
        [a, b, b.with_z(hi.z), a.with_z(hi.z)]
    };
    [
        ground.map(|p| p.with_z(hi.z)),
        wall(0),
        wall(1),
        wall(2),
        wall(3),
    ]
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;
    use glam::DVec3;

    #[test]
    fn a_slab_with_everything_on_the_floor() {
        let scene = Scene::load("simple:flat").expect("a scene");
        assert_eq!(scene.world.lo, DVec3::ZERO);
        assert_eq!((scene.world.hi.x, scene.world.hi.y), (1.0, 1.0));
        assert!((0.045..=0.05).contains(&scene.world.hi.z));
        assert_eq!(scene.counts(), "1240 triangles, 139 spheres, 621 polygons");
    }
}
