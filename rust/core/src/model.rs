//! The model: a scene lowered to arrays that never change.

use std::sync::{Arc, OnceLock};

pub use crate::body::Body;
use crate::boundary::{boundary_loops, edge_stiffness};
use crate::constraint::linear::Linear;
use crate::contact::surface::Vertices;
use crate::contact::{Pair, Surface};
use crate::critical_step::assembled::largest_omega2;
use crate::critical_step::lanczos::Largest;
use crate::error::{Error, Result};
use crate::lane::Lane;
use crate::lower;
use crate::order::Order;
use crate::scene::{BodySpec, Scene};
use crate::stiffness::BlockCsr;
use crate::stiffness::assembly::assemble;

/// One contact of the scene, for reports.
#[derive(Debug, Clone)]
pub struct Contact {
    /// First-named body and its partner.
    pub names: [String; 2],
    /// First-named body.
    pub body: u32,
    /// Overlap allowed at the start (m).
    pub overlap_tolerance: f64,
}

/// K, M, surfaces and rows: shared by all runs, changed by none.
#[derive(Debug, Clone)]
pub struct Model {
    /// The scene's node numbers; all else here has the model's own.
    pub order: Order,
    /// Reference coordinates X (m).
    pub points: Vec<[f64; 2]>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Stiffness K (N/m) of all bodies, before each body's own factor; variants share it.
    pub stiffness: Arc<BlockCsr>,
    /// Lumped mass (kg) of each node.
    pub mass: Vec<f64>,
    /// Inverse mass (1/kg) by node and axis; 0 where a support holds it.
    pub inverse_mass: Vec<[f64; 2]>,
    /// Nodes that a support holds in x, y or both.
    pub held: Vec<u32>,
    /// Nodal load f (N) of the body forces, if the scene has any.
    pub load: Option<Vec<[f64; 2]>>,
    /// Contacts by name.
    pub contacts: Vec<Contact>,
    /// Contact pairs, one a pass.
    pub pairs: Vec<Pair>,
    /// Rows that are always active.
    pub linear: Vec<Linear>,
    /// Largest omega^2 of each body's assembled matrix before its own factors, once it has been asked for.
    assembled: Arc<OnceLock<Vec<Largest>>>,
}

impl Model {
    /// Builds the model.
    ///
    /// # Errors
    /// Anything in the scene that is out of its bounds; see the messages.
    pub fn new(scene: Scene) -> Result<Self> {
        let mut model = Self {
            order: Order::default(),
            points: Vec::new(),
            bodies: Vec::new(),
            stiffness: Arc::default(),
            mass: Vec::new(),
            inverse_mass: Vec::new(),
            held: Vec::new(),
            load: None,
            contacts: Vec::new(),
            pairs: Vec::new(),
            linear: scene.linear,
            assembled: Arc::default(),
        };
        if scene.bodies.is_empty() {
            return Err(Error::bound("scene", "number of bodies", 0, ">= 1", "add a body"));
        }
        let mut stiffness = BlockCsr::default();
        for body in scene.bodies {
            model.add_body(body, &mut stiffness)?;
        }
        model.stiffness = Arc::new(stiffness);
        for (node, _) in model.linear.iter_mut().flat_map(|row| &mut row.entries) {
            *node = model.order.inner(*node as usize) as u32;
        }
        for support in &scene.supports {
            let object = format!("support of \"{}\"", support.body);
            let nodes = lower::find_body(&model.bodies, &support.body, &object)?.1.nodes.clone();
            support.apply(nodes, &model.order, &mut model.inverse_mass)?;
        }
        let holds = |w: &[f64; 2]| w.contains(&0.0);
        model.held = (0..).zip(&model.inverse_mass).filter(|(_, w)| holds(w)).map(|(node, _)| node).collect();
        for contact in &scene.contacts {
            lower::add_contact(&mut model, contact, &scene.obstacles)?;
        }
        Ok(model)
    }

