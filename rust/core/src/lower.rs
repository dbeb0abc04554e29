//! Lowering of contacts: names to surfaces and pairs.

use std::collections::HashMap;

use crate::contact::overlap::TOLERANCE;
use crate::contact::pair::SurfaceNode;
use crate::contact::surface::Vertices;
use crate::contact::{Pair, Primary, Surface};
use crate::error::{Error, Result};
use crate::model::{Body, Contact, Model};
use crate::scene::{ContactSpec, Obstacle};

/// Body of a name, with its number.
pub(crate) fn find_body<'m>(bodies: &'m [Body], name: &str, object: &str) -> Result<(u32, &'m Body)> {
    let found = bodies.iter().enumerate().find(|(_, body)| body.name == name);
    found.map(|(i, body)| (i as u32, body)).ok_or_else(|| {
        let known: Vec<&str> = bodies.iter().map(|b| b.name.as_str()).collect();
        let bound = format!("one of the scene's bodies {known:?}");
        Error::bound(object, "body", format!("\"{name}\""), &bound, "correct the name or add the body")
    })
}

/// Adds the pairs of one contact.
pub(crate) fn add_contact(model: &mut Model, spec: &ContactSpec, obstacles: &[(String, Obstacle)]) -> Result<()> {
    let object = format!("contact \"{}\" on \"{}\"", spec.secondary, spec.primary);
    if spec.secondary == spec.primary {
        let name = format!("\"{}\"", spec.primary);
        return Err(Error::bound(&object, "primary", name, "another body", "self-contact is not modelled"));
    }
    if !(1..=2).contains(&spec.passes) {
        return Err(Error::bound(&object, "passes", spec.passes, "1 or 2", "1 is the usual choice"));
    }
    let (body, secondary) = find_body(&model.bodies, &spec.secondary, &object)?;
    let contact = model.contacts.len() as u32;
    let mut pairs = Vec::new();
    if let Some((_, obstacle)) = obstacles.iter().find(|(name, _)| *name == spec.primary) {
        if spec.passes == 2 {
            let remedy = "a rigid obstacle has no nodes of its own to check";
            return Err(Error::bound(&object, "passes", 2, "1 against a rigid obstacle", remedy));
        }
        let primary = rigid(&spec.primary, obstacle)?;
        pairs.push(pair(model, contact, body, secondary, primary, None));
    } else {
        let (other, primary) =
            find_body(&model.bodies, &spec.primary, &object).map_err(|e| with_obstacles(e, obstacles))?;
        pairs.push(pair(model, contact, body, secondary, Primary::Surface(model.surface(other)), Some(other)));
        if spec.passes == 2 {
            pairs.push(pair(model, contact, other, primary, Primary::Surface(model.surface(body)), Some(body)));
        }
    }
    let length = pairs.iter().map(Pair::segment_length).fold(f64::INFINITY, f64::min);
    let overlap_tolerance = spec.overlap_tolerance.unwrap_or(TOLERANCE * length);
    if !(overlap_tolerance >= 0.0 && overlap_tolerance.is_finite()) {
        let remedy = "leave it out for the default";
        return Err(Error::bound(&object, "overlap_tolerance", overlap_tolerance, ">= 0 and finite", remedy));
    }
    model.pairs.extend(pairs);
    model.contacts.push(Contact { names: [spec.secondary.clone(), spec.primary.clone()], body, overlap_tolerance });
    Ok(())
}

fn with_obstacles(error: Error, obstacles: &[(String, Obstacle)]) -> Error {
    let known: Vec<&str> = obstacles.iter().map(|(name, _)| name.as_str()).collect();
    if known.is_empty() { error } else { Error::Input(format!("{error} (obstacles: {known:?})")) }
}

fn pair(
    model: &Model,
    contact: u32,
    secondary_body: u32,
    secondary: &Body,
    primary: Primary,
    primary_body: Option<u32>,
) -> Pair {
    let nodes = secondary.surface_nodes();
    let length = |s: &SurfaceNode| {
        let (a, b) = (model.points[s.node as usize], model.points[s.after as usize]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    let secondary_length = nodes.iter().map(length).sum::<f64>() / nodes.len() as f64;
    let young = primary_body.map_or(0.0, |b| model.bodies[b as usize].young).max(secondary.young);
    let node_stiffness = if primary_body.is_some() { HashMap::new() } else { node_stiffness(secondary) };
    let (secondary, order) = (nodes, model.order.clone());
    Pair { contact, secondary_body, primary_body, secondary, secondary_length, primary, young, node_stiffness, order }
}

/// Mean of the two edges that meet at each node.
fn node_stiffness(body: &Body) -> HashMap<u32, f64> {
    let mut edges = body.edge_stiffness.iter();
    let mut stiffness = HashMap::new();
    for ring in &body.loops {
        for (i, k) in edges.by_ref().take(ring.len()).enumerate() {
            *stiffness.entry(ring[i]).or_insert(0.0) += 0.5 * k;
            *stiffness.entry(ring[(i + 1) % ring.len()]).or_insert(0.0) += 0.5 * k;
        }
    }
    stiffness
}

fn rigid(name: &str, obstacle: &Obstacle) -> Result<Primary> {
    let object = format!("obstacle \"{name}\"");
    match obstacle {
        Obstacle::HalfPlane { point, normal } => {
            let length = normal[0].hypot(normal[1]);
            if !(length > 0.0 && length.is_finite() && point.iter().all(|x| x.is_finite())) {
                let value = format!("({}, {}) at ({}, {})", normal[0], normal[1], point[0], point[1]);
                return Err(Error::bound(&object, "normal", value, "finite and not zero", "point it at the bodies"));
            }
            Ok(Primary::HalfPlane { point: *point, normal: normal.map(|n| n / length) })
        }
        Obstacle::Polyline { points, closed } => {
            let least = if *closed { 3 } else { 2 };
            if points.len() < least {
                let bound = format!(">= {least}");
                return Err(Error::bound(&object, "number of points", points.len(), &bound, "add points"));
            }
            let after = |i: usize| points[(i + 1) % points.len()];
            let count = if *closed { points.len() } else { points.len() - 1 };
            let bad =
                |i: &usize| points[*i] == after(*i) || !points[*i].iter().chain(&after(*i)).all(|x| x.is_finite());
            if let Some(i) = (0..count).find(bad) {
                let value = format!("{:?} to {:?}", points[i], after(i));
                let bound = "between two distinct finite points";
                return Err(Error::bound(&object, &format!("segment {i}"), value, bound, "remove the repeated point"));
            }
            let ring: Vec<u32> = (0..points.len() as u32).collect();
            Ok(Primary::Surface(Surface::new(&[ring], *closed, &[], Vertices::Fixed(points.clone()))))
        }
    }
}
