//! Results go to standard output, everything else to standard error. A closed pipe is not an error.

use std::io::{self, Write};

/// Print results. If the reader has gone, that is its choice.
pub fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// A note to whoever watches.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr(), "note: {text}");
}

/// An error, in one line.
pub fn complain(error: &anyhow::Error) {
    let _ = writeln!(io::stderr(), "error: {error:#}");
}
