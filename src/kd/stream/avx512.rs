//! Dividing lists and testing triangles with AVX-512: 8 lines of f64 or 16 of f32 at a time.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use glam::{DVec3, Vec3};

use crate::geom::{Frame, Ray, Triangle};

use super::lists::{Cut, Entries};

/// A function that divides lists of these numbers, the same arithmetic as [`divide`](super::lists::divide).
macro_rules! divide {
    (
        $name:ident, $lanes:literal, $mask:ty, $set1:ident, $load:ident, $store:ident, $sub:ident, $mul:ident, $add:ident,
        $abs:ident, $min:ident, $max:ident, $cmp:ident, $compress:ident, $load_line:ident, $store_line:ident,
        $compress_line:ident, $set1_line:ident, $min_line:ident, $gather:ident
    ) => {
        /// Divide the first `n` entries of a list, with the compress instructions of AVX-512.
        ///
        /// # Panics
        /// If an array is shorter than `n` rounded up to whole vectors, or there are no lines or more than 2^31.
        #[target_feature(enable = "avx512f,avx512vl")]
        pub(super) fn $name(
            cut: &Cut<$name>,
            list: Entries<$name>,
            near: Entries<$name>,
            n: usize,
        ) -> (usize, usize) {
            let room = n.next_multiple_of($lanes);
            let shortest = |e: &Entries<$name>| e.t0.len().min(e.t1.len()).min(e.line.len());
            assert!(room <= shortest(&list).min(shortest(&near)));
            assert!((1..=1 << 31).contains(&cut.lines.len()));
            let last_line = $set1_line((cut.lines.len() - 1) as i32);
            let Entries { t0, t1, line } = list;
            let position = $set1(cut.position);
            let padding = $set1(cut.padding);
            let most = $set1($name::MAX);
            let (mut near_n, mut far_n) = (0, 0);
            for i in (0..n).step_by($lanes) {
                let left = n - i;
                let live: $mask = if left < $lanes { (1 << left) - 1 } else { !0 };
                // SAFETY: i + lanes <= room, which every array holds. No number that is gathered is beyond the last line's, whatever
                // the entries that are not live hold.
                let (first, last, number, [origin, inverse]) = unsafe {
                    let number = $load_line(line.as_ptr().add(i).cast());
                    (
                        $load(t0.as_ptr().add(i)),
                        $load(t1.as_ptr().add(i)),
                        number,
                        $gather(cut.lines, $min_line(number, last_line), live),
                    )
                };
                let t = $mul($sub(position, origin), inverse);
                let slack = $min($mul(padding, $abs(t)), most);
                let (earliest, latest) = ($sub(t, slack), $add(t, slack));
                let goes_near = $cmp::<_CMP_GE_OQ>(latest, first) & live;
                let goes_far = $cmp::<_CMP_LE_OQ>(earliest, last) & live;
                let near_last = $min(last, latest);
                let far_first = $max(first, earliest);
                // SAFETY: near_n and far_n are at most i, so whole vectors end within the room; of the list itself, they
                // write over what has been read.
                unsafe {
                    $store(
                        near.t0.as_mut_ptr().add(near_n),
                        $compress(goes_near, first),
                    );
                    $store(
                        near.t1.as_mut_ptr().add(near_n),
                        $compress(goes_near, near_last),
                    );
                    $store_line(
                        near.line.as_mut_ptr().add(near_n).cast(),
                        $compress_line(goes_near, number),
                    );
                    $store(t0.as_mut_ptr().add(far_n), $compress(goes_far, far_first));
                    $store(t1.as_mut_ptr().add(far_n), $compress(goes_far, last));
                    $store_line(
                        line.as_mut_ptr().add(far_n).cast(),
                        $compress_line(goes_far, number),
                    );
                }
                near_n += goes_near.count_ones() as usize;
                far_n += goes_far.count_ones() as usize;
            }
            (near_n, far_n)
        }
    };
}

