//! A batch: many runs over one model, in lanes and on threads; a lane whose run is over takes the next one.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use crate::crew::Crew;
use crate::ended::{Ended, Summary};
use crate::error::Result;
use crate::group::{Group, WIDTHS};
use crate::model::Model;
use crate::run::RunSpec;
use crate::stiffness::Isa;

/// Steps between two looks at the clock.
const STRIDE: u64 = 64;

/// Cache a core has to itself (bytes) on machines of today, and bytes a node: of K, and of each lane's state.
const CACHE: usize = 2 << 20;
const OF_STIFFNESS: usize = 344;
const OF_LANE: usize = 48;

/// Lanes of a group unless asked for otherwise: 16, but 8 where those stay in the cache and 16 do not, and where registers
/// hold no more (docs/kernel.md).
fn usual_width(isa: Isa, nodes: usize) -> usize {
    let bytes = |lanes: usize| nodes * (OF_STIFFNESS + lanes * OF_LANE);
    let between = bytes(16) > CACHE && bytes(8) < CACHE + CACHE / 4;
    if between || isa != Isa::Avx512 { 8 } else { 16 }
}

/// Runs that wait, runs that are under way, and what is left of those that have ended.
pub struct Batch {
    model: Arc<Model>,
    isa: Isa,
    width: usize,
    specs: Vec<RunSpec>,
    next: AtomicUsize,
    finished: AtomicUsize,
    ended: Vec<Mutex<Option<Ended>>>,
    workers: Mutex<Vec<Arc<Mutex<Worker>>>>,
}

/// A group with the numbers of its runs.
struct Worker {
    group: Group,
    numbers: Vec<usize>,
}

impl Batch {
    /// A batch of runs; `width` is the number of lanes, 0 to leave it to the batch.
    pub fn new(model: Arc<Model>, isa: Isa, width: usize, specs: Vec<RunSpec>) -> Self {
        let width = WIDTHS
            .into_iter()
            .find(|w| *w >= width)
            .filter(|_| width > 0)
            .unwrap_or_else(|| usual_width(isa, model.points.len()));
        let ended = specs.iter().map(|_| Mutex::new(None)).collect();
        let (next, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
        Self { model, isa, width, specs, next, finished, ended, workers: Mutex::default() }
    }

    /// The model of all runs, or what they are variants of.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Whether a run can begin.
    ///
    /// # Errors
    /// What is out of its bounds; such a run ends as refused.
    pub fn check(&self, number: usize) -> Result<()> {
        self.specs.get(number).map_or(Ok(()), |spec| spec.checked_model(&self.model).map(|_| ()))
    }

    /// Works on the runs for about `budget` on `threads` threads; returns the node-steps done.
    pub fn advance(&self, threads: usize, budget: Duration) -> u64 {
        let (done, until, threads) = (AtomicU64::new(0), Instant::now() + budget, threads.max(1));
        let work = |worker: Arc<Mutex<Worker>>| {
            // A group whose thread panicked is left as it stands: its runs are lost, the others go on.
            if let Ok(mut worker) = worker.lock() {
                done.fetch_add(self.work(&mut worker, threads, until), Ordering::Relaxed);
            }
        };
        let mut workers = self.workers(threads);
        if let (1, Some(only)) = (workers.len(), workers.first()) {
            work(only.clone());
        } else {
            let work = &work;
            std::thread::scope(|scope| workers.drain(..).for_each(|worker| drop(scope.spawn(move || work(worker)))));
        }
        done.into_inner()
    }

    /// One worker a thread, and those that still have runs from a call with more threads.
    fn workers(&self, threads: usize) -> Vec<Arc<Mutex<Worker>>> {
        let Ok(mut workers) = self.workers.lock() else { return Vec::new() };
        while workers.len() < threads.min(self.specs.len()) {
            let mut group = Group::new(self.model.clone(), self.isa, 1);
            // Fewer large runs than threads: the threads left over share their steps. Without them it goes on alone.
            let spare = threads / self.specs.len().max(1);
            group.crew = Crew::fitting(self.model.points.len(), spare).unwrap_or_default();
            workers.push(Arc::new(Mutex::new(Worker { group, numbers: Vec::new() })));
        }
        workers.clone()
    }

    fn work(&self, worker: &mut Worker, threads: usize, until: Instant) -> u64 {
        let mut done = 0;
        while Instant::now() < until {
            if self.retire(worker) {
                self.fill(worker, threads);
            }
            if worker.numbers.is_empty() {
                break;
            }
            let start = Instant::now();
            let (runs, nodes) = (worker.numbers.len() as u64, self.model.points.len() as u64);
            done += worker.group.advance(STRIDE) * runs * nodes;
            let share = start.elapsed().as_secs_f64() / runs as f64;
            worker.group.runs.iter_mut().for_each(|run| run.seconds += share);
        }
        done
    }

    /// Takes the runs that are over out of their lanes; true when that leaves room, or there are no runs.
    fn retire(&self, worker: &mut Worker) -> bool {
        let before = worker.numbers.len();
        for lane in (0..before).rev() {
            if worker.group.runs[lane].is_over() {
                let (run, stepping) = worker.group.take(lane);
                self.put(worker.numbers.swap_remove(lane), Ended::new(run, &stepping));
            }
        }
        worker.numbers.is_empty() || worker.numbers.len() < before
    }

    /// Begins runs that wait, leaving the other threads their share, and gives up lanes that stay empty.
    fn fill(&self, worker: &mut Worker, threads: usize) {
        let waiting = self.specs.len().saturating_sub(self.next.load(Ordering::Relaxed));
        let mut room = waiting.div_ceil(threads).min(self.width - worker.numbers.len());
        worker.group.resize(worker.numbers.len() + room);
        while room > 0 {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(spec) = self.specs.get(number) else { break };
            match worker.group.begin(spec) {
                Ok(()) => {
                    worker.numbers.push(number);
                    room -= 1;
                }
                Err(error) => self.put(number, Ended::refused(spec, &error)),
            }
        }
        worker.group.resize(worker.numbers.len());
    }

    fn put(&self, number: usize, ended: Ended) {
        if let Ok(mut place) = self.ended[number].lock() {
            *place = Some(ended);
            self.finished.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Number of runs that have ended.
    pub fn finished(&self) -> usize {
        self.finished.load(Ordering::Relaxed)
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.specs.len()
    }

    /// True for a batch without runs.
    pub fn is_empty(&self) -> bool {
        self.specs.is_empty()
    }

    /// What there is of a run: all of it when it is over, what has been seen so far while it is under way; none when the
    /// thread that worked on it died, or there is no such run.
    pub fn look<T>(&self, number: usize, look: impl FnOnce(&Ended) -> T) -> Option<T> {
        if let Some(ended) = &*self.ended.get(number)?.lock().ok()? {
            return Some(look(ended));
        }
        for worker in self.workers.lock().ok()?.iter() {
            let Ok(worker) = worker.lock() else { continue };
            if let Some(lane) = worker.numbers.iter().position(|n| *n == number) {
                let (run, stepping) = (&worker.group.runs[lane], &worker.group.lanes[lane]);
                return Some(look(&Ended { summary: Summary::of(run, stepping), history: run.history.clone() }));
            }
        }
        (number >= self.next.load(Ordering::Relaxed)).then(|| look(&Ended::waiting(&self.specs[number])))
    }
}
