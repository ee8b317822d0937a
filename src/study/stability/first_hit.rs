//! A ray against one curved or flat object in `f64`: where it first hits, against what is right by hand.

use glam::DVec3;

use crate::geom::{Line, Object, Ray, Span};
use crate::study::incidence::TIE;

use super::case::{Case, Check, Finding, Group, Outcome};

/// A ray against an object, and the t of its first hit by hand.
pub struct First {
    /// Where t is 0.
    pub origin: [f64; 3],
    /// Direction: t counts in units of it.
    pub direction: [f64; 3],
    /// Where the ray begins.
    pub from: f64,
    /// The first hit, exactly.
    pub t: Option<f64>,
}

/// A line, of all t.
pub const fn line(origin: [f64; 3], direction: [f64; 3], t: Option<f64>) -> First {
    First {
        origin,
        direction,
        from: f64::NEG_INFINITY,
        t,
    }
}

/// A ray from t = 0 on.
pub const fn ray(origin: [f64; 3], direction: [f64; 3], t: Option<f64>) -> First {
    First {
        origin,
        direction,
        from: 0.0,
        t,
    }
}

impl First {
    /// The ray, with the constants of the object tests.
    pub fn as_ray(&self) -> Ray {
        let line = Line::new(self.origin.into(), self.direction.into());
        Ray::new(line, Span::from(self.from))
    }

    /// What an object's test makes of it: t may be off by less than 8 ulp, which is told; a hit may be neither made up nor missed.
    pub fn check(&self, object: Object<'_>) -> Finding {
        let ray = self.as_ray();
        let found = match object {
            Object::Triangle(triangle) => triangle.intersect(&ray),
            Object::Sphere(sphere) => sphere.intersect(&ray),
            Object::Cone(cone) => cone.intersect(&ray),
            Object::Polygon(polygon) => polygon.intersect(&ray),
        };
        let told = |t: Option<f64>| t.map_or("miss".into(), |t| format!("t = {t:?}"));
        let outcome = match (self.t, found) {
            (None, None) => Outcome::Pass,
            (Some(right), Some(t)) => {
                let ulps = (t - right).abs() / (f64::EPSILON * right.abs());
                match ulps {
                    _ if t == right => Outcome::Pass,
                    _ if ulps < TIE => Outcome::Off(ulps),
                    _ => Outcome::Failed,
                }
            }
            _ => Outcome::Failed,
        };
        Finding {
            expected: told(self.t),
            measured: told(found),
            outcome,
            demanded: true,
        }
    }
}

/// A case that is checked once.
pub fn once(
    group: Group,
    name: &'static str,
    stresses: &'static str,
    check: fn() -> Finding,
) -> Case {
    Case {
        name,
        group,
        stresses,
        check: Check::Once(check),
    }
}

/// A point on a grid of whole numbers.
pub fn whole(p: [i64; 3]) -> DVec3 {
    DVec3::from(p.map(|k| k as f64))
}
