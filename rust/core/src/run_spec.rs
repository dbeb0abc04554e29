//! What tells one run of a model from another, and the checks before it starts.

use crate::contact::overlap::{self, Overlap};
use crate::critical_step::{assembled_bound, element_bound};
use crate::error::{Error, Result};
use crate::lane::Lane;
use crate::model::Model;
use crate::penalty::Method;

/// What tells one run of a model from another.
#[derive(Debug, Clone)]
pub struct RunSpec {
    /// Penalty method.
    pub method: Method,
    /// Time step (s).
    pub dt: f64,
    /// Accept a time step above the element bound.
    pub allow_unstable: bool,
    /// Initial velocity v_0 (m/s), two a node.
    pub velocity: Vec<f64>,
    /// Initial displacement u_0 (m), two a node.
    pub displacement: Vec<f64>,
    /// End the run when a nodal displacement passes this (m); infinite for no limit.
    pub displacement_limit: f64,
}

pub(crate) fn check_displacement_limit(limit: f64) -> Result<()> {
    if limit > 0.0 {
        return Ok(());
    }
    Err(Error::bound("run", "displacement_limit", limit, "> 0", "leave it out for no limit"))
}

pub(crate) fn check_step(model: &Model, spec: &RunSpec) -> Result<()> {
    let dt = spec.dt;
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(Error::bound("run", "dt", dt, "> 0 and finite", "leave it out to take it from the mesh"));
    }
    if dt <= element_bound(model) || spec.allow_unstable {
        return Ok(());
    }
    // The element bound is cheap and safe; past it the assembled matrix has the last word.
    let limit = assembled_bound(model);
    if dt > limit {
        let bound = format!("<= {limit:.6e} s (2/omega_max of the mesh)");
        return Err(Error::bound("run", "dt", format!("{dt:.6e} s"), &bound, "reduce it, or pass allow_unstable=True"));
    }
    Ok(())
}

pub(crate) fn check_overlap(model: &Model, displacement: Lane) -> Result<()> {
    for pair in &model.pairs {
        let contact = &model.contacts[pair.contact as usize];
        let body = &model.bodies[pair.secondary_body as usize];
        let (points, inner) = (&model.points, body.inner_point(&model.points, displacement));
        let mut found = overlap::deepest(pair, inner, points, displacement).map(|o| (body, o));
        if let Some(other) = pair.primary_body {
            // The other way round: a corner of the primary in a side of the secondary.
            let (other, surface) = (&model.bodies[other as usize], model.surface(pair.secondary_body));
            let (nodes, inner) = (other.surface_nodes(), other.inner_point(points, displacement));
            let theirs = overlap::deepest_in(&surface, &nodes, inner, points, displacement).map(|o| (other, o));
            let deeper = |a: &Option<(_, Overlap)>| a.as_ref().map_or(0.0, |(_, o)| o.depth);
            found = if deeper(&theirs) > deeper(&found) { theirs } else { found };
        }
        let Some((body, Overlap { node, depth })) = found else { continue };
        if depth > contact.overlap_tolerance {
            let [first, second] = &contact.names;
            let place = node.map_or("the inside".into(), |n| format!("node {}", n as usize - body.nodes.start));
            let what = format!("overlap at {place} of \"{}\"", body.name);
            let bound = format!("<= {:.3e} m at the start", contact.overlap_tolerance);
            let object = format!("contact \"{first}\" on \"{second}\"");
            let remedy = "move the bodies apart or raise the contact's overlap_tolerance";
            return Err(Error::bound(&object, &what, format!("{depth:.3e} m"), &bound, remedy));
        }
    }
    Ok(())
}
