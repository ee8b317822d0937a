//! Lists of nested nodes in one vector: a stack, the current node's list on top.

use super::split::{LEFT, RIGHT};

/// Split the list on top of an arena (from `start` on), of whose entries at most `lefts` go left: right entries stay in its
/// place, left entries follow on top, above a gap; entries may do both. Returns where the right list ends and the left one,
/// a `gap` further on, begins. Keeps order.
pub(super) fn spread<T: Copy>(
    arena: &mut Vec<T>,
    start: usize,
    lefts: usize,
    gap: usize,
    side: impl Fn(&T) -> u8,
) -> (usize, usize) {
    let top = arena.len();
    let Some(&any) = arena[start..].last() else {
        return (top, top);
    };
    // Both writes are made for every entry, and last where it goes: no branch to mispredict. Hence one place more.
    let room = lefts + gap + 1;
    make_room(arena, room);
    arena.resize(top + room, any);
    let (list, left) = arena[start..].split_at_mut(top - start);
    let (mut left_len, mut right_len) = (0, 0);
    for i in 0..list.len() {
        let entry = list[i];
        let side = side(&entry);
        left[left_len] = entry;
        left_len += usize::from(side & LEFT != 0);
        list[right_len] = entry;
        right_len += usize::from(side & RIGHT != 0);
    }
    let end = start + right_len;
    let begin = end + gap;
    arena.copy_within(top..top + left_len, begin);
    arena.truncate(begin + left_len);
    (end, begin)
}

/// Merge sorted entries into the sorted `list[..old]`, which `list` is just long enough for.
pub(super) fn merge<T: Copy + Ord>(list: &mut [T], mut old: usize, mut new: &[T]) {
    debug_assert_eq!(list.len(), old + new.len());
    // From the back: what is written over has been read.
    let mut at = list.len();
    while let Some((last, rest)) = new.split_last() {
        at -= 1;
        if old > 0 && list[old - 1] > *last {
            old -= 1;
            list[at] = list[old];
        } else {
            list[at] = *last;
            new = rest;
        }
    }
}

/// Room for `more` entries. Where a vector's own growth would double it, this takes an eighth more: a build's lists and its
/// tree together are all the memory there is to save.
pub(super) fn make_room<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more + list.len() / 8);
    }
}

/// Give up what lies above `end`, and memory that the rest of a build is not likely to need again: a node's list and its left
/// child's take no more than twice the node's.
pub(super) fn give_up<T>(arena: &mut Vec<T>, end: usize) {
    const WORTH_IT: usize = 1 << 12;
    arena.truncate(end);
    if arena.capacity() > WORTH_IT && arena.capacity() / 3 > end {
        arena.shrink_to(2 * end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_spread_above_what_lies_below() {
        // Multiples of 2 go left, of 3 right.
        let side =
            |x: &u32| u8::from(x.is_multiple_of(2)) * LEFT + u8::from(x.is_multiple_of(3)) * RIGHT;
        let mut arena = vec![7, 7, 1, 2, 3, 4, 6, 9, 12];
        assert_eq!(spread(&mut arena, 2, 4, 0, side), (6, 6));
        assert_eq!(arena, [7, 7, 3, 6, 9, 12, 2, 4, 6, 12]);
        assert_eq!(spread(&mut arena, 10, 0, 3, side), (10, 10));
        let (end, begin) = spread(&mut arena, 6, 4, 9, side);
        assert_eq!((end, begin), (8, 17));
        assert_eq!(
            (&arena[6..8], &arena[17..]),
            (&[6, 12][..], &[2, 4, 6, 12][..])
        );
    }

    #[test]
    fn new_entries_find_their_places() {
        let mut list = [2, 4, 4, 8, 0, 0, 0, 0];
        merge(&mut list, 4, &[1, 4, 5, 10]);
        assert_eq!(list, [1, 2, 4, 4, 4, 5, 8, 10]);
        let mut alone = [0];
        merge(&mut alone, 0, &[3]);
        assert_eq!(alone, [3]);
    }
}
