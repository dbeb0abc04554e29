//! What can go wrong, said as object, value, bound and remedy.

use thiserror::Error;

use crate::outcome::Kind;

/// Every failure of the crate. `Input` is something the caller can mend; `Run` ends a run that has begun.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// Bad input: the message names the object, its value, the bound and the remedy.
    #[error("{0}")]
    Input(String),
    /// A run cannot go on; what it has recorded so far is kept.
    #[error("{1}")]
    Run(Kind, String),
}

impl Error {
    /// `object: quantity = value, must be bound; remedy`.
    pub fn bound(object: &str, quantity: &str, value: impl std::fmt::Display, bound: &str, remedy: &str) -> Self {
        Self::Input(format!("{object}: {quantity} = {value}, must be {bound}; {remedy}"))
    }
}

impl Error {
    /// What kind of end a run comes to by this error.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Input(_) => Kind::NotFinite,
            Self::Run(kind, _) => *kind,
        }
    }
}

/// `Result` of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// A number for a message: three significant digits, plain where that is short.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-4..5).contains(&exponent) {
        let digits = (2 - exponent).max(0) as usize;
        let text = format!("{value:.digits$}");
        return if digits == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_string() };
    }
    format!("{value:.2e}")
}
