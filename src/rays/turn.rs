//! Sines and cosines of parts of a full turn: to the bit those of `libm::sincos`, many at a time.
//!
//! The arithmetic is FreeBSD's (msun: `e_rem_pio2.c`, `k_sin.c`, `k_cos.c`), as libm has it, but without a branch:
//!
//! > Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved. Developed at SunSoft, a Sun Microsystems, Inc. business.
//! > Permission to use, copy, modify, and distribute this software is freely granted, provided that this notice is preserved.

use std::f64::consts::{FRAC_PI_8, TAU};

/// 1.5 * 2^52: added to a small number and taken off again, it leaves the nearest integer.
const TO_INTEGER: f64 = 1.5 / f64::EPSILON;
/// 2 / pi.
const QUADRANTS: f64 = f64::from_bits(0x3fe4_5f30_6dc9_c883);
/// The first 33 bits of pi / 2, so that small multiples are exact.
const QUADRANT: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
/// What is left of pi / 2.
const QUADRANT_TAIL: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);
/// Of sin(x) = x + S1 x^3 + ... + S6 x^13.
const SINE: [f64; 6] = [
    f64::from_bits(0xbfc5_5555_5555_5549),
    f64::from_bits(0x3f81_1111_1110_f8a6),
    f64::from_bits(0xbf2a_01a0_19c1_61d5),
    f64::from_bits(0x3ec7_1de3_57b1_fe7d),
    f64::from_bits(0xbe5a_e5e6_8a2b_9ceb),
    f64::from_bits(0x3de5_d93a_5acf_d57c),
];
/// Of cos(x) = 1 - x^2 / 2 + C1 x^4 + ... + C6 x^14.
const COSINE: [f64; 6] = [
    f64::from_bits(0x3fa5_5555_5555_554c),
    f64::from_bits(0xbf56_c16c_16c1_5177),
    f64::from_bits(0x3efa_01a0_19cb_1590),
    f64::from_bits(0xbe92_7e4f_809c_52ad),
    f64::from_bits(0x3e21_ee9e_bdb4_b1c4),
    f64::from_bits(0xbda8_fae9_be88_38d4),
];
/// Nearer than this to a multiple of pi / 4, libm takes more care: it may keep more digits, or take x to the other quadrant.
const CARE: f64 = 1.0 / (1 << 17) as f64;

/// The sine and the cosine of `TAU * u` for each part u of a turn, in (0, 1), written to the start of the two slices.
#[inline(always)]
pub(super) fn sines_and_cosines(turns: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let n = turns.len();
    let (sines, cosines) = (&mut sines[..n], &mut cosines[..n]);
    let mut all = true;
    for k in 0..n {
        let ([s, c], sure) = sine_and_cosine(TAU * turns[k]);
        (sines[k], cosines[k]) = (s, c);
        all &= sure;
    }
    // One angle in 2^16 pi / 4, or 51,000.
    if !all {
        for k in 0..n {
            (sines[k], cosines[k]) = libm::sincos(TAU * turns[k]);
        }
    }
}

/// The sine and the cosine of `x` in (0, 2 pi), and whether they are surely those of libm.
#[inline(always)]
fn sine_and_cosine(x: f64) -> ([f64; 2], bool) {
    // The nearest multiple of pi / 2, and x without it: y + tail.
    let n = (x * QUADRANTS + TO_INTEGER) - TO_INTEGER;
    let r = x - n * QUADRANT;
    let w = n * QUADRANT_TAIL;
    let y = r - w;
    let tail = (r - y) - w;

    let z = y * y;
    let w = z * z;
    let [s1, s2, s3, s4, s5, s6] = SINE;
    let r = s2 + z * (s3 + z * s4) + z * w * (s5 + z * s6);
    let v = z * y;
    // What needed no reduction has no tail, and is rounded in another order.
    let sine = if n == 0.0 {
        y + v * (s1 + z * r)
    } else {
        y - ((z * (0.5 * tail - v * r) - tail) - v * s1)
    };
    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let r = z * (c1 + z * (c2 + z * c3)) + w * w * (c4 + z * (c5 + z * c6));
    let half = 0.5 * z;
    let w = 1.0 - half;
    let cosine = w + (((1.0 - w) - half) + (z * r - y * tail));

    let odd = (n == 1.0) | (n == 3.0);
    let (s, c) = if odd { (cosine, sine) } else { (sine, cosine) };
    let s = negated_if((n - 2.5).abs() < 1.0, s);
    let c = negated_if((n - 1.5).abs() < 1.0, c);
    let sure = (y.abs() - FRAC_PI_8).abs() < FRAC_PI_8 - CARE;
    ([s, c], sure)
}

/// `x`, with its sign turned if so.
#[inline(always)]
pub(super) fn negated_if(so: bool, x: f64) -> f64 {
    f64::from_bits(x.to_bits() ^ (u64::from(so) << 63))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::super::address::{Purpose, generator, uniform};
    use super::*;

    /// These angles' sines and cosines, made together, are those of libm to the bit.
    fn check(turns: &[f64]) {
        let mut found = [vec![0.0; turns.len()], vec![0.0; turns.len()]];
        let [sines, cosines] = &mut found;
        sines_and_cosines(turns, sines, cosines);
        for ((&turn, sine), cosine) in turns.iter().zip(sines).zip(cosines) {
            let (s, c) = libm::sincos(TAU * turn);
            let found = [sine.to_bits(), cosine.to_bits()];
            assert_eq!(found, [s.to_bits(), c.to_bits()], "{turn:e} of a turn");
        }
    }

    #[test]
    fn random_turns_are_those_of_libm() {
        let mut rng = generator(1, Purpose::Checks);
        for _ in 0..200_000 {
            let turns: [f64; 10] = std::array::from_fn(|_| uniform(&mut rng));
            check(&turns);
        }
    }

    #[test]
    fn turns_where_quadrants_and_their_halves_meet_are_those_of_libm() {
        for k in 0..=8 {
            let meeting = f64::from(k) / 8.0;
            for power in 1..=60 {
                for part in [1.0, 1.1, 1.37, 1.9] {
                    let off = part * 0.5_f64.powi(power);
                    for turn in [meeting - off, meeting, meeting + off] {
                        if 0.0 < turn && turn < 1.0 {
                            check(&[turn]);
                        }
                    }
                }
            }
        }
    }

    /// What libm is asked for is rare, and what it is not asked for is not what it would take more care with.
    #[test]
    fn libm_is_asked_where_it_takes_more_care_and_seldom_else() {
        let mut rng = generator(2, Purpose::Checks);
        let draws = 1_000_000;
        let asked = (0..draws)
            .filter(|_| !sine_and_cosine(TAU * uniform(&mut rng)).1)
            .count();
        // 19 expected of a million; fewer than 5 or more than 40 have a chance below 1e-4.
        assert!((5..=40).contains(&asked), "{asked} of {draws}");
        for k in 1..=8 {
            let x = f64::from(k) * FRAC_PI_4;
            // libm looks at the upper half of a number alone.
            let step = f64::from_bits(((x.to_bits() >> 32) + 1) << 32) - x;
            for x in [x - step, x, x + step] {
                assert!(!sine_and_cosine(x).1, "{x}");
            }
        }
    }
}
