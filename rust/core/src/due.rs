//! What is due to be seen of a step: samples, looks at the state, snapshots.

/// What is to be seen of a step, known before it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Due {
    /// Energies are recorded.
    pub sample: bool,
    /// The state is looked at, as it is with every sample.
    pub look: bool,
    /// So are the shapes of the elements.
    pub shapes: bool,
    /// A snapshot is taken.
    pub snapshot: bool,
}

impl Due {
    /// What is due to either of two runs.
    pub fn or(self, other: Self) -> Self {
        Self {
            sample: self.sample || other.sample,
            look: self.look || other.look,
            shapes: self.shapes || other.shapes,
            snapshot: self.snapshot || other.snapshot,
        }
    }
}
