//! Progress on standard error: a bar with the time left on a terminal, a line a minute elsewhere.

use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sahlab::study::Watcher;

use crate::output::note;

/// Progress over the work of a run. How much that is may be known only on the way, so the length is a guess that gets
/// better.
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    /// Where there is no terminal: when a line was last written.
    spoken: Option<Mutex<Instant>>,
}

/// Between two lines where there is no terminal.
const SILENCE: Duration = Duration::from_secs(60);

impl Progress {
    /// Progress; silent if told so.
    pub fn new(quiet: bool) -> Self {
        let terminal = io::stderr().is_terminal();
        let style = "{bar:30.cyan/dim} {percent:>3} %  {elapsed} gone, {eta} left  {wide_msg}";
        let style = ProgressStyle::with_template(style).expect("a valid template");
        // Hidden until it has its style: the first frame would show another.
        let target = ProgressDrawTarget::hidden();
        let bar = ProgressBar::with_draw_target(Some(0), target).with_style(style);
        if !quiet && terminal {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self {
            bar,
            quiet,
            spoken: (!quiet && !terminal).then(|| Mutex::new(Instant::now())),
        }
    }

    /// Say how far it is where no bar shows it, once a minute.
    fn speak(&self) {
        let Some(spoken) = &self.spoken else {
            return;
        };
        let mut last = spoken.lock().expect("no panic while writing");
        if last.elapsed() >= SILENCE {
            *last = Instant::now();
            let share = 100 * self.bar.position() / self.bar.length().unwrap_or(1).max(1);
            let _ = writeln!(io::stderr(), "{share} % done, now {}", self.bar.message());
        }
    }

    /// All is done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watcher for Progress {
    fn expect(&self, units: u64) {
        self.bar.set_length(units);
    }

    fn revise(&self, guess: u64, units: u64) {
        let length = self.bar.length().unwrap_or(0);
        self.bar.set_length((length + units).saturating_sub(guess));
    }

    fn skip(&self, units: u64) {
        self.bar.dec_length(units);
    }

    fn announce(&self, text: &str) {
        if self.spoken.is_some() {
            let _ = writeln!(io::stderr(), "{text}");
        }
    }

    fn begin(&self, what: &str) {
        self.bar.set_message(what.to_owned());
    }

    fn done(&self, units: u64) {
        self.bar.inc(units);
        self.speak();
    }

    fn note(&self, text: &str) {
        if !self.quiet {
            self.bar.suspend(|| note(text));
        }
    }
}
