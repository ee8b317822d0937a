//! Hit probabilities of boxes from directions alone: the offset of a line is integrated exactly.
//!
//! Of the lines of direction w that hit a box R, those that hit a box K in it make up the share A_K(w) / A_R(w) of their
//! shadows A(w) = sum_i |w_i| S_i, where S_i is the area of one face normal to axis i. Under the exact law a direction's
//! density is proportional to A_R(w), so m_i = mean of |w_i| / A_R(w) tends to 1 / sum_j S_j(R) on every axis, and
//! p(K) = sum_i m_i S_i(K) to SA(K) / SA(R). Three numbers give every node of a tree at once.
//!
//! It is the formula of the areas again: it checks how directions are drawn, and nothing of boxes, offsets or traversal.

use glam::DVec3;

use crate::geom::Aabb;

/// Means over the directions of lines that hit a box.
#[derive(Clone, Copy, Debug)]
pub struct Conditional {
    /// Areas of one face of the box normal to each axis.
    faces: DVec3,
    /// Sums of |w_i| / A_R(w).
    sums: DVec3,
    directions: u64,
}

impl Conditional {
    /// Nothing seen yet of lines that hit this box.
    pub fn new(world: &Aabb) -> Self {
        Self {
            faces: world.face_areas(),
            sums: DVec3::ZERO,
            directions: 0,
        }
    }

    /// See the direction of a line that hits the box; its length does not matter.
    #[inline]
    pub fn push(&mut self, direction: DVec3) {
        let w = direction.abs();
        self.sums += w / w.dot(self.faces);
        self.directions += 1;
    }

    /// The estimated share of the lines that hit a box inside the one they all hit. `None` before the first direction.
    pub fn hit_share(&self, inner: &Aabb) -> Option<f64> {
        let means = self.sums / self.directions as f64;
        (self.directions > 0).then(|| means.dot(inner.face_areas()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rays::{LineLaw, PointSet, Sampler};

    const WORLD: Aabb = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5));
    /// A sheet normal to x, the axis that uniform hemispheres favour most.
    const INNER: Aabb = Aabb::new(DVec3::new(0.1, 0.0, 0.0), DVec3::new(0.11, 0.7, 0.4));

    fn relative_error(directions: impl Iterator<Item = DVec3>) -> f64 {
        let mut mean = Conditional::new(&WORLD);
        directions.for_each(|w| mean.push(w));
        let share = mean.hit_share(&INNER).expect("directions");
        share * WORLD.surface_area() / INNER.surface_area() - 1.0
    }

    /// Over 32 replicates of 4096 points; the RMSE of a share is known to 13 %.
    #[test]
    fn directions_of_the_exact_law_give_the_ratio_of_areas() {
        let rmse = |sampler| {
            let replicate = |r| {
                let lines = PointSet::new(sampler, 2, r, 4096).lines(&WORLD, 0..4096);
                relative_error(lines.map(|line| line.direction))
            };
            let squares: f64 = (0..32).map(|r| replicate(r) * replicate(r)).sum();
            (squares / 32.0).sqrt()
        };
        let [random, stratified, sobol] = Sampler::ALL.map(rmse);
        assert!((0.001..0.02).contains(&random), "{random}");
        assert!(stratified < 0.5 * random, "{stratified} {random}");
        assert!(sobol < 0.2 * random, "{sobol} {random}");
    }

    #[test]
    fn it_sees_wrong_directions() {
        let of_law = |law: LineLaw| {
            relative_error((0..1 << 16).map(|i| law.sample(&WORLD, 1, i).0.direction)).abs()
        };
        assert!(of_law(LineLaw::Disc) < 0.005);
        assert!(of_law(LineLaw::UniformHemisphere) > 0.05);
        assert_eq!(Conditional::new(&WORLD).hit_share(&INNER), None);
    }
}
