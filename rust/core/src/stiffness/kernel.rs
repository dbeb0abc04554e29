//! THE kernel: one pass over K advances every lane of a range of nodes.

use std::ops::Range;

use super::BlockCsr;
use super::rows::{Force, Rows};
use super::simd::{Isa, Loop, Madd, dispatch};
#[cfg(target_arch = "x86_64")]
use super::{single, wide};

/// What the pass reads besides K. Arrays over nodes are [node][axis][lane].
#[derive(Clone, Copy)]
pub struct Pass<'a, const L: usize> {
    /// Stiffness K (N/m).
    pub stiffness: &'a BlockCsr,
    /// Inverse lumped mass (1/kg) by node and axis; 0 where a degree of freedom is fixed.
    pub inverse_mass: &'a [[f64; 2]],
    /// Nodal load (N), only where the scene has any.
    pub load: Option<&'a [[f64; 2]]>,
    /// Displacement u_n (m).
    pub displacement: &'a [[f64; L]],
    /// Time step (s) of each lane.
    pub dt: [f64; L],
    /// dt of each lane times its stiffness over mass scale: what multiplies M^-1 K u.
    pub elastic_dt: [f64; L],
    /// dt of each lane over its mass scale: what multiplies M^-1 f.
    pub load_dt: [f64; L],
}

/// `v += dt M^-1 (f - K u)`, `next = u + dt v` for the nodes of `range`; `velocity` and `next` cover the range only.
///
/// Every lane sees the same operations in the same order whatever the number of lanes. 8 and 16 lanes are fastest in
/// arrays that begin at a cache line ([`super::Aligned`]).
///
/// # Panics
/// Arrays shorter than the matrix or the range.
pub fn advance<const L: usize>(
    isa: Isa,
    pass: &Pass<L>,
    range: Range<usize>,
    velocity: &mut [[f64; L]],
    next: &mut [[f64; L]],
) {
    #[cfg(target_arch = "x86_64")]
    match (L, isa) {
        (1, Isa::Avx2 | Isa::Avx512) if isa.is_here() => {
            return single::advance(pass, range, velocity.as_flattened_mut(), next.as_flattened_mut());
        }
        (8 | 16, Isa::Avx2 | Isa::Avx512) if isa.is_here() => return wide::advance(isa, pass, range, velocity, next),
        _ => {}
    }
    dispatch(isa, Advance { pass, range, velocity, next });
}

struct Advance<'a, const L: usize> {
    pass: &'a Pass<'a, L>,
    range: Range<usize>,
    velocity: &'a mut [[f64; L]],
    next: &'a mut [[f64; L]],
}

impl<const L: usize> Loop for Advance<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<M: Madd>(self) {
        let Self { pass, range, velocity, next } = self;
        let rows = Rows::new(pass.stiffness, pass.displacement);
        let nodes = range.len();
        let inverse_mass = &pass.inverse_mass[range.clone()];
        let load = pass.load.map(|load| &load[range.clone()]);
        let velocity = &mut velocity.as_chunks_mut::<2>().0[..nodes];
        let next = &mut next.as_chunks_mut::<2>().0[..nodes];
        // Copied, so that nothing written can be one of them: they stay in registers.
        let update = Update { dt: pass.dt, elastic_dt: pass.elastic_dt.map(|dt| -dt), load_dt: pass.load_dt };
        for at in 0..nodes {
            let (node, f) = (range.start + at, load.map(|load| load[at]));
            let force = rows.one::<M>(node);
            next[at] = update.node::<M>(inverse_mass[at], f, &force, &mut velocity[at], rows.at(node));
        }
    }
}

/// What multiplies velocity, M^-1 K u (negative) and M^-1 f.
struct Update<const L: usize> {
    dt: [f64; L],
    elastic_dt: [f64; L],
    load_dt: [f64; L],
}

impl<const L: usize> Update<L> {
    /// New velocity of a node in place, and its new displacement from x, under the force K u and the load f.
    #[expect(clippy::needless_range_loop, reason = "one index counts lanes in several arrays")]
    #[inline(always)]
    fn node<M: Madd>(
        &self,
        w: [f64; 2],
        f: Option<[f64; 2]>,
        force: &Force<L>,
        v: &mut [[f64; L]; 2],
        x: &[[f64; L]; 2],
    ) -> [[f64; L]; 2] {
        let (mut new, mut moved) = (*v, *x);
        for axis in 0..2 {
            for lane in 0..L {
                new[axis][lane] = M::madd(self.elastic_dt[lane] * w[axis], force[axis][lane], new[axis][lane]);
            }
        }
        if let Some(f) = f {
            for axis in 0..2 {
                for lane in 0..L {
                    new[axis][lane] = M::madd(self.load_dt[lane] * w[axis], f[axis], new[axis][lane]);
                }
            }
        }
        for axis in 0..2 {
            for lane in 0..L {
                moved[axis][lane] = M::madd(self.dt[lane], new[axis][lane], moved[axis][lane]);
            }
        }
        *v = new;
        moved
    }
}
