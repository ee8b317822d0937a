//! Checks that may panic or hang are run where neither does harm.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
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

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::stability::case::Outcome;

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
