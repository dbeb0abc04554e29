//! Instruction sets: the same loop compiled for each, chosen once at run time.

use crate::error::{Error, Result};

/// Instruction set that the loops over nodes run with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// What every machine of the target has; products and sums rounded one by one.
    Baseline,
    /// AVX2 with fused multiply-add.
    Avx2,
    /// AVX-512 with fused multiply-add.
    Avx512,
}

impl Isa {
    /// The widest set this machine has.
    pub fn detect() -> Self {
        Self::available().last().unwrap_or(Self::Baseline)
    }

    /// The sets this machine has, narrowest first.
    pub fn available() -> impl Iterator<Item = Self> {
        [Self::Baseline, Self::Avx2, Self::Avx512].into_iter().filter(|isa| isa.is_here())
    }

    /// The set of a name, or the widest this machine has for "auto".
    ///
    /// # Errors
    /// A name that is none of these, or a set this machine lacks.
    pub fn named(name: &str) -> Result<Self> {
        if name == "auto" {
            return Ok(Self::detect());
        }
        Self::available().find(|isa| isa.name() == name).ok_or_else(|| {
            let here: Vec<String> = Self::available().map(|isa| format!("\"{}\"", isa.name())).collect();
            let bound = format!("\"auto\" or one that this machine has ({})", here.join(", "));
            Error::bound("kernel", "instruction set", format!("\"{name}\""), &bound, "leave it at \"auto\"")
        })
    }

    /// Name by which it is asked for and reported.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// True when this machine has it.
    pub(crate) fn is_here(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => Self::Avx2.is_here() && is_x86_feature_detected!("avx512f"),
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }
}

/// What a loop needs to know of the instruction set it is compiled for.
pub(crate) trait Madd {
    /// `a b + c`, fused where the instruction set has it: without hardware support fusing is a slow library call.
    fn madd(a: f64, b: f64, c: f64) -> f64;
}

struct Baseline;
struct Avx2;
struct Avx512;

impl Madd for Baseline {
    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

impl Madd for Avx2 {
    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

impl Madd for Avx512 {
    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

/// A loop to be compiled for each instruction set.
///
/// `run` and what it calls, closures too, must be `#[inline(always)]`: what stays a call is compiled for the baseline,
/// where each fused multiply-add is a library call.
pub(crate) trait Loop {
    type Output;
    fn run<M: Madd>(self) -> Self::Output;
}

/// Runs the loop with the instruction set asked for, or with the baseline where the machine lacks it.
pub(crate) fn dispatch<T: Loop>(isa: Isa, work: T) -> T::Output {
    #[cfg(target_arch = "x86_64")]
    match isa {
        // SAFETY: both branches run only when the machine has just been asked for the features they need.
        Isa::Avx512 if isa.is_here() => return unsafe { with_avx512(work) },
        Isa::Avx2 if isa.is_here() => return unsafe { with_avx2(work) },
        _ => {}
    }
    work.run::<Baseline>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,fma")]
fn with_avx512<T: Loop>(work: T) -> T::Output {
    work.run::<Avx512>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2<T: Loop>(work: T) -> T::Output {
    work.run::<Avx2>()
}
