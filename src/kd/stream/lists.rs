//! Lists of lines on their way down a tree, and how a plane divides a list into those of its node's children.

use crate::geom::{Real, slack};

use super::lanes::{Lane, Lanes};

/// Lists begin at multiples of this many entries, so that a list written over in whole vectors ends before the next one.
const ALIGNMENT: usize = 16;

/// Entries that a list of `n` has room for.
pub fn room(n: usize) -> usize {
    n.next_multiple_of(ALIGNMENT)
}

/// A plane, and what is known of the lines that meet it.
#[derive(Clone, Copy)]
pub struct Cut<'a, R> {
    /// Position of the plane on its axis.
    pub position: R,
    /// What each line's t is widened by, relative to it.
    pub padding: R,
    /// Origin and reciprocal direction of every line on that axis.
    pub lines: &'a [[R; 2]],
}

/// Lines with their spans in one node, as arrays by part.
pub struct Entries<'a, R> {
    pub t0: &'a mut [R],
    pub t1: &'a mut [R],
    pub line: &'a mut [u32],
}

/// A stack of lists: the current node's on top.
pub struct Lists<V: Lane> {
    t0: Vec<V::Real>,
    t1: Vec<V::Real>,
    line: Vec<u32>,
    lanes: Lanes,
}

impl<V: Lane> Lists<V> {
    /// None yet, to be divided with these instructions.
    pub fn new(lanes: Lanes) -> Self {
        Self {
            t0: Vec::new(),
            t1: Vec::new(),
            line: Vec::new(),
            lanes,
        }
    }

    /// Give up all lists.
    pub fn clear(&mut self) {
        self.t0.clear();
        self.t1.clear();
        self.line.clear();
    }

    /// Put one more line on top.
    pub fn push(&mut self, t0: V::Real, t1: V::Real, line: u32) {
        self.t0.push(t0);
        self.t1.push(t1);
        self.line.push(line);
    }

    /// An entry: t0, t1 and the number of its line.
    #[cfg(test)]
    pub fn get(&self, i: usize) -> (V::Real, V::Real, u32) {
        (self.t0[i], self.t1[i], self.line[i])
    }

    /// The numbers of the lines of the list `start..start + n`.
    #[inline(always)]
    pub fn lines(&self, start: usize, n: usize) -> &[u32] {
        &self.line[start..start + n]
    }

    /// Divide the list `start..start + n` at a plane: the far child's list takes its place, the near child's comes behind
    /// it, at `start + room(n)`. Returns their lengths, near and far.
    #[inline]
    pub fn divide(&mut self, cut: &Cut<V::Real>, start: usize, n: usize) -> (usize, usize) {
        let (near, end) = (start + room(n), start + 2 * room(n));
        if self.line.len() < end {
            self.t0.resize(end, V::Real::ZERO);
            self.t1.resize(end, V::Real::ZERO);
            self.line.resize(end, 0);
        }
        let (t0, near_t0) = self.t0[start..end].split_at_mut(near - start);
        let (t1, near_t1) = self.t1[start..end].split_at_mut(near - start);
        let (line, near_line) = self.line[start..end].split_at_mut(near - start);
        let list = Entries { t0, t1, line };
        let near = Entries {
            t0: near_t0,
            t1: near_t1,
            line: near_line,
        };
        V::divide(self.lanes, cut, list, near, n)
    }

    /// Keep the entries of the list `start..start + n` that begin before the limit of their line, or at it. Returns how many.
    #[inline]
    pub fn retain(&mut self, limits: &[V::Real], start: usize, n: usize) -> usize {
        let end = start + n;
        let (t0, t1) = (&mut self.t0[start..end], &mut self.t1[start..end]);
        let line = &mut self.line[start..end];
        let mut kept = 0;
        for i in 0..n {
            (t0[kept], t1[kept], line[kept]) = (t0[i], t1[i], line[i]);
            kept += usize::from(t0[i] <= limits[line[i] as usize]);
        }
        kept
    }
}

/// Divide the first `n` entries of `list`: far ones take its place, near ones go to `near`. The plain way.
///
/// Both appends write always and advance if the line goes there, so there is no branch to mispredict.
#[inline(always)]
pub fn divide<R: Real>(
    cut: &Cut<R>,
    list: Entries<R>,
    near: Entries<R>,
    n: usize,
) -> (usize, usize) {
    let (mut near_n, mut far_n) = (0, 0);
    for i in 0..n {
        let (t0, t1, line) = (list.t0[i], list.t1[i], list.line[i]);
        let [origin, inverse] = cut.lines[line as usize];
        let t = (cut.position - origin) * inverse;
        let slack = slack(cut.padding, t);
        let (earliest, latest) = (t - slack, t + slack);
        near.t0[near_n] = t0;
        near.t1[near_n] = t1.min(latest);
        near.line[near_n] = line;
        near_n += usize::from(latest >= t0);
        list.t0[far_n] = t0.max(earliest);
        list.t1[far_n] = t1;
        list.line[far_n] = line;
        far_n += usize::from(earliest <= t1);
    }
    (near_n, far_n)
}
