//! The crew: threads that share each step of one large model.

use std::sync::Arc;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Error, Result};

/// Nodes from which a step is long enough to share: below, handing it out costs what it saves.
const LARGE: usize = 50_000;

/// Threads for one model; none but the caller's own unless asked for.
#[derive(Debug, Clone, Default)]
pub struct Crew {
    pool: Option<Arc<ThreadPool>>,
}

impl Crew {
    /// So many threads, the caller's own only for 1.
    ///
    /// # Errors
    /// Threads that the system does not give.
    pub fn new(threads: usize) -> Result<Self> {
        if threads <= 1 {
            return Ok(Self::default());
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|e| Error::Input(format!("run: threads = {threads}, the system gives none: {e}")))?;
        Ok(Self { pool: Some(Arc::new(pool)) })
    }

    /// So many threads for a large model, the caller's own only for a smaller one.
    ///
    /// # Errors
    /// As for `new`.
    pub fn fitting(nodes: usize, threads: usize) -> Result<Self> {
        Self::new(if nodes < LARGE { 1 } else { threads })
    }

    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or(1, |pool| pool.current_num_threads())
    }

    /// Does the work where its parts can be shared out.
    pub fn work<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}
