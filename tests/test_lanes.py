"""Runs side by side: in a sweep, on threads and on any instruction set a run is what it is alone, to the last bit."""

import numpy as np
import pytest

import bipenalty as bp
import scenes
from bipenalty import _core

METHODS = [
    bp.Bipenalty(),
    bp.Stiffness(1.0),
    bp.Bipenalty(3.0, rule="published"),
    bp.Stiffness(300.0),
    bp.Stiffness(1.0, D=1e-4),
    bp.ElementStiffness(),
]


def test_a_run_of_a_sweep_is_the_model_run_alone() -> None:
    """Forces and penetrations of every step, and the peaks, of runs that share their passes with others."""
    scene = scenes.small_cylinders()
    many = METHODS * 7  # 42 runs: lanes are filled more than once, and some end early
    data = bp.sweep(scene, many, 0.1, histories=True)
    for i, method in enumerate(many):
        alone = bp.Model(scene, method).run(0.1)
        entry = data.isel(run=i)
        assert entry.outcome.item() == alone.outcome
        for name in ("contact_force", "penetration"):
            there = entry[name].values[: alone.steps]
            np.testing.assert_array_equal(there, alone.dataset[name].values)
            assert np.isnan(entry[name].values[alone.steps :]).all()
        for name in ("max_penetration", "peak_force", "impulse", "steps"):
            assert entry[name].item() == getattr(alone, name)


@pytest.mark.parametrize("isa", _core.instruction_sets())
def test_an_instruction_set_can_be_asked_for(isa: str) -> None:
    """Sets agree to round-off, and each repeats itself to the last bit."""
    scene = scenes.small_cylinders()
    first, again = (bp.Model(scene, bp.Bipenalty(), isa=isa).run(0.05) for _ in range(2))
    np.testing.assert_array_equal(first.contact_force, again.contact_force)
    swept = bp.sweep(scene, [bp.Bipenalty()] * 3, 0.05, isa=isa)
    assert (swept.impulse == first.impulse).all()
    usual = bp.Model(scene, bp.Bipenalty()).run(0.05)
    assert first.impulse == pytest.approx(usual.impulse, rel=1e-9)


def test_an_instruction_set_that_is_not_there() -> None:
    """The message names those that are."""
    with pytest.raises(bp.InputError, match=r"'sse9'.*baseline"):
        bp.sweep(scenes.small_cylinders(), [bp.Bipenalty()], 0.1, isa="sse9")
    with pytest.raises(bp.InputError, match=r'"sse9".*baseline'):
        bp.Model(scenes.small_cylinders(), isa="sse9")


def test_threads_leave_no_trace() -> None:
    """One model whose steps are shared by threads: the same to the last bit."""
    scene = scenes.small_cylinders()
    one, two = (bp.Model(scene, threads=n).run(0.1) for n in (1, 2))
    np.testing.assert_array_equal(one.contact_force, two.contact_force)
    assert one.kinetic_energy.equals(two.kinetic_energy)
    with pytest.raises(bp.InputError, match=r"threads = 0"):
        bp.Model(scene, threads=0)
