//! How a run ended, and the sentence that says why.

use crate::critical_step::rows;
use crate::enforcement::Enforcement;
use crate::error::short;
use crate::model::Model;
use crate::watch::{TOLERANCE, Watch};

/// What ended a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A frequency of elements or rows above 2/dt.
    SpectralInstability,
    /// Rows that open and close have added energy though every frequency is below 2/dt.
    EnergyMade,
    /// A displacement passed the limit given.
    DisplacementLimit,
    /// An element has no area left.
    ElementInverted,
    /// A surface moved farther in one step than contact can follow.
    ContactMissed,
    /// The state is not finite.
    NotFinite,
    /// It could not begin: something is out of its bounds.
    Refused,
}

impl Kind {
    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::SpectralInstability => "spectral instability",
            Self::EnergyMade => "energy made by contact",
            Self::DisplacementLimit => "displacement limit passed",
            Self::ElementInverted => "element inverted",
            Self::ContactMissed => "contact missed",
            Self::NotFinite => "not finite",
            Self::Refused => "refused",
        }
    }
}

/// How a run stands or has ended; the text says which limit was passed, by how much, and what to change.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Not over, or over without failure.
    Running,
    /// Ended, or spoilt, by this.
    Failed(Kind, String),
}

impl Outcome {
    /// Short name for tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Failed(kind, _) => kind.name(),
        }
    }

    /// The sentence that says why; empty while nothing has failed.
    pub fn reason(&self) -> &str {
        match self {
            Self::Running => "",
            Self::Failed(_, reason) => reason,
        }
    }
}

/// What a failure is judged by.
pub(crate) struct Judge<'a> {
    pub model: &'a Model,
    pub watch: &'a Watch,
    /// Time (s) and time step (s).
    pub time: f64,
    pub dt: f64,
    /// Penalty ratio R (1/s^2); infinite without a mass penalty in the equation of motion.
    pub ratio: f64,
    /// How rows get their forces.
    pub enforcement: Enforcement,
}

impl Judge<'_> {
    /// The outcome of a run in which `seen` was noticed as a `kind`: a deeper cause takes its place if there is one.
    pub(crate) fn outcome(&self, kind: Kind, seen: &str) -> Outcome {
        let (mesh, ratio) = (self.mesh(), self.ratio.sqrt() * self.dt);
        let time = format!("t = {} s", short(self.time));
        let gained = self.watch.passed(TOLERANCE);
        let rows = self.rows(gained);
        let (kind, why) = if mesh > 2.0 {
            let stiffest = self.model.bodies.iter().max_by(|a, b| a.element_omega.total_cmp(&b.element_omega));
            let (name, omega) = (stiffest.map_or("", |b| &b.name), short(mesh));
            let why = format!("omega dt = {omega} of the mesh (stiffest elements in \"{name}\") is above 2; reduce dt");
            (Kind::SpectralInstability, why)
        } else if ratio.is_finite() && ratio > 2.0 && gained {
            let omega = short(ratio);
            (Kind::SpectralInstability, format!("omega dt = {omega} of the penalty ratio, above 2; lower R to 4/dt^2"))
        } else if rows > 2.0 {
            let why = format!("omega dt = {} with the contact row{}, above 2;", short(rows), self.place());
            (Kind::SpectralInstability, format!("{why} lower p_s, reduce dt or add a mass penalty"))
        } else if gained {
            let within = short(if ratio.is_finite() { mesh.max(ratio) } else { mesh.max(rows) });
            let made = format!("contact has added {} times the energy there was", short(self.watch.gain()));
            let why = format!("{made} though omega dt = {within} is within 2: rows that open and close make it;");
            (Kind::EnergyMade, format!("{why} {}", self.enforcement.remedy()))
        } else {
            return Outcome::Failed(kind, format!("{seen} at {time}"));
        };
        let seen = if seen.is_empty() { format!("by {time}") } else { format!("{seen} at {time}") };
        Outcome::Failed(kind, format!("{seen}: {why}"))
    }

    /// omega dt of the mesh: the element bound where that is within the limit, the assembled matrix where it is not.
    fn mesh(&self) -> f64 {
        let elements = self.model.element_omega() * self.dt;
        if elements <= 2.0 { elements } else { self.model.assembled_omega2().found.sqrt() * self.dt }
    }

    /// omega dt of the active rows where nothing keeps it down, else 0: a single row's own, or, where that is
    /// within 2 and energy has been made, that of the mesh with the stiffest set of rows there has been.
    fn rows(&self, gained: bool) -> f64 {
        let row = self.watch.row_omega2.sqrt() * self.dt;
        if self.ratio.is_finite() || self.enforcement != Enforcement::Penalty {
            0.0
        } else if row <= 2.0 && gained {
            rows::largest_omega2(self.model, &self.watch.stiffest).found.sqrt() * self.dt
        } else {
            row
        }
    }

    /// True when a limit is passed for certain, whether or not anything has come of it.
    pub(crate) fn past_a_limit(&self) -> bool {
        self.rows(false) > 2.0 || (self.watch.swollen() && self.mesh() > 2.0)
    }

    /// Where the stiffest rows are.
    fn place(&self) -> String {
        let Some(node) = self.watch.stiffest.first().map(|row| row.first_node() as usize) else { return String::new() };
        let body = self.model.bodies.iter().find(|b| b.nodes.contains(&node));
        let number = self.model.order.outer(node);
        body.map_or(String::new(), |b| format!(" at node {} of \"{}\"", number - b.nodes.start, b.name))
    }
}
