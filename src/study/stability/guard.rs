//! Checks that may panic or hang are run where neither does harm.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use super::case::Finding;

/// How long a check may take: a thousand times what the slowest does.
const PATIENCE: Duration = Duration::from_secs(60);

/// Run a check in a thread of its own. A panic and a check that does not come back within a minute are failures; the thread of
/// the latter is left to itself.
pub fn guarded(check: impl FnOnce() -> Option<Finding> + Send + 'static) -> Option<Finding> {
    guarded_for(PATIENCE, check)
}

fn guarded_for(
    patience: Duration,
    check: impl FnOnce() -> Option<Finding> + Send + 'static,
) -> Option<Finding> {
    let (sender, receiver) = channel();
    let worker = move || {
        let result = catch_unwind(AssertUnwindSafe(check));
        // Nobody waits any more if it took too long.
        let _ = sender.send(result);
    };
    if let Err(error) = thread::Builder::new()
        .name("hard case".into())
        .spawn(worker)
    {
        return Some(Finding::failed("a thread to run in", error));
    }
    match receiver.recv_timeout(patience) {
        Ok(Ok(finding)) => finding,
        Ok(Err(panic)) => Some(Finding::failed(
            "no panic",
            format!("panicked: {}", message(&*panic)),
        )),
        Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => Some(Finding::failed(
            format!("an end within {} s", patience.as_secs()),
            "hangs",
        )),
    }
}

/// The results of some work on things, in their order, by as many threads as the pool has, none of them of the pool: work that
/// waits for a guarded check would keep from the pool what that check needs of it.
pub fn in_plain_threads<T: Sync, R: Send>(things: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut done = Vec::new();
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            match things.get(i) {
                Some(thing) => done.push((i, work(thing))),
                None => return done,
            }
        }
    };
    let mut all: Vec<(usize, R)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..rayon::current_num_threads())
            .map(|_| scope.spawn(worker))
            .collect();
        let join = |worker: thread::ScopedJoinHandle<'_, _>| {
            worker.join().unwrap_or_else(|panic| resume_unwind(panic))
        };
        workers.into_iter().flat_map(join).collect()
    });
    all.sort_unstable_by_key(|&(i, _)| i);
    all.into_iter().map(|(_, result)| result).collect()
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::case::Outcome;

    /// In order, and with the pool free for what checks do in parallel: if its workers waited for them, all would hang.
    #[test]
    fn checks_may_use_the_pool() {
        let things: Vec<u64> = (0..64).collect();
        let found = in_plain_threads(&things, |&n| {
            let check = move || {
                let (a, b) = rayon::join(|| n, || n);
                Some(Finding::of(2 * n, a + b))
            };
            guarded_for(Duration::from_secs(20), check).unwrap()
        });
        let expected: Vec<Finding> = things.iter().map(|n| Finding::of(2 * n, 2 * n)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn panics_and_hangs_are_failures() {
        let fine = guarded(|| Some(Finding::of("1", "1"))).unwrap();
        assert_eq!(fine.outcome, Outcome::Pass);
        let panicked = guarded(|| panic!("at {}", 7)).unwrap();
        assert_eq!(
            (panicked.outcome, &*panicked.measured),
            (Outcome::Failed, "panicked: at 7")
        );
        let hanging = guarded_for(Duration::from_millis(20), || {
            thread::sleep(Duration::from_millis(500));
            None
        });
        let hanging = hanging.unwrap();
        assert_eq!(
            (hanging.outcome, &*hanging.measured),
            (Outcome::Failed, "hangs")
        );
    }
}
