//! Progress on standard error: a bar with the time left on a terminal, a line a minute elsewhere.

use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sahlab::study::cell::Watcher;

/// Progress over all lines of a run. How many a cell takes is known only after its pilot, so the length is a guess that
/// gets better.
pub struct Progress {
    bar: ProgressBar,
    /// Guess for a cell not yet begun.
    expected: u64,
    /// Where there is no terminal: when a line was last written.
    spoken: Option<Mutex<Instant>>,
}

/// Between two lines where there is no terminal.
const SILENCE: Duration = Duration::from_secs(60);

impl Progress {
    /// Progress over some cells of about so many lines; silent if told so.
    pub fn new(cells: usize, expected: u64, quiet: bool) -> Self {
        let terminal = io::stderr().is_terminal();
        let style = "{bar:30.cyan/dim} {percent:>3} %  {elapsed} gone, {eta} left  {wide_msg}";
        let style = ProgressStyle::with_template(style).expect("a valid template");
        // Hidden until it has its style: the first frame would show another.
        let target = ProgressDrawTarget::hidden();
        let bar =
            ProgressBar::with_draw_target(Some(cells as u64 * expected), target).with_style(style);
        if !quiet && terminal {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self {
            bar,
            expected,
            spoken: (!quiet && !terminal).then(|| Mutex::new(Instant::now())),
        }
    }

    /// So many cells are going to be counted: told where no bar shows it.
    pub fn announce(&self, cells: usize) {
        if self.spoken.is_some() && cells > 0 {
            let s = if cells == 1 { "" } else { "s" };
            let _ = writeln!(io::stderr(), "counting lines through {cells} cell{s}");
        }
    }

    /// A cell begins.
    pub fn begin(&self, scene: &str, strategy: &str) {
        self.bar.set_message(format!("{scene} {strategy}"));
    }

    /// A cell was found finished.
    pub fn skip(&self) {
        self.bar.dec_length(self.expected);
    }

    /// All is done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watcher for Progress {
    fn lines_chosen(&self, lines: u64) {
        let length = self.bar.length().unwrap_or(0);
        self.bar
            .set_length((length + lines).saturating_sub(self.expected));
    }

    fn counted(&self, lines: u64) {
        self.bar.inc(lines);
        let Some(spoken) = &self.spoken else {
            return;
        };
        let mut last = spoken.lock().expect("no panic while writing");
        if last.elapsed() >= SILENCE {
            *last = Instant::now();
            let share = 100 * self.bar.position() / self.bar.length().unwrap_or(1).max(1);
            let _ = writeln!(io::stderr(), "{share} % of the lines counted");
        }
    }
}
