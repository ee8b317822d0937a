//! Dividing lists with AVX2: 4 lines of f64 or 8 of f32 at a time. It cannot compress a vector by a mask; a table of
//! permutations does.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::lists::{Cut, Entries};

/// For every mask of `LANES` lanes the lanes that are set, in order, then any.
const fn packings<const LANES: usize, const MASKS: usize>() -> [[u32; LANES]; MASKS] {
    let mut table = [[0; LANES]; MASKS];
    let mut mask = 0;
    while mask < MASKS {
        let (mut lane, mut kept) = (0, 0);
        while lane < LANES {
            if mask >> lane & 1 == 1 {
                table[mask][kept] = lane as u32;
                kept += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
}

/// As [`packings`] of four lanes, for lanes of two words.
const fn pairs(packings: [[u32; 4]; 16]) -> [[u32; 8]; 16] {
    let mut table = [[0; 8]; 16];
    let mut i = 0;
    while i < 64 {
        let lane = packings[i / 4][i % 4];
        table[i / 4][2 * (i % 4)] = 2 * lane;
        table[i / 4][2 * (i % 4) + 1] = 2 * lane + 1;
        i += 1;
    }
    table
}

static FOUR: [[u32; 4]; 16] = packings();
static FOUR_PAIRS: [[u32; 8]; 16] = pairs(FOUR);
static EIGHT: [[u32; 8]; 256] = packings();

/// A function that divides lists of these numbers, the same arithmetic as [`divide`](super::lists::divide).
macro_rules! divide {
    (
        $name:ident, $lanes:literal, $set1:ident, $load:ident, $store:ident, $sub:ident, $mul:ident, $add:ident, $andnot:ident,
        $min:ident, $max:ident, $cmp:ident, $movemask:ident, $gather:ident, $pack:ident, $pack_lines:ident, $set1_line:ident,
        $load_line:ident, $min_line:ident
    ) => {
        /// Divide the first `n` entries of a list.
        ///
        /// # Panics
        /// If an array is shorter than `n` rounded up to whole vectors, or there are no lines or more than 2^32.
        #[target_feature(enable = "avx2")]
        pub(super) fn $name(
            cut: &Cut<$name>,
            list: Entries<$name>,
            near: Entries<$name>,
            n: usize,
        ) -> (usize, usize) {
            let room = n.next_multiple_of($lanes);
            let shortest = |e: &Entries<$name>| e.t0.len().min(e.t1.len()).min(e.line.len());
            assert!(room <= shortest(&list).min(shortest(&near)));
            assert!((1..=1 << 32).contains(&cut.lines.len()));
            let last_line = $set1_line((cut.lines.len() - 1) as i32);
            let Entries { t0, t1, line } = list;
            let (position, padding) = ($set1(cut.position), $set1(cut.padding));
            let (most, sign) = ($set1($name::MAX), $set1(-0.0));
            let (mut near_n, mut far_n) = (0, 0);
            for i in (0..n).step_by($lanes) {
                let left = n - i;
                let live = if left < $lanes {
                    (1 << left) - 1
                } else {
                    (1 << $lanes) - 1
                };
                // SAFETY: i + lanes <= room, which every array holds. No number that is gathered is beyond the last line's, whatever
                // the entries that are not live hold.
                let (first, last, number, [origin, inverse]) = unsafe {
                    let number = $load_line(line.as_ptr().add(i).cast());
                    (
                        $load(t0.as_ptr().add(i)),
                        $load(t1.as_ptr().add(i)),
                        number,
                        $gather(cut.lines, $min_line(number, last_line)),
                    )
                };
                let t = $mul($sub(position, origin), inverse);
                let slack = $min($mul(padding, $andnot(sign, t)), most);
                let (earliest, latest) = ($sub(t, slack), $add(t, slack));
                let goes_near = $movemask($cmp::<_CMP_GE_OQ>(latest, first)) as usize & live;
                let goes_far = $movemask($cmp::<_CMP_LE_OQ>(earliest, last)) as usize & live;
                let near_last = $min(last, latest);
                let far_first = $max(first, earliest);
                // SAFETY: near_n and far_n are at most i, so whole vectors end within the room; of the list itself, they
                // write over what has been read.
                unsafe {
                    $store(near.t0.as_mut_ptr().add(near_n), $pack(first, goes_near));
                    $store(
                        near.t1.as_mut_ptr().add(near_n),
                        $pack(near_last, goes_near),
                    );
                    $store(t0.as_mut_ptr().add(far_n), $pack(far_first, goes_far));
                    $store(t1.as_mut_ptr().add(far_n), $pack(last, goes_far));
                    $pack_lines(near.line.as_mut_ptr().add(near_n), number, goes_near);
                    $pack_lines(line.as_mut_ptr().add(far_n), number, goes_far);
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
    4,
    _mm256_set1_pd,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_sub_pd,
    _mm256_mul_pd,
    _mm256_add_pd,
    _mm256_andnot_pd,
    _mm256_min_pd,
    _mm256_max_pd,
    _mm256_cmp_pd,
    _mm256_movemask_pd,
    gather_f64,
    pack_f64,
    pack_lines_f64,
    _mm_set1_epi32,
    _mm_loadu_si128,
    _mm_min_epu32
);
divide!(
    f32,
    8,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_add_ps,
    _mm256_andnot_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_cmp_ps,
    _mm256_movemask_ps,
    gather_f32,
    pack_f32,
    pack_lines_f32,
    _mm256_set1_epi32,
    _mm256_loadu_si256,
    _mm256_min_epu32
);

/// Origins and reciprocals of 4 lines.
///
/// # Safety
/// All numbers must be below the number of lines.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn gather_f64(lines: &[[f64; 2]], number: __m128i) -> [__m256d; 2] {
    let mut numbers = [0u32; 4];
    // SAFETY: four numbers fit.
    unsafe { _mm_storeu_si128(numbers.as_mut_ptr().cast(), number) };
    // SAFETY: see above; a pair is two numbers.
    let pair = |i: usize| unsafe { _mm_loadu_pd(lines.as_ptr().add(numbers[i] as usize).cast()) };
    let (even, odd) = (
        _mm256_set_m128d(pair(2), pair(0)),
        _mm256_set_m128d(pair(3), pair(1)),
    );
    [_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd)]
}

/// Origins and reciprocals of 8 lines.
///
/// # Safety
/// All numbers must be below the number of lines.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn gather_f32(lines: &[[f32; 2]], number: __m256i) -> [__m256; 2] {
    let mut numbers = [0u32; 8];
    // SAFETY: eight numbers fit.
    unsafe { _mm256_storeu_si256(numbers.as_mut_ptr().cast(), number) };
    let pair = |i: usize| {
        // SAFETY: see above; a pair is 64 bits, which this load does not want aligned.
        let pair = unsafe { _mm_loadl_epi64(lines.as_ptr().add(numbers[i] as usize).cast()) };
        _mm_castsi128_pd(pair)
    };
    let four = |i: usize| {
        let low = _mm_unpacklo_pd(pair(i), pair(i + 1));
        let high = _mm_unpacklo_pd(pair(i + 4), pair(i + 5));
        _mm256_castpd_ps(_mm256_set_m128d(high, low))
    };
    let (a, b) = (four(0), four(2));
    [
        _mm256_shuffle_ps::<0x88>(a, b),
        _mm256_shuffle_ps::<0xdd>(a, b),
    ]
}

/// The lanes that are set, in front.
#[inline]
#[target_feature(enable = "avx2")]
fn pack_f64(numbers: __m256d, set: usize) -> __m256d {
    // SAFETY: a packing has eight words.
    let packing = unsafe { _mm256_loadu_si256(FOUR_PAIRS[set].as_ptr().cast()) };
    _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(numbers), packing))
}

/// The lanes that are set, in front.
#[inline]
#[target_feature(enable = "avx2")]
fn pack_f32(numbers: __m256, set: usize) -> __m256 {
    // SAFETY: a packing has eight words.
    let packing = unsafe { _mm256_loadu_si256(EIGHT[set].as_ptr().cast()) };
    _mm256_permutevar8x32_ps(numbers, packing)
}

/// Write the line numbers that are set.
///
/// # Safety
/// There must be room for four.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn pack_lines_f64(to: *mut u32, number: __m128i, set: usize) {
    // SAFETY: a packing has four words, and see above.
    unsafe {
        let packing = _mm_loadu_si128(FOUR[set].as_ptr().cast());
        let packed = _mm_permutevar_ps(_mm_castsi128_ps(number), packing);
        _mm_storeu_ps(to.cast(), packed);
    }
}

/// Write the line numbers that are set.
///
/// # Safety
/// There must be room for eight.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn pack_lines_f32(to: *mut u32, number: __m256i, set: usize) {
    // SAFETY: a packing has eight words, and see above.
    unsafe {
        let packing = _mm256_loadu_si256(EIGHT[set].as_ptr().cast());
        _mm256_storeu_si256(to.cast(), _mm256_permutevar8x32_epi32(number, packing));
    }
}
