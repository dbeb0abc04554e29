//! Shapes of the elements: which lanes have turned one inside out.

use crate::contact::surface::position;
use crate::element::signed_area;
use crate::lane::Lane;
use crate::model::Model;
use crate::nodal_sums::by_node;
use crate::stiffness::simd::{Isa, Loop, Madd, dispatch};

/// Marks the lanes in which some element has no area left.
pub fn inverted(isa: Isa, model: &Model, lanes: usize, displacement: &[f64], seen: &mut [bool]) {
    match lanes {
        1 => dispatch(isa, Pass::<1> { model, displacement, seen }),
        2 => dispatch(isa, Pass::<2> { model, displacement, seen }),
        4 => dispatch(isa, Pass::<4> { model, displacement, seen }),
        8 => dispatch(isa, Pass::<8> { model, displacement, seen }),
        _ => dispatch(isa, Pass::<16> { model, displacement, seen }),
    }
}

struct Pass<'a, const L: usize> {
    model: &'a Model,
    displacement: &'a [f64],
    seen: &'a mut [bool],
}

impl<const L: usize> Loop for Pass<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<M: Madd>(self) {
        let (u, mut seen) = (by_node::<L>(self.displacement), [false; L]);
        for body in &self.model.bodies {
            body.triangles.iter().for_each(|t| mark(self.model, t, u, &mut seen));
            body.quads.iter().for_each(|q| mark(self.model, q, u, &mut seen));
        }
        self.seen[..L].copy_from_slice(&seen);
    }
}

/// Marks the lanes in which the polygon has no area left: triangles from its first corner, summed.
#[inline(always)]
fn mark<const L: usize>(model: &Model, nodes: &[u32], u: &[[[f64; L]; 2]], seen: &mut [bool; L]) {
    let first = nodes[0] as usize;
    let from_first = |n: u32| -> [[f64; L]; 2] {
        let n = n as usize;
        std::array::from_fn(|axis| {
            let x = model.points[n][axis] - model.points[first][axis];
            std::array::from_fn(|lane| x + (u[n][axis][lane] - u[first][axis][lane]))
        })
    };
    let (mut doubled, mut a) = ([0.0; L], from_first(nodes[1]));
    for &n in &nodes[2..] {
        let b = from_first(n);
        for lane in 0..L {
            doubled[lane] += a[0][lane] * b[1][lane] - a[1][lane] * b[0][lane];
        }
        a = b;
    }
    for lane in 0..L {
        seen[lane] |= doubled[lane] <= 0.0;
    }
}

/// First inverted element of one lane, by kind, number and body.
pub fn first_inverted(model: &Model, displacement: Lane) -> Option<String> {
    let at = |n: u32| position(n, &model.points, displacement);
    model.bodies.iter().find_map(|body| {
        let triangle = body.triangles.iter().position(|t| signed_area(&t.map(at)) <= 0.0);
        let quad = || body.quads.iter().position(|q| signed_area(&q.map(at)) <= 0.0);
        let found = triangle.map(|e| ("triangle", e)).or_else(|| quad().map(|e| ("quad", e)));
        found.map(|(kind, e)| format!("{kind} {e} of \"{}\"", body.name))
    })
}
