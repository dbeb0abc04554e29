//! A batch: many runs over one model, a few threads, each run on its own and in its own time.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::outcome::Outcome;
use crate::run::Run;

/// Steps between two looks at the clock.
const STRIDE: u64 = 64;

/// Runs with the number of steps each is to take.
pub struct Batch {
    slots: Vec<Mutex<Slot>>,
}

struct Slot {
    run: Run,
    steps: u64,
    seconds: f64,
}

impl Slot {
    fn is_over(&self) -> bool {
        self.run.outcome != Outcome::Running || self.run.state.steps >= self.steps
    }
}

impl Batch {
    /// A batch of runs, each with the steps it is to take.
    pub fn new(runs: Vec<(Run, u64)>) -> Self {
        Self { slots: runs.into_iter().map(|(run, steps)| Mutex::new(Slot { run, steps, seconds: 0.0 })).collect() }
    }

    /// Works on the unfinished runs, first come first served, for about `budget`; returns the node-steps done.
    pub fn advance(&self, threads: usize, budget: Duration) -> u64 {
        let (next, done, until) = (AtomicUsize::new(0), AtomicU64::new(0), Instant::now() + budget);
        let work = || {
            while let Some(slot) = self.slots.get(next.fetch_add(1, Ordering::Relaxed)) {
                // A run whose thread panicked is left as it stands: the others go on.
                let Ok(mut slot) = slot.lock() else { continue };
                done.fetch_add(slot.work(until), Ordering::Relaxed);
                if Instant::now() >= until {
                    return;
                }
            }
        };
        if threads <= 1 {
            work();
        } else {
            std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
        }
        done.into_inner()
    }

    /// Number of runs that have ended.
    pub fn finished(&self) -> usize {
        self.slots.iter().filter(|slot| slot.lock().map_or(true, |slot| slot.is_over())).count()
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// True for a batch without runs.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// Looks at one run: what it is, the steps it was to take, and the seconds it took.
    pub fn look<T>(&self, index: usize, look: impl FnOnce(&Run, u64, f64) -> T) -> Option<T> {
        let slot = self.slots.get(index)?.lock().ok()?;
        Some(look(&slot.run, slot.steps, slot.seconds))
    }
}

impl Slot {
    fn work(&mut self, until: Instant) -> u64 {
        let (start, first) = (Instant::now(), self.run.state.steps);
        while !self.is_over() && Instant::now() < until {
            let left = self.steps - self.run.state.steps;
            self.run.advance(left.min(STRIDE), left <= STRIDE);
        }
        self.seconds += start.elapsed().as_secs_f64();
        (self.run.state.steps - first) * self.run.model.points.len() as u64
    }
}
