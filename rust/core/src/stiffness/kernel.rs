//! THE kernel: one pass over K advances every lane of a range of nodes.

use super::BlockCsr;
use super::simd::{Isa, Loop, Madd, dispatch};

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
/// Every lane sees the same operations in the same order whatever the number of lanes.
pub fn advance<const L: usize>(
    isa: Isa,
    pass: &Pass<L>,
    range: std::ops::Range<usize>,
    velocity: &mut [[f64; L]],
    next: &mut [[f64; L]],
) {
    dispatch(isa, Advance { pass, range, velocity, next });
}

struct Advance<'a, const L: usize> {
    pass: &'a Pass<'a, L>,
    range: std::ops::Range<usize>,
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
    fn sweep<M: Madd>(self, loaded: impl Fn(usize, [[f64; L]; 2], [[f64; L]; 2]) -> [[f64; L]; 2]) {
        let Pass { stiffness, dt, elastic_dt, load_dt, .. } = *self.pass;
        let (nodes, u) = (self.range.clone(), self.pass.displacement.as_chunks::<2>().0);
        let starts = stiffness.row_start[nodes.start..=nodes.end].array_windows::<2>();
        let own = u[nodes.clone()].iter().zip(&self.pass.inverse_mass[nodes.clone()]);
        let out = self.velocity.as_chunks_mut::<2>().0.iter_mut().zip(self.next.as_chunks_mut::<2>().0);
        for (node, (([start, end], (x, w)), (v, next))) in nodes.zip(starts.zip(own).zip(out)) {
            let blocks = *start as usize..*end as usize;
            let force = product::<L, M>(&stiffness.block[blocks.clone()], &stiffness.column[blocks], u);
            let mut new = *v;
            for axis in 0..2 {
                for lane in 0..L {
                    new[axis][lane] = M::madd(-elastic_dt[lane] * w[axis], force[axis][lane], new[axis][lane]);
                }
            }
            new = loaded(node, new, w.map(|w| load_dt.map(|dt| dt * w)));
            for axis in 0..2 {
                for lane in 0..L {
                    next[axis][lane] = M::madd(dt[lane], new[axis][lane], x[axis][lane]);
                }
            }
            *v = new;
        }
    }
}

/// One block row times u: four sums, one a block entry, so that the order is the same for 1, 8 and 16 lanes.
#[inline(always)]
fn product<const L: usize, M: Madd>(blocks: &[[f64; 4]], columns: &[u32], u: &[[[f64; L]; 2]]) -> [[f64; L]; 2] {
    let mut sum = [[0.0; L]; 4];
    for (k, &column) in blocks.iter().zip(columns) {
        let [ux, uy] = u[column as usize];
        let factor = [ux, ux, uy, uy];
        for entry in 0..4 {
            for lane in 0..L {
                sum[entry][lane] = M::madd(k[entry], factor[entry][lane], sum[entry][lane]);
            }
        }
    }
    std::array::from_fn(|axis| std::array::from_fn(|lane| sum[axis][lane] + sum[axis + 2][lane]))
}
