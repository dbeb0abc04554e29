//! Small scenes for the tests.
#![allow(dead_code)]

use std::sync::Arc;

use bipenalty::enforcement::Enforcement;
use bipenalty::group::Group;
use bipenalty::material::{Material, Plane};
use bipenalty::mesh::Mesh;
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass, Method, Stiffness};
use bipenalty::row::Row;
use bipenalty::run::RunSpec;
use bipenalty::scene::{BodySpec, ContactSpec, Obstacle, Scene};
use bipenalty::start::Start;
use bipenalty::stiffness::Isa;

/// Rectangle of nx by ny cells from `origin`, inner nodes displaced by `shake` of a cell, quads or triangles.
pub fn rectangle(origin: [f64; 2], size: [f64; 2], cells: [usize; 2], shake: f64, quads: bool) -> Mesh {
    let ([nx, ny], mut mesh) = (cells, Mesh::default());
    let cell = [size[0] / nx as f64, size[1] / ny as f64];
    for j in 0..=ny {
        for i in 0..=nx {
            let inner = i > 0 && i < nx && j > 0 && j < ny;
            let wobble = |k: f64| if inner { shake * (k * (1.0 + (i + 7 * j) as f64)).sin() } else { 0.0 };
            let at = [i as f64 + wobble(12.9898), j as f64 + wobble(78.233)];
            mesh.points.push([origin[0] + cell[0] * at[0], origin[1] + cell[1] * at[1]]);
        }
    }
    for j in 0..ny {
        for i in 0..nx {
            let a = j * (nx + 1) + i;
            let [b, c, d] = [a + 1, a + nx + 2, a + nx + 1];
            if quads {
                mesh.quads.push([a, b, c, d]);
            } else {
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    mesh
}

pub fn steel() -> Material {
    Material { young: 100.0, poisson: 0.2, density: 0.1, plane: Plane::Strain }
}

pub fn body(name: &str, mesh: Mesh, material: Material) -> BodySpec {
    BodySpec { name: name.into(), mesh, material, thickness: 1.0, body_force: [0.0; 2] }
}

pub fn contact(secondary: &str, primary: &str, passes: u32) -> ContactSpec {
    ContactSpec { secondary: secondary.into(), primary: primary.into(), passes, overlap_tolerance: None }
}

/// Two blocks, the upper one finer, stiffer and a hair above the lower one.
pub fn blocks(quads: bool, passes: u32) -> Scene {
    let upper = rectangle([0.1, 1.001], [0.8, 0.5], [9, 5], 0.15, quads);
    let lower = rectangle([0.0, 0.0], [1.0, 1.0], [7, 6], 0.15, quads);
    let stiff = Material { young: 1000.0, ..steel() };
    Scene {
        bodies: vec![body("upper", upper, stiff), body("lower", lower, steel())],
        contacts: vec![contact("upper", "lower", passes)],
        ..Scene::default()
    }
}

pub fn wall() -> (String, Obstacle) {
    ("wall".into(), Obstacle::HalfPlane { point: [0.0; 2], normal: [1.0, 0.0] })
}

pub fn method(ps: f64, mass: Mass, damping: Damping) -> Method {
    let (stiffness, enforcement) = (Stiffness::Factor(ps), Enforcement::Penalty);
    Method { stiffness, kappa: f64::INFINITY, mass, damping, enforcement }
}

/// A method without penalties.
pub fn lagrange(enforcement: Enforcement) -> Method {
    Method { enforcement, ..method(0.0, Mass::None, Damping::None) }
}

pub fn cd_lagrange() -> Method {
    lagrange(Enforcement::VelocityLagrange { tolerance: 1e-10 })
}

pub fn forward_increment() -> Method {
    lagrange(Enforcement::ForwardIncrement { tolerance: 1e-10 })
}

/// Predictor-corrector bipenalty, alpha_m = alpha_s dt^2/s2.
pub fn predictor_corrector(ps: f64, s2: f64) -> Method {
    Method { enforcement: Enforcement::PredictorCorrector, ..method(ps, Mass::Critical(s2), Damping::None) }
}

pub fn bipenalty(ps: f64) -> Method {
    method(ps, Mass::RatioFromStep(0.9), Damping::None)
}

/// A start with one body moving.
pub fn moving(model: &Model, body: usize, velocity: [f64; 2]) -> Arc<Start> {
    let mut v = vec![0.0; 2 * model.points.len()];
    for node in model.bodies[body].nodes.clone() {
        v[2 * node..2 * node + 2].copy_from_slice(&velocity);
    }
    let displacement = vec![0.0; v.len()];
    Arc::new(Start::new(model, v, displacement).unwrap())
}

/// A run whose body `body` starts with a velocity, at `safety` times the element bound.
pub fn start(model: &Arc<Model>, method: Method, body: usize, velocity: [f64; 2], safety: f64) -> Group {
    let dt = safety * bipenalty::critical_step::element_bound(model);
    let spec = RunSpec::new(method, dt, moving(model, body, velocity));
    Group::alone(model.clone(), Isa::detect(), &spec).unwrap()
}

/// Rows of the run's last step.
pub fn rows(group: &Group) -> &[Row] {
    &group.lanes[0].rows
}
