//! One 2x2 block of the stiffness matrix.

/// k_xx, k_yy, k_yx, k_xy (N/m): times u_x, u_y, u_x, u_y these are the four products of one block.
///
/// That order lets one load of (u_x, u_y), repeated, meet all of them; aligned so that no load crosses a cache line.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Block(pub(super) [f64; 4]);

/// Row and column (axes) of each value.
const PLACE: [[usize; 2]; 4] = [[0, 0], [1, 1], [1, 0], [0, 1]];

impl Block {
    /// Adds k(row, column) for both axes of both nodes.
    pub(super) fn add(&mut self, k: impl Fn(usize, usize) -> f64) {
        for (value, [row, column]) in self.0.iter_mut().zip(PLACE) {
            *value += k(row, column);
        }
    }

    /// The values with their row and column axes.
    pub fn entries(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        PLACE.into_iter().zip(self.0)
    }

    /// The block times a nodal vector.
    #[inline]
    pub fn times(&self, u: [f64; 2]) -> [f64; 2] {
        let [xx, yy, yx, xy] = self.0;
        [xx * u[0] + xy * u[1], yx * u[0] + yy * u[1]]
    }
}
