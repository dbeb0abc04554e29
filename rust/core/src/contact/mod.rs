//! Contact: candidate pairs from the broad phase, gaps from the narrow phase, rows for what penetrates.

pub mod candidates;
pub mod crossing;
pub mod gap;
pub mod overlap;
pub mod pair;
pub mod posed;
pub mod search;
pub mod surface;
pub mod travel;

pub use pair::{Pair, Primary};
pub use surface::Surface;
