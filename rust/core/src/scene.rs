//! What a caller describes: bodies, obstacles, contacts and supports by name.

use crate::constraint::linear::Linear;
use crate::constraint::support::Support;
use crate::material::Material;
use crate::mesh::Mesh;

/// One deformable body.
#[derive(Debug, Clone)]
pub struct BodySpec {
    /// Name that contacts, supports and messages use.
    pub name: String,
    /// Its mesh, checked when the model is built.
    pub mesh: Mesh,
    /// Its material.
    pub material: Material,
    /// Thickness (m).
    pub thickness: f64,
    /// Body force (N/m^3).
    pub body_force: [f64; 2],
}

/// A rigid obstacle without degrees of freedom.
#[derive(Debug, Clone)]
pub enum Obstacle {
    /// The bodies stay where (x - point) . normal >= 0.
    HalfPlane {
        /// A point of its line (m).
        point: [f64; 2],
        /// Normal out of the obstacle; any length.
        normal: [f64; 2],
    },
    /// Chain of segments with the obstacle on the left of travel.
    Polyline {
        /// Its vertices (m).
        points: Vec<[f64; 2]>,
        /// Whether the last vertex joins the first.
        closed: bool,
    },
}

/// Contact between a secondary body and a primary body or obstacle.
#[derive(Debug, Clone)]
pub struct ContactSpec {
    /// Body whose nodes must not enter the primary.
    pub secondary: String,
    /// Body or obstacle whose segments they meet.
    pub primary: String,
    /// 1, or 2 for the other way round as well.
    pub passes: u32,
    /// Overlap allowed at the start (m); `contact::overlap::TOLERANCE` mean segment lengths unless given.
    pub overlap_tolerance: Option<f64>,
}

/// Everything a model is built from.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// Bodies; their nodes are numbered in this order.
    pub bodies: Vec<BodySpec>,
    /// Obstacles with their names.
    pub obstacles: Vec<(String, Obstacle)>,
    /// Contacts.
    pub contacts: Vec<ContactSpec>,
    /// Supports.
    pub supports: Vec<Support>,
    /// Rows that are always active.
    pub linear: Vec<Linear>,
}
