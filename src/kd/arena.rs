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
    // Room for all to go left. Both writes are made for every entry, and last where it goes: no branch to mispredict.
    arena.extend_from_within(start..);
    let (mut left_end, mut right_end) = (top, start);
    for i in start..top {
        let entry = arena[i];
        let side = side(&entry);
        arena[left_end] = entry;
        left_end += usize::from(side & LEFT != 0);
        arena[right_end] = entry;
        right_end += usize::from(side & RIGHT != 0);
    }
    arena.truncate(left_end);
    (top, right_end)
}
