//! The same work on the three axes, one after the other or at the same time.

/// What `work` makes of each of three things, by as many threads as there are if `shared`.
pub(super) fn each_axis<T: Send, R: Send>(
    shared: bool,
    things: [T; 3],
    work: impl Fn(T) -> R + Sync,
) -> [R; 3] {
    if !shared {
        return things.map(work);
    }
    let [x, y, z] = things;
    let (x, (y, z)) = rayon::join(|| work(x), || rayon::join(|| work(y), || work(z)));
    [x, y, z]
}