divide!(
    f64,
    8,
    __mmask8,
    _mm512_set1_pd,
    _mm512_loadu_pd,
    _mm512_storeu_pd,
    _mm512_sub_pd,
    _mm512_mul_pd,
    _mm512_add_pd,
    _mm512_abs_pd,
    _mm512_min_pd,
    _mm512_max_pd,
    _mm512_cmp_pd_mask,
    _mm512_maskz_compress_pd,
    _mm256_loadu_si256,
    _mm256_storeu_si256,
    _mm256_maskz_compress_epi32,
    _mm256_set1_epi32,
    _mm256_min_epu32,
    pairs_f64
);
divide!(
    f32,
    16,
    __mmask16,
    _mm512_set1_ps,
    _mm512_loadu_ps,
    _mm512_storeu_ps,
    _mm512_sub_ps,
    _mm512_mul_ps,
    _mm512_add_ps,
    _mm512_abs_ps,
    _mm512_min_ps,
    _mm512_max_ps,
    _mm512_cmp_ps_mask,
    _mm512_maskz_compress_ps,
    _mm512_loadu_si512,
    _mm512_storeu_si512,
    _mm512_maskz_compress_epi32,
    _mm512_set1_epi32,
    _mm512_min_epu32,
    pairs_f32
);

/// Origins and reciprocals of 8 lines, live or not.
///
/// # Safety
/// All numbers must be below the number of lines.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
unsafe fn pairs_f64(lines: &[[f64; 2]], number: __m256i, _: __mmask8) -> [__m512d; 2] {
    let mut numbers = [0; 8];
    // SAFETY: eight numbers fit.
    unsafe { _mm256_storeu_epi32(numbers.as_mut_ptr(), number) };
    // A gather takes longer than these loads and shuffles.
    // SAFETY: see above; a pair is two numbers.
    let pair = |i: usize| unsafe { _mm_loadu_pd(lines.as_ptr().add(numbers[i] as usize).cast()) };
    let four = |i: usize| {
        let [low, high] = [i, i + 4].map(|i| _mm256_set_m128d(pair(i + 2), pair(i)));
        _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high)
    };
    let (even, odd) = (four(0), four(1));
    [_mm512_unpacklo_pd(even, odd), _mm512_unpackhi_pd(even, odd)]
}

/// Origins and reciprocals of 16 lines, 0 of those that are not live.
///
/// # Safety
/// All numbers must be below the number of lines, and below 2^31, as a gather takes them with a sign.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
unsafe fn pairs_f32(lines: &[[f32; 2]], number: __m512i, live: __mmask16) -> [__m512; 2] {
    let base = lines.as_ptr().cast::<f64>();
    let halves = [
        (_mm512_castsi512_si256(number), live as u8),
        (_mm512_extracti64x4_epi64::<1>(number), (live >> 8) as u8),
    ];
    // A pair is gathered as one number of 64 bits; what is not live is left out, which is faster.
    let [low, high] = halves.map(|(half, live)| {
        // SAFETY: see above; a gather needs no alignment.
        let pairs = unsafe { _mm512_mask_i32gather_pd::<8>(_mm512_setzero_pd(), live, half, base) };
        _mm512_castpd_ps(pairs)
    });
    let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    let odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
    [even, odd].map(|index| _mm512_permutex2var_ps(low, index, high))
}

