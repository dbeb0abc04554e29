//! THE kernel: one pass over K advances every lane of a range of nodes.

use super::BlockCsr;
use super::simd::{Isa, Madd, dispatch};

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

pub(super) struct Advance<'a, const L: usize> {
    pass: &'a Pass<'a, L>,
    range: std::ops::Range<usize>,
    velocity: &'a mut [[f64; L]],
    next: &'a mut [[f64; L]],
}

impl<const L: usize> Advance<'_, L> {
    /// The loop itself, compiled once for each instruction set.
    #[inline(always)]
    pub(super) fn run<M: Madd>(self) {
        let (p, first) = (self.pass, self.range.start);
        let rows = &p.stiffness.row_start[first..=self.range.end];
        let out = self.velocity.as_chunks_mut::<2>().0.iter_mut().zip(self.next.as_chunks_mut::<2>().0);
        for (i, (window, (v, next))) in rows.array_windows::<2>().zip(out).enumerate() {
            let (node, blocks) = (first + i, window[0] as usize..window[1] as usize);
            let [fx, fy] = product_row::<L, M>(p, blocks);
            let [wx, wy] = p.inverse_mass[node];
            let [lx, ly] = p.load.map_or([0.0; 2], |load| load[node]);
            for lane in 0..L {
                let (dt, elastic) = (p.dt[lane], p.elastic_dt[lane]);
                let mut vx = M::madd(-elastic * wx, fx[lane], v[0][lane]);
                let mut vy = M::madd(-elastic * wy, fy[lane], v[1][lane]);
                if p.load.is_some() {
                    vx = M::madd(dt * wx, lx, vx);
                    vy = M::madd(dt * wy, ly, vy);
                }
                v[0][lane] = vx;
                v[1][lane] = vy;
                next[0][lane] = M::madd(dt, vx, p.displacement[2 * node][lane]);
                next[1][lane] = M::madd(dt, vy, p.displacement[2 * node + 1][lane]);
            }
        }
    }
}

/// One block row times u: four sums, one a block entry, so that the order is the same for 1, 8 and 16 lanes.
#[inline(always)]
fn product_row<const L: usize, M: Madd>(p: &Pass<L>, blocks: std::ops::Range<usize>) -> [[f64; L]; 2] {
    let mut sum = [[0.0; L]; 4];
    let u = p.displacement.as_chunks::<2>().0;
    for (k, &column) in p.stiffness.block[blocks.clone()].iter().zip(&p.stiffness.column[blocks]) {
        let [ux, uy] = &u[column as usize];
        for lane in 0..L {
            sum[0][lane] = M::madd(k[0], ux[lane], sum[0][lane]);
            sum[1][lane] = M::madd(k[1], ux[lane], sum[1][lane]);
            sum[2][lane] = M::madd(k[2], uy[lane], sum[2][lane]);
            sum[3][lane] = M::madd(k[3], uy[lane], sum[3][lane]);
        }
    }
    let mut product = [[0.0; L]; 2];
    for lane in 0..L {
        product[0][lane] = sum[0][lane] + sum[2][lane];
        product[1][lane] = sum[1][lane] + sum[3][lane];
    }
    product
}
