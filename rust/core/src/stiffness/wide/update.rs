//! Update of one node by the wide kernel.
#![expect(clippy::needless_range_loop, reason = "one index counts registers in several arrays")]

use super::registers::{Register, Sums};

/// What multiplies velocity, M^-1 K u (negative) and M^-1 f in the lanes of V registers.
pub(super) struct Update<R, const V: usize> {
    dt: [R; V],
    elastic_dt: [R; V],
    load_dt: [R; V],
}

impl<R: Register, const V: usize> Update<R, V> {
    /// The factors of V registers from lane `first` on.
    // SAFETY: as for `Register`; `first` and V registers lie within the lanes.
    #[inline(always)]
    pub(super) unsafe fn new<const L: usize>(
        dt: &[f64; L],
        elastic_dt: &[f64; L],
        load_dt: &[f64; L],
        first: usize,
    ) -> Self {
        // SAFETY: as above.
        unsafe {
            let zero = [R::all(0.0); V];
            let mut out = Self { dt: zero, elastic_dt: zero, load_dt: zero };
            for part in 0..V {
                let lane = first + R::WIDTH * part;
                out.dt[part] = R::load(dt.as_ptr().add(lane));
                out.elastic_dt[part] = R::load(elastic_dt.as_ptr().add(lane));
                out.load_dt[part] = R::load(load_dt.as_ptr().add(lane));
            }
            out
        }
    }

    /// Velocity and next displacement of one node from its sums and load.
    // SAFETY: as for `new`.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "everything there is about a node, in registers or in place")]
    pub(super) unsafe fn node<const L: usize>(
        &self,
        first: usize,
        w: [f64; 2],
        f: Option<[f64; 2]>,
        sum: &Sums<R, V>,
        x: &[[f64; L]; 2],
        velocity: &mut [[f64; L]; 2],
        next: &mut [[f64; L]; 2],
    ) {
        // SAFETY: as above.
        unsafe {
            // xx + xy and yy + yx.
            for (axis, [one, other]) in [[0, 3], [1, 2]].into_iter().enumerate() {
                let w = R::all(w[axis]);
                for part in 0..V {
                    let lane = first + R::WIDTH * part;
                    let x = R::load(x[axis].as_ptr().add(lane));
                    let mut v = R::load(velocity[axis].as_ptr().add(lane));
                    v = self.elastic_dt[part].times(w).madd(sum[one][part].plus(sum[other][part]), v);
                    if let Some(f) = f {
                        v = self.load_dt[part].times(w).madd(R::all(f[axis]), v);
                    }
                    v.store(velocity[axis].as_mut_ptr().add(lane));
                    self.dt[part].madd(v, x).store(next[axis].as_mut_ptr().add(lane));
                }
            }
        }
    }
}
