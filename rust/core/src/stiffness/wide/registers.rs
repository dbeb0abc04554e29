//! What the wide kernel does with registers: products of a block, the update of a node.
//!
//! Everything is inlined by force: as a call of its own it would pass its registers through memory.
#![expect(clippy::needless_range_loop, reason = "one index counts registers in several arrays")]

use std::arch::x86_64::{
    __m512d, _mm512_add_pd, _mm512_fmadd_pd, _mm512_loadu_pd, _mm512_mul_pd, _mm512_set1_pd, _mm512_setzero_pd,
    _mm512_storeu_pd,
};

use crate::stiffness::Block;

/// The four sums of a row, one a block entry.
pub(super) type Sums<const V: usize> = [[__m512d; V]; 4];
/// Numbers in a register.
pub(super) const WIDTH: usize = 8;

/// What multiplies velocity, M^-1 K u (negative) and M^-1 f.
pub(super) struct Update<const V: usize> {
    dt: [__m512d; V],
    elastic_dt: [__m512d; V],
    load_dt: [__m512d; V],
}

impl<const V: usize> Update<V> {
    // SAFETY: to be called with AVX-512 only.
    #[inline(always)]
    pub(super) unsafe fn new<const L: usize>(dt: &[f64; L], elastic_dt: &[f64; L], load_dt: &[f64; L]) -> Self {
        // SAFETY: as above.
        unsafe {
            let zero = [_mm512_setzero_pd(); V];
            let mut out = Self { dt: zero, elastic_dt: zero, load_dt: zero };
            for part in 0..V {
                out.dt[part] = load(dt, part);
                out.elastic_dt[part] = load(elastic_dt, part);
                out.load_dt[part] = load(load_dt, part);
            }
            out
        }
    }

    /// Velocity and next displacement of one node from its sums and load.
    // SAFETY: to be called with AVX-512 only.
    #[inline(always)]
    pub(super) unsafe fn node<const L: usize>(
        &self,
        w: [f64; 2],
        f: Option<[f64; 2]>,
        sum: &Sums<V>,
        x: &[[f64; L]; 2],
        velocity: &mut [[f64; L]; 2],
        next: &mut [[f64; L]; 2],
    ) {
        // SAFETY: as above.
        unsafe {
            // xx + xy and yy + yx.
            for (axis, [first, second]) in [[0, 3], [1, 2]].into_iter().enumerate() {
                let w = _mm512_set1_pd(w[axis]);
                for part in 0..V {
                    let (old, x) = (load(&velocity[axis], part), load(&x[axis], part));
                    let force = _mm512_add_pd(sum[first][part], sum[second][part]);
                    let mut v = _mm512_fmadd_pd(_mm512_mul_pd(self.elastic_dt[part], w), force, old);
                    if let Some(f) = f {
                        v = _mm512_fmadd_pd(_mm512_mul_pd(self.load_dt[part], w), _mm512_set1_pd(f[axis]), v);
                    }
                    store(&mut velocity[axis], part, v);
                    store(&mut next[axis], part, _mm512_fmadd_pd(self.dt[part], v, x));
                }
            }
        }
    }
}

/// Adds one block's four products.
// SAFETY: to be called with AVX-512 only.
#[inline(always)]
pub(super) unsafe fn add<const L: usize, const V: usize>(sum: &mut Sums<V>, block: &Block, u: &[[f64; L]; 2]) {
    // SAFETY: as above.
    unsafe {
        let [k0, k1, k2, k3] = spread(block);
        for part in 0..V {
            let (ux, uy) = (load(&u[0], part), load(&u[1], part));
            sum[0][part] = _mm512_fmadd_pd(k0, ux, sum[0][part]);
            sum[1][part] = _mm512_fmadd_pd(k1, uy, sum[1][part]);
            sum[2][part] = _mm512_fmadd_pd(k2, ux, sum[2][part]);
            sum[3][part] = _mm512_fmadd_pd(k3, uy, sum[3][part]);
        }
    }
}

/// Each entry of a block in all lanes of a register.
// SAFETY: to be called with AVX-512 only.
#[inline(always)]
unsafe fn spread(block: &Block) -> [__m512d; 4] {
    let [k0, k1, k2, k3] = block.0;
    // SAFETY: as above.
    unsafe { [_mm512_set1_pd(k0), _mm512_set1_pd(k1), _mm512_set1_pd(k2), _mm512_set1_pd(k3)] }
}

/// One register's worth of lanes.
// SAFETY: to be called with AVX-512 only.
#[inline(always)]
unsafe fn load<const L: usize>(lanes: &[f64; L], part: usize) -> __m512d {
    let lanes: &[f64; WIDTH] = &lanes.as_chunks().0[part];
    // SAFETY: eight numbers; the load asks for no alignment.
    unsafe { _mm512_loadu_pd(lanes.as_ptr()) }
}

// SAFETY: to be called with AVX-512 only.
#[inline(always)]
unsafe fn store<const L: usize>(lanes: &mut [f64; L], part: usize, value: __m512d) {
    let lanes: &mut [f64; WIDTH] = &mut lanes.as_chunks_mut().0[part];
    // SAFETY: eight numbers; the store asks for no alignment.
    unsafe { _mm512_storeu_pd(lanes.as_mut_ptr(), value) }
}