/// A function that tells which rays a triangle's edges let pass: the arithmetic of [`Triangle::intersect`] up to the signs of
/// its edge functions, for 8 rays at a time.
macro_rules! sieve {
    (
        $name:ident, $real:ident, $vector:ident, $row:ident, $transpose:ident, $corners:ident, $permute:ident, $index:ident,
        $add_index:ident, $sub:ident, $mul:ident, $cmp:ident, $zero:ident
    ) => {
        /// Call `pass(i, place)` for each ray of a list, by place, and each triangle, with its place, whose edges let the ray
        /// pass.
        ///
        /// # Panics
        /// If the list holds what is no ray's number.
        #[target_feature(enable = "avx512f,avx512vl")]
        pub(super) fn $name<'t>(
            rays: &[Ray<$vector>],
            list: &[u32],
            triangles: impl Iterator<Item = (usize, &'t Triangle<$vector>)> + Clone,
            mut pass: impl FnMut(usize, usize),
        ) {
            for (chunk, eight) in list.chunks(8).enumerate() {
                // Lanes that are left over repeat the last ray.
                let last = eight.len() - 1;
                let live = !0u8 >> (7 - last);
                let rows = [0, 1, 2, 3, 4, 5, 6, 7]
                    .map(|lane: usize| $row(&rays[eight[lane.min(last)] as usize].frame));
                let ([ox, oy, oz, sx, sy], [kx, ky, kz]) = $transpose(rows);
                for (place, triangle) in triangles.clone() {
                    let corners = $corners(triangle);
                    let [a, b, c] = [0, 3, 6].map(|first| {
                        let part = |axis| {
                            $permute(corners[0], $add_index(axis, $index(first)), corners[1])
                        };
                        let z = $sub(part(kz), oz);
                        [
                            $sub($sub(part(kx), ox), $mul(sx, z)),
                            $sub($sub(part(ky), oy), $mul(sy, z)),
                        ]
                    });
                    let (mut negative, mut positive) = (0, 0);
                    for (p, q) in [(c, b), (a, c), (b, a)] {
                        let edge = $sub($mul(p[0], q[1]), $mul(p[1], q[0]));
                        negative |= $cmp::<_CMP_LT_OQ>(edge, $zero());
                        positive |= $cmp::<_CMP_GT_OQ>(edge, $zero());
                    }
                    let mut passed = !(negative & positive) & live;
                    while passed != 0 {
                        pass(8 * chunk + passed.trailing_zeros() as usize, place);
                        passed &= passed - 1;
                    }
                }
            }
        }
    };
}

sieve!(
    sieve_f64,
    f64,
    DVec3,
    row_f64,
    transpose_f64,
    corners_f64,
    _mm512_permutex2var_pd,
    _mm512_set1_epi64,
    _mm512_add_epi64,
    _mm512_sub_pd,
    _mm512_mul_pd,
    _mm512_cmp_pd_mask,
    _mm512_setzero_pd
);
sieve!(
    sieve_f32,
    f32,
    Vec3,
    row_f32,
    transpose_f32,
    corners_f32,
    _mm256_permutex2var_ps,
    _mm256_set1_epi32,
    _mm256_add_epi32,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_cmp_ps_mask,
    _mm256_setzero_ps
);

/// The nine numbers of a triangle.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn corners_f64(Triangle(corners): &Triangle<DVec3>) -> [__m512d; 2] {
    const { assert!(size_of::<[DVec3; 3]>() == 9 * size_of::<f64>()) };
    let base = corners.as_ptr().cast::<f64>();
    // SAFETY: three points are nine numbers one after the other; no more are read.
    unsafe { [_mm512_loadu_pd(base), _mm512_maskz_loadu_pd(1, base.add(8))] }
}

/// The nine numbers of a triangle.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn corners_f32(Triangle(corners): &Triangle<Vec3>) -> [__m256; 2] {
    const { assert!(size_of::<[Vec3; 3]>() == 9 * size_of::<f32>()) };
    let base = corners.as_ptr().cast::<f32>();
    // SAFETY: as for f64.
    unsafe { [_mm256_loadu_ps(base), _mm256_maskz_loadu_ps(1, base.add(8))] }
}

