//! Which vector instructions divide lists: found out at run time, the same results whichever they are.

use glam::{DVec3, Vec3};

use crate::geom::{Ray, Triangle, Vector};

use super::lists::{Cut, Entries, divide};
#[cfg(target_arch = "x86_64")]
use super::{avx2, avx512};

/// A set of instructions that this processor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lanes(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Lanes {
    /// Plain Rust, for every processor: the reference for all others.
    pub const PORTABLE: Self = Self(Set::Portable);

    /// All that this processor has, the widest last.
    pub fn available() -> Vec<Self> {
        let mut found = vec![Self::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") {
                found.push(Self(Set::Avx2));
            }
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
                found.push(Self(Set::Avx512));
            }
        }
        found
    }

    /// The widest that this processor has.
    pub fn widest() -> Self {
        Self::available().pop().unwrap_or(Self::PORTABLE)
    }

    /// The name in tables.
    pub const fn name(self) -> &'static str {
        match self.0 {
            Set::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => "AVX-512",
        }
    }
}

/// Only the points below are [`Lane`]s: what it does is no one else's to define.
mod sealed {
    pub trait Sealed {}
    impl Sealed for glam::DVec3 {}
    impl Sealed for glam::Vec3 {}
}

/// Points of numbers that lists are made of: `DVec3` and `Vec3`.
pub trait Lane: Vector + sealed::Sealed {
    /// [`divide`] with these instructions.
    #[doc(hidden)]
    fn divide(
        lanes: Lanes,
        cut: &Cut<Self::Real>,
        list: Entries<Self::Real>,
        near: Entries<Self::Real>,
        n: usize,
    ) -> (usize, usize);

    /// Call `pass(i, place)` for each ray of a list, by place, and each triangle, with its place, whose edges let the ray
    /// pass; or for all of them, where there are no instructions for many at once.
    #[doc(hidden)]
    fn sieve<'t>(
        lanes: Lanes,
        rays: &[Ray<Self>],
        list: &[u32],
        triangles: impl Iterator<Item = (usize, &'t Triangle<Self>)> + Clone,
        pass: impl FnMut(usize, usize),
    ) where
        Self: 't;
}

macro_rules! lane {
    ($vector:ident, $real:ident, $sieve:ident) => {
        impl Lane for $vector {
            #[inline(always)]
            #[cfg_attr(target_arch = "x86_64", allow(unsafe_code))]
            fn divide(
                lanes: Lanes,
                cut: &Cut<$real>,
                list: Entries<$real>,
                near: Entries<$real>,
                n: usize,
            ) -> (usize, usize) {
                match lanes.0 {
                    Set::Portable => divide(cut, list, near, n),
                    // SAFETY: such a value is only made where the processor has the instructions.
                    #[cfg(target_arch = "x86_64")]
                    Set::Avx2 => unsafe { avx2::$real(cut, list, near, n) },
                    // SAFETY: as above.
                    #[cfg(target_arch = "x86_64")]
                    Set::Avx512 => unsafe { avx512::$real(cut, list, near, n) },
                }
            }

            #[inline(always)]
            #[cfg_attr(target_arch = "x86_64", allow(unsafe_code))]
            fn sieve<'t>(
                lanes: Lanes,
                rays: &[Ray<Self>],
                list: &[u32],
                triangles: impl Iterator<Item = (usize, &'t Triangle<Self>)> + Clone,
                mut pass: impl FnMut(usize, usize),
            ) {
                match lanes.0 {
                    // SAFETY: such a value is only made where the processor has the instructions.
                    #[cfg(target_arch = "x86_64")]
                    Set::Avx512 => unsafe { avx512::$sieve(rays, list, triangles, pass) },
                    _ => {
                        for i in 0..list.len() {
                            for (place, _) in triangles.clone() {
                                pass(i, place);
                            }
                        }
                    }
                }
            }
        }
    };
}

lane!(DVec3, f64, sieve_f64);
lane!(Vec3, f32, sieve_f32);
