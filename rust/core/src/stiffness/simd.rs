//! Instruction sets: the same loop compiled for each, chosen once at run time.

use super::kernel::Advance;

/// Instruction set the kernel runs with.
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
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("fma") {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// Name for reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2+fma",
            Self::Avx512 => "avx512f+fma",
        }
    }
}

/// `a b + c`, fused where the instruction set has it: without hardware support fusing is a slow library call.
pub(super) trait Madd {
    fn madd(a: f64, b: f64, c: f64) -> f64;
}

pub(super) struct Fused;
pub(super) struct Separate;

impl Madd for Fused {
    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

impl Madd for Separate {
    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

/// Runs the loop with the instruction set asked for, or the widest the machine has if it lacks that one.
pub(super) fn dispatch<const L: usize>(isa: Isa, advance: Advance<L>) {
    #[cfg(target_arch = "x86_64")]
    match isa {
        // SAFETY: both branches run only when the machine has just been asked for the features they need.
        Isa::Avx512 if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("fma") => {
            return unsafe { with_avx512(advance) };
        }
        Isa::Avx2 if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") => {
            return unsafe { with_avx2(advance) };
        }
        _ => {}
    }
    advance.run::<Separate>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,fma")]
fn with_avx512<const L: usize>(advance: Advance<L>) {
    advance.run::<Fused>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2<const L: usize>(advance: Advance<L>) {
    advance.run::<Fused>();
}
