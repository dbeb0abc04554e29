//! One step: the algorithm box.

use crate::contact::search::Search;
use crate::error::Result;
use crate::lane::{Lane, add_to};
use crate::mass_block::{MassBlock, RowForces};
use crate::model::Model;
use crate::penalty::{Known, Method};
use crate::row::Row;
use crate::state::State;
use crate::stiffness::Isa;
use crate::stiffness::kernel::{Pass, advance};

/// What a run needs besides the model: time step, penalty method, instruction set.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Time step (s).
    pub dt: f64,
    /// Penalty method.
    pub method: Method,
    /// Instruction set of the kernel.
    pub isa: Isa,
}

/// Buffers of the step; they grow with the active set and are never given back.
pub struct Workspace {
    /// Candidate pairs of the broad phase.
    pub search: Search,
    /// Active rows.
    pub rows: Vec<Row>,
    /// Row forces.
    pub forces: RowForces,
    /// Mass block.
    pub block: MassBlock,
}

impl Workspace {
    /// Empty buffers for a model.
    pub fn new(model: &Model) -> Self {
        let (search, block) = (Search::new(&model.pairs), MassBlock::default());
        Self { search, rows: Vec::new(), forces: RowForces::default(), block }
    }
}

/// Central differences with bipenalty rows (THEORY: section 2), from u_n, v_{n-1/2} to u_{n+1}, v_{n+1/2}.
///
/// # Errors
/// A state that is no longer finite.
pub fn step(model: &Model, settings: &Settings, state: &mut State, work: &mut Workspace) -> Result<()> {
    row_forces(model, settings, state, work)?;
    apply_row_impulses(model, settings, state, work);
    advance_nodes(model, settings, state);
    Ok(())
}

/// Rows active at u_n and their forces: `[M + G'PG] a = f - K u - G'(A_s g + A_d G v)`.
pub fn row_forces(model: &Model, settings: &Settings, state: &State, work: &mut Workspace) -> Result<()> {
    let u = Lane::new(&state.displacement, state.lanes, 0);
    let v = Lane::new(&state.velocity, state.lanes, 0);
    work.search.keep(&model.pairs, &model.points, u)?;
    work.rows.clear();
    for (i, linear) in model.linear.iter().enumerate() {
        work.rows.push(linear.row((model.contacts.len() + i) as u32, u));
    }
    for (pair, candidates) in model.pairs.iter().zip(&work.search.candidates) {
        pair.rows(candidates, &model.points, u, &mut work.rows);
    }
    for row in &mut work.rows {
        let known = Known { row, inverse_mass: &model.inverse_mass, dt: settings.dt };
        row.penalties = settings.method.penalties(known);
    }
    work.block.forces(model, &work.rows, settings.dt, u, v, &mut work.forces)
}

/// `v += dt M^-1 G' lambda`.
pub fn apply_row_impulses(model: &Model, settings: &Settings, state: &mut State, work: &Workspace) {
    for (row, lambda) in work.rows.iter().zip(&work.forces.lambda) {
        for (node, g) in row.entries() {
            let w = model.inverse_mass[node as usize];
            let impulse = settings.dt * lambda;
            add_to(&mut state.velocity, state.lanes, 0, node, [impulse * g[0] * w[0], impulse * g[1] * w[1]]);
        }
    }
}

/// `v += dt M^-1 (f - K u)`, `u += dt v`.
pub fn advance_nodes(model: &Model, settings: &Settings, state: &mut State) {
    let pass = Pass::<1> {
        stiffness: &model.stiffness,
        inverse_mass: &model.inverse_mass,
        load: model.load.as_deref(),
        displacement: state.displacement.as_chunks().0,
        dt: [settings.dt],
        elastic_dt: [settings.dt],
        load_dt: [settings.dt],
    };
    let (velocity, next) = (state.velocity.as_chunks_mut().0, state.other.as_chunks_mut().0);
    advance(settings.isa, &pass, 0..model.points.len(), velocity, next);
    std::mem::swap(&mut state.displacement, &mut state.other);
    state.steps += 1;
}
