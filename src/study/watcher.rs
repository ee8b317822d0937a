//! Whoever watches a run: told how it gets on.

/// Told how a run gets on. Work comes in units of the run's own kind, e.g. lines.
pub trait Watcher: Sync {
    /// So many units are to be done, as far as is known.
    fn expect(&self, _units: u64) {}
    /// What was taken for `guess` units is `units`.
    fn revise(&self, _guess: u64, _units: u64) {}
    /// So many units were found done.
    fn skip(&self, _units: u64) {}
    /// What is about to be done: told where no bar shows it.
    fn announce(&self, _text: &str) {}
    /// What is worked on now.
    fn begin(&self, _what: &str) {}
    /// So many more units are done.
    fn done(&self, _units: u64) {}
    /// What the user should know.
    fn note(&self, _text: &str) {}
}

/// Watches nothing.
impl Watcher for () {}
