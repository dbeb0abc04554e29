//! Two-dimensional explicit finite-element contact dynamics with the bipenalty method.
//!
//! A [`scene::Scene`] is lowered to a [`model::Model`]; a [`run::Run`] advances a [`state::State`] over it with
//! [`step::step`] and collects a [`history::History`].

pub mod batch;
pub mod body;
pub mod boundary;
pub mod constraint;
pub mod contact;
pub mod critical_step;
pub mod element;
pub mod energy;
pub mod error;
pub mod history;
pub mod lane;
mod lower;
pub mod mass_block;
pub mod material;
pub mod mesh;
pub mod model;
pub mod outcome;
pub mod penalty;
pub mod probe;
pub mod row;
pub mod run;
pub mod run_spec;
pub mod scene;
pub mod state;
pub mod step;
pub mod stiffness;
pub mod watch;
