//! Lists of nested nodes in one vector: a stack, the current node's list on top.

use super::split::{LEFT, RIGHT};

/// Split the list on top of an arena (from `start` on): right entries move down into its place, left entries are put on
/// top; entries may do both. Returns where the left list begins and where the right one ends. Keeps order.
pub(super) fn spread<T: Copy>(
    arena: &mut Vec<T>,
    start: usize,
    side: impl Fn(&T) -> u8,
) -> (usize, usize) {
    let top = arena.len();
    let mut end = start;
    for i in start..top {
        let entry = arena[i];
        let side = side(&entry);
        if side & LEFT != 0 {
            arena.push(entry);
        }
        arena[end] = entry;
        end += usize::from(side & RIGHT != 0);
    }
    (top, end)
}