/// The seven words of a frame, the last of them the axes.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn row_f64(frame: &Frame<f64>) -> __m512d {
    const { assert!(size_of::<Frame<f64>>() == 56) };
    // SAFETY: a frame has six numbers of 64 bits and the axes, of 32; the half word behind these is not read.
    unsafe {
        _mm512_castps_pd(_mm512_maskz_loadu_ps(
            0x1fff,
            std::ptr::from_ref(frame).cast(),
        ))
    }
}

/// The seven words of a frame, the last of them the axes.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn row_f32(frame: &Frame<f32>) -> __m256 {
    const { assert!(size_of::<Frame<f32>>() == 28) };
    // SAFETY: a frame has seven words of 32 bits.
    unsafe { _mm256_maskz_loadu_ps(0x7f, std::ptr::from_ref(frame).cast()) }
}

/// Origin and shear, and the axes, of eight rays.
type Constants<R, I> = ([R; 5], [I; 3]);

#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn transpose_f64(r: [__m512d; 8]) -> Constants<__m512d, __m512i> {
    // Even and odd words of two rays, then of four, then of all.
    let even = [0, 2, 4, 6].map(|i| _mm512_unpacklo_pd(r[i], r[i + 1]));
    let odd = [0, 2, 4, 6].map(|i| _mm512_unpackhi_pd(r[i], r[i + 1]));
    let lower = |w: [__m512d; 4]| [0, 2].map(|i| _mm512_shuffle_f64x2::<0x88>(w[i], w[i + 1]));
    let upper = |w: [__m512d; 4]| [0, 2].map(|i| _mm512_shuffle_f64x2::<0xdd>(w[i], w[i + 1]));
    let low = |[a, b]: [__m512d; 2]| _mm512_shuffle_f64x2::<0x88>(a, b);
    let high = |[a, b]: [__m512d; 2]| _mm512_shuffle_f64x2::<0xdd>(a, b);
    let numbers = [
        low(lower(even)),
        low(lower(odd)),
        low(upper(even)),
        low(upper(odd)),
        high(lower(even)),
    ];
    let axes = _mm512_castpd_si512(high(upper(even)));
    let byte = |shifted| _mm512_and_si512(shifted, _mm512_set1_epi64(0xff));
    (
        numbers,
        [
            byte(axes),
            byte(_mm512_srli_epi64::<8>(axes)),
            byte(_mm512_srli_epi64::<16>(axes)),
        ],
    )
}

#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn transpose_f32(r: [__m256; 8]) -> Constants<__m256, __m256i> {
    // Words 0, 1, 4, 5 and 2, 3, 6, 7 of two rays, then each of four with the one four further, then of all.
    let low = [0, 2, 4, 6].map(|i| _mm256_castps_pd(_mm256_unpacklo_ps(r[i], r[i + 1])));
    let high = [0, 2, 4, 6].map(|i| _mm256_castps_pd(_mm256_unpackhi_ps(r[i], r[i + 1])));
    let even =
        |w: [__m256d; 4]| [0, 2].map(|i| _mm256_castpd_ps(_mm256_unpacklo_pd(w[i], w[i + 1])));
    let odd =
        |w: [__m256d; 4]| [0, 2].map(|i| _mm256_castpd_ps(_mm256_unpackhi_pd(w[i], w[i + 1])));
    let first = |[a, b]: [__m256; 2]| _mm256_permute2f128_ps::<0x20>(a, b);
    let fifth = |[a, b]: [__m256; 2]| _mm256_permute2f128_ps::<0x31>(a, b);
    let numbers = [
        first(even(low)),
        first(odd(low)),
        first(even(high)),
        first(odd(high)),
        fifth(even(low)),
    ];
    let axes = _mm256_castps_si256(fifth(even(high)));
    let byte = |shifted| _mm256_and_si256(shifted, _mm256_set1_epi32(0xff));
    (
        numbers,
        [
            byte(axes),
            byte(_mm256_srli_epi32::<8>(axes)),
            byte(_mm256_srli_epi32::<16>(axes)),
        ],
    )
}