    fn add_body(&mut self, body: BodySpec, stiffness: &mut BlockCsr) -> Result<()> {
        let object = format!("body \"{}\"", body.name);
        if self.bodies.iter().any(|b| b.name == body.name) {
            let name = format!("\"{}\"", body.name);
            return Err(Error::bound("scene", "body name", name, "used once", "rename one of the bodies"));
        }
        body.material.check(&object)?;
        if !(body.thickness > 0.0 && body.thickness.is_finite()) {
            let remedy = "give it in m; 1 for a plane problem per metre of depth";
            return Err(Error::bound(&object, "thickness", body.thickness, "> 0 and finite", remedy));
        }
        let in_body = |e: Error| Error::Input(format!("{object}: {e}"));
        let (mut mesh, _) = body.mesh.checked().map_err(in_body)?;
        let mut loops = boundary_loops(&mesh).map_err(in_body)?;
        let first = self.points.len();
        self.order.add(first, &mut mesh, &mut loops);
        let parts = assemble(&mesh, &body.material, body.thickness);
        let edge_stiffness = edge_stiffness(&mesh, &loops, &body.material, body.thickness);

        let nodes = first..first + mesh.points.len();
        stiffness.append(parts.stiffness);
        self.inverse_mass.extend(parts.mass.iter().map(|m| [1.0 / m; 2]));
        if body.body_force != [0.0; 2] || self.load.is_some() {
            // Row-sum lumping shares the body force out as it does the mass.
            let share = |m: &f64| body.body_force.map(|b| b * m / body.material.density);
            let load = self.load.get_or_insert_default();
            load.resize(first, [0.0; 2]);
            load.extend(parts.mass.iter().map(share));
        }
        self.mass.extend(parts.mass);
        self.points.extend(mesh.points);
        let loops = loops.into_iter().map(|ring| ring.into_iter().map(|n| (n + first) as u32).collect()).collect();
        let global = |n: usize| (n + first) as u32;
        self.bodies.push(Body {
            name: body.name,
            nodes,
            young: body.material.young,
            triangles: mesh.triangles.iter().map(|t| t.map(global)).collect(),
            quads: mesh.quads.iter().map(|q| q.map(global)).collect(),
            loops,
            edge_stiffness,
            element_omega: parts.element_omega,
            young_factor: 1.0,
            density_factor: 1.0,
        });
        Ok(())
    }

    /// Largest omega^2 (1/s^2) of the assembled matrix; found at the first call and kept for the model and its variants.
    pub fn assembled_omega2(&self) -> Largest {
        let of_bodies = self.assembled.get_or_init(|| self.bodies.iter().map(|b| largest_omega2(self, b)).collect());
        let mut most = Largest { found: 0.0, upper: 0.0, products: 0 };
        for (body, known) in self.bodies.iter().zip(of_bodies) {
            let factor = body.young_factor / body.density_factor;
            most.found = most.found.max(factor * known.found);
            most.upper = most.upper.max(factor * known.upper);
            most.products += known.products;
        }
        most
    }

    /// Largest element eigenfrequency of all bodies (rad/s).
    pub fn element_omega(&self) -> f64 {
        self.bodies.iter().map(|b| b.element_omega).fold(0.0, f64::max)
    }

    /// Boundary of a body as a surface.
    pub fn surface(&self, body: u32) -> Surface {
        let body = &self.bodies[body as usize];
        let vertices: Vec<u32> = body.loops.iter().flatten().copied().collect();
        let mut number = 0..;
        let rings: Vec<Vec<u32>> = body.loops.iter().map(|ring| number.by_ref().take(ring.len()).collect()).collect();
        let mut surface = Surface::new(&rings, true, &self.points, Vertices::Nodes(vertices));
        surface.element_stiffness.clone_from(&body.edge_stiffness);
        surface
    }

    /// The components of a nodal vector along free degrees of freedom.
    #[inline]
    pub fn free(&self, node: u32, vector: [f64; 2]) -> [f64; 2] {
        let w = self.inverse_mass[node as usize];
        [if w[0] > 0.0 { vector[0] } else { 0.0 }, if w[1] > 0.0 { vector[1] } else { 0.0 }]
    }

    /// u'K u over the held degrees of freedom of a node (J).
    pub fn held_work(&self, node: u32, displacement: Lane) -> f64 {
        let x = displacement.at(node);
        let free = self.free(node, x);
        let held = [x[0] - free[0], x[1] - free[1]];
        if held == [0.0; 2] {
            return 0.0;
        }
        let (load, force) = (
            self.load.as_ref().map_or([0.0; 2], |f| f[node as usize]),
            self.nodal_force(self.body_of(node), node, displacement),
        );
        held[0] * (load[0] - force[0]) + held[1] * (load[1] - force[1])
    }

    /// Nodal force f - K u (N) of one node of a body.
    pub fn nodal_force(&self, body: &Body, node: u32, displacement: Lane) -> [f64; 2] {
        let mut ku = [0.0; 2];
        for (column, k) in self.stiffness.row(node as usize) {
            let force = k.times(displacement.at(column as u32));
            ku = [ku[0] + force[0], ku[1] + force[1]];
        }
        let f = self.load.as_ref().map_or([0.0; 2], |load| load[node as usize]);
        [f[0] - body.young_factor * ku[0], f[1] - body.young_factor * ku[1]]
    }

    /// The body a node belongs to.
    pub fn body_of(&self, node: u32) -> &Body {
        &self.bodies[self.bodies.partition_point(|b| b.nodes.end <= node as usize)]
    }
}
