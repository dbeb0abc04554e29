//! THE kernel: one pass over K advances every lane of a range of nodes.

use std::ops::Range;

use super::BlockCsr;
use super::rows::{Force, Rows};
use super::simd::{Isa, Loop, Madd, dispatch};
#[cfg(target_arch = "x86_64")]
use super::single;

/// What the pass reads besides K. Arrays over nodes are [node][axis][lane].
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

    /// The loop itself, without loads where the scene has none.
    #[inline(always)]
    fn run<M: Madd>(self) {
        match self.pass.load {
            None => self.sweep::<M>(|_, v, _| v),
            Some(load) => self.sweep::<M>(|node, v, dt_w| {
                let f = load[node];
                std::array::from_fn(|axis| {
                    std::array::from_fn(|lane| M::madd(dt_w[axis][lane], f[axis], v[axis][lane]))
                })
            }),
        }
    }
}

impl<const L: usize> Advance<'_, L> {
    /// `loaded` adds dt M^-1 f to a node's velocity.
    #[inline(always)]
    fn sweep<M: Madd>(self, loaded: impl Fn(usize, Force<L>, Force<L>) -> Force<L>) {
        let Pass { dt, elastic_dt, load_dt, .. } = *self.pass;
        let rows = Rows::new(self.pass.stiffness, self.pass.displacement);
        let inverse_mass = &self.pass.inverse_mass[self.range.clone()];
        let velocity = &mut self.velocity.as_chunks_mut::<2>().0[..self.range.len()];
        let next = &mut self.next.as_chunks_mut::<2>().0[..self.range.len()];
        let mut update = |at: usize, force: Force<L>| {
            let (node, w, v) = (self.range.start + at, inverse_mass[at], &mut velocity[at]);
            let mut new = *v;
            for axis in 0..2 {
                for lane in 0..L {
                    new[axis][lane] = M::madd(-elastic_dt[lane] * w[axis], force[axis][lane], new[axis][lane]);
                }
            }
            new = loaded(node, new, w.map(|w| load_dt.map(|dt| dt * w)));
            let x = rows.at(node);
            for axis in 0..2 {
                for lane in 0..L {
                    next[at][axis][lane] = M::madd(dt[lane], new[axis][lane], x[axis][lane]);
                }
            }
            *v = new;
        };
        let mut at = 0;
        while at < self.range.len() {
            let node = self.range.start + at;
            if M::PAIRS && L > 1 && at + 1 < self.range.len() && rows.paired(node) {
                let [a, b] = rows.two::<M>(node);
                update(at, a);
                update(at + 1, b);
                at += 2;
            } else {
                update(at, rows.one::<M>(node));
                at += 1;
            }
        }
    }
}
