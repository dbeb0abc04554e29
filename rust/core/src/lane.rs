//! One lane of an array laid out [node][axis][lane]: what contact reads of a state.

/// Read access to the nodal vectors of one lane.
#[derive(Debug, Clone, Copy)]
pub struct Lane<'a> {
    values: &'a [f64],
    lanes: usize,
    lane: usize,
}

impl<'a> Lane<'a> {
    /// Lane `lane` of `lanes` interleaved ones.
    pub fn new(values: &'a [f64], lanes: usize, lane: usize) -> Self {
        Self { values, lanes, lane }
    }

    /// Vector of one node.
    #[inline]
    pub fn at(&self, node: u32) -> [f64; 2] {
        let first = 2 * node as usize * self.lanes + self.lane;
        [self.values[first], self.values[first + self.lanes]]
    }
}

/// Adds to one node's vector of one lane.
#[inline]
pub fn add_to(values: &mut [f64], lanes: usize, lane: usize, node: u32, vector: [f64; 2]) {
    let first = 2 * node as usize * lanes + lane;
    values[first] += vector[0];
    values[first + lanes] += vector[1];
}
