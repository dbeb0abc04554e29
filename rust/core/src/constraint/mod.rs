//! Constraints other than contact, one file each.

pub mod linear;
pub mod support;
