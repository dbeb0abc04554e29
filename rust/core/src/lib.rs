//! Two-dimensional explicit finite-element contact dynamics with the bipenalty method.
//!
//! A [`scene::Scene`] is lowered to a [`model::Model`]; a [`group::Group`] of runs advances a [`state::State`] over it with
//! [`step::step`], and each [`run::Run`] collects a [`history::History`].

pub mod batch;
pub mod body;
pub mod boundary;
pub mod constraint;
pub mod contact;
pub mod crew;
pub mod critical_step;
pub mod due;
pub mod element;
pub mod ended;
pub mod energy;
pub mod enforcement;
pub mod error;
pub mod group;
pub mod history;
pub mod lane;
mod lower;
pub mod mass_block;
pub mod material;
pub mod mesh;
pub mod model;
pub mod nodal_sums;
pub mod order;
pub mod outcome;
mod pace;
pub mod penalty;
pub mod probe;
pub mod row;
pub mod run;
pub mod run_spec;
pub mod scene;
mod shape;
pub mod start;
pub mod state;
pub mod step;
pub mod stiffness;
pub mod variant;
pub mod watch;
