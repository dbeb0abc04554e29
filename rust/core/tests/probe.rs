//! Probes give finite positive figures and refuse what they do not have.

mod common;

use bipenalty::model::Model;
use bipenalty::probe::{bandwidth, fma_rate, kernel};
use bipenalty::stiffness::Isa;
use common::blocks;

fn is_figure(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

#[test]
fn multiply_adds_come_at_a_finite_rate() {
    for isa in Isa::available() {
        assert!(is_figure(fma_rate(isa)), "{isa:?}");
    }
}

/// Least time of a set and of the baseline, taken in turn: what else runs on the machine slows both.
fn least(rounds: usize, isa: Isa, once: impl Fn(Isa) -> f64) -> [f64; 2] {
    (0..rounds).fold([f64::INFINITY; 2], |[wide, plain], _| [wide.min(once(isa)), plain.min(once(Isa::Baseline))])
}

/// A loop that is not compiled for its set makes library calls, tenfold slower than the baseline.
#[test]
fn wide_instruction_sets_are_no_slower() {
    let model = Model::new(blocks(true, 1)).unwrap();
    for isa in Isa::available() {
        let [wide, plain] = least(5, isa, |isa| 1.0 / fma_rate(isa));
        assert!(0.7 * wide < plain, "{isa:?}");
        for lanes in [1, 8, 16] {
            let once = |isa| kernel(&model, lanes, isa, 100, 0..model.points.len()).unwrap();
            let [wide, plain] = least(40, isa, once);
            assert!(0.7 * wide < plain, "{isa:?}, {lanes} lanes");
        }
    }
}

#[test]
fn bandwidth_of_a_small_and_a_larger_set() {
    for bytes in [1 << 14, 1 << 20] {
        let found = bandwidth(bytes).unwrap();
        assert!(is_figure(found.read) && is_figure(found.triad), "{found:?}");
    }
    assert!(bandwidth(100).unwrap_err().to_string().contains("working set = 100"));
}

#[test]
fn kernel_runs_with_its_lanes_and_no_others() {
    let model = Model::new(blocks(true, 1)).unwrap();
    let n = model.points.len();
    for isa in Isa::available() {
        for lanes in [1, 8, 16] {
            assert!(is_figure(kernel(&model, lanes, isa, 3, 0..n).unwrap()));
            assert!(is_figure(kernel(&model, lanes, isa, 3, n / 2..n).unwrap()));
        }
    }
    let refused = |lanes, steps, range| kernel(&model, lanes, Isa::Baseline, steps, range).unwrap_err().to_string();
    assert!(refused(4, 3, 0..n).contains("lanes = 4, must be 1, 8 or 16"));
    assert!(refused(8, 0, 0..n).contains("number of steps = 0"));
    assert!(refused(8, 3, 0..n + 1).contains("range of nodes"));
    assert!(refused(8, 3, n..n).contains("range of nodes"));
}
