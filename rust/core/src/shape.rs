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
            for nodes in &body.triangles {
                mark(self.model, nodes, u, &mut seen);
            }
            for nodes in &body.quads {
                mark(self.model, nodes, u, &mut seen);
            }
        }
        self.seen[..L].copy_from_slice(&seen);
    }
}

/// Marks the lanes in which the polygon has no area left: triangles from its first corner, summed.
#[inline(always)]
fn mark<const L: usize>(model: &Model, nodes: &[u32], u: &[[[f64; L]; 2]], seen: &mut [bool; L]) {
    let (mut doubled, mut a) = ([0.0; L], edge(model, [nodes[0], nodes[1]], u));
    for &node in &nodes[2..] {
        let b = edge(model, [nodes[0], node], u);
        for lane in 0..L {
            doubled[lane] += a[0][lane] * b[1][lane] - a[1][lane] * b[0][lane];
        }
        a = b;
    }
    for lane in 0..L {
        seen[lane] |= doubled[lane] <= 0.0;
    }
}

/// Vector from one node to another.
#[inline(always)]
fn edge<const L: usize>(model: &Model, [from, to]: [u32; 2], u: &[[[f64; L]; 2]]) -> [[f64; L]; 2] {
    let (from, to, mut out) = (from as usize, to as usize, [[0.0; L]; 2]);
    for axis in 0..2 {
        let x = model.points[to][axis] - model.points[from][axis];
        for lane in 0..L {
            out[axis][lane] = x + (u[to][axis][lane] - u[from][axis][lane]);
        }
    }
    out
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
