//! THE kernel: one pass over K advances every lane of a range of nodes.

use std::ops::Range;

use super::BlockCsr;
use super::rows::{Force, Rows};
use super::simd::{Isa, Loop, Madd, dispatch};
#[cfg(target_arch = "x86_64")]
use super::single;

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
    if L == 1 && isa != Isa::Baseline && isa.is_here() {
        return single::advance(pass, range, velocity.as_flattened_mut(), next.as_flattened_mut());
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
    fn run<M: Madd>(mut self) {
        let rows = Rows::new(self.pass.stiffness, self.pass.displacement);
        let mut node = self.range.start;
        while node < self.range.end {
            if M::PAIRS && L > 1 && node + 1 < self.range.end && rows.paired(node) {
                let [force, next_force] = rows.two::<M>(node);
                self.update::<M>(node, force, rows.at(node));
                self.update::<M>(node + 1, next_force, rows.at(node + 1));
                node += 2;
            } else {
                self.update::<M>(node, rows.one::<M>(node), rows.at(node));
                node += 1;
            }
        }
    }
}

impl<const L: usize> Advance<'_, L> {
    /// Velocity and displacement x of one node under the force K u.
    #[inline(always)]
    fn update<M: Madd>(&mut self, node: usize, force: Force<L>, x: &[[f64; L]; 2]) {
        // Copied, so that what is written cannot be one of them: each loop over lanes is then one instruction a register.
        let Pass { dt, elastic_dt, load_dt, .. } = *self.pass;
        let (w, at) = (self.pass.inverse_mass[node], node - self.range.start);
        let v = &mut self.velocity.as_chunks_mut::<2>().0[at];
        let (mut new, mut moved) = (*v, *x);
        for axis in 0..2 {
            for lane in 0..L {
                new[axis][lane] = M::madd(-elastic_dt[lane] * w[axis], force[axis][lane], new[axis][lane]);
            }
        }
        if let Some(load) = self.pass.load {
            let f = load[node];
            for axis in 0..2 {
                for lane in 0..L {
                    new[axis][lane] = M::madd(load_dt[lane] * w[axis], f[axis], new[axis][lane]);
                }
            }
        }
        for axis in 0..2 {
            for lane in 0..L {
                moved[axis][lane] = M::madd(dt[lane], new[axis][lane], moved[axis][lane]);
            }
        }
        *v = new;
        self.next.as_chunks_mut::<2>().0[at] = moved;
    }
}
