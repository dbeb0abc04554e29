"""Methods to compare with: multipliers and the predictor-corrector, against exact forces and against each other.

- energy: what contact adds and what is left at the end;
- forces: of the thrown bar (Doyen, Ern and Piperno 2011) against rho c v, of the colliding cylinders against the
  impulse of a converged run;
- lanes: a run in a group of unlike methods is the run alone, to the last bit.
"""

import math
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import bipenalty as bp
import scenes
from bipenalty import _core
from bipenalty.exact import ThrownBar
from bipenalty.force_error import closures, force_error, impulse_of
from bipenalty.lower import lower
from bipenalty.methods.method import Method

LAGRANGE: list[Method] = [bp.CDLagrange(), bp.ForwardIncrementLagrange()]
#: What keeps within the limit of two passes too.
CALM = bp.PredictorCorrector(s2=0.375)
ALL: list[Method] = [*LAGRANGE, bp.PredictorCorrector(), CALM]

each = pytest.mark.parametrize("method", ALL, ids=lambda m: f"{m.label} {getattr(m, 's2', '')}".strip())
each_lagrange = pytest.mark.parametrize("method", LAGRANGE, ids=lambda m: m.label)
each_pass = pytest.mark.parametrize("passes", [1, 2])


@cache
def cylinders(method: Method, passes: int, fraction: int = 1, dt: str = "element") -> Any:
    """A run of the colliding cylinders at a fraction of half the element bound, or at 0.98 of the assembled limit."""
    safety = 0.5 / fraction if dt == "element" else None
    return bp.Model(scenes.cylinders(passes), method, dt, safety).run(0.18, show_progress=False)


@each
@pytest.mark.parametrize("courant", [0.5, 0.9])
def test_thrown_bar(method: Method, courant: float) -> None:
    """Force over ten transits of an element within 4 %, impulse 200 within 0.5 %, one closure, no vibration left."""
    known, elements = ThrownBar(), 200
    transit = known.bar.length / elements / known.bar.c
    result = bp.Model(known.scene(elements), method, dt=courant * transit).run(known.t_end, show_progress=False)
    force = result.contact_force.values
    assert result.outcome == "finished"
    assert force_error(force, result.dt, known.impulse_until, 10 * transit) < 0.04
    assert result.impulse == pytest.approx(known.impulse, rel=0.005)
    assert closures(force) == 1
    assert abs(result.energy_ratio - 1) < 0.01


@each
@each_pass
def test_cylinders_have_the_impulse_of_a_converged_run(method: Method, passes: int) -> None:
    converged = cylinders(bp.Bipenalty(), 1, 16).impulse
    assert cylinders(method, passes).impulse == pytest.approx(converged, rel=1e-3)


@each_pass
@pytest.mark.parametrize("dt", ["element", "assembled"])
def test_cd_lagrange_makes_no_energy(passes: int, dt: str) -> None:
    """Contact never adds any; what the nodes that stop give up is 0.5 % at most."""
    result = cylinders(bp.CDLagrange(), passes, dt=dt)
    assert result.energy_made < 1e-9
    assert 0.995 < result.energy_ratio <= 1.0


@each_pass
@pytest.mark.parametrize(("dt", "made"), [("element", 1e-9), ("assembled", 1e-3)])
def test_forward_increment_makes_next_to_none(passes: int, dt: str, made: float) -> None:
    """None at half the element bound; at 0.98 of the assembled limit 0.02 %, by pushing nodes back to the surface."""
    result = cylinders(bp.ForwardIncrementLagrange(), passes, dt=dt)
    assert result.energy_made < made
    assert abs(result.energy_ratio - 1) < 1e-3


@each_lagrange
@each_pass
def test_forces_push_only(method: Method, passes: int) -> None:
    model = bp.Model(scenes.small_cylinders(passes=passes), method)
    pushed = 0
    while model.time < 0.15:
        model.step(1)
        assert all(force >= 0 for _, force in model._run.rows)
        pushed += len(model._run.rows)
    assert pushed > 100


@each
def test_force_after_an_average_is_that_of_a_converged_run(method: Method) -> None:
    reference = cylinders(bp.Bipenalty(), 1, 16)
    run = cylinders(method, 1)
    error = force_error(
        run.contact_force.values, run.dt, impulse_of(reference.contact_force.values, reference.dt), 5e-4
    )
    assert error < 0.04


@pytest.mark.parametrize(("passes", "dt"), [(2, "element"), (1, "assembled")])
def test_predictor_corrector_chatters_beyond_its_limit(passes: int, dt: str) -> None:
    """At s2 = 1 two passes correct a gap more than twice over, and one pass up to 4/3 of it: peaks, energy made."""
    within, beyond = (cylinders(method, passes, dt=dt) for method in (CALM, bp.PredictorCorrector()))
    assert beyond.peak_force > 1.5 * within.peak_force
    assert beyond.energy_made > 1e-3 > within.energy_made


@pytest.mark.parametrize("ps", [1e2, 1e4, 1e6, 1e8])
def test_predictor_corrector_bears_any_stiffness(ps: float) -> None:
    """With one pass nothing is made and the predicted gap all but gone, however stiff."""
    result = cylinders(bp.PredictorCorrector(ps), 1)
    assert result.outcome == "finished"
    assert result.energy_made < 1e-3
    assert result.max_penetration < 0.2 * math.sqrt(2) * result.dt


@each
def test_a_lane_is_the_run_alone(method: Method) -> None:
    """To the last bit, among fifteen others of every kind that begin and end at other times."""
    core, scene = lower(scenes.small_cylinders(passes=2)), scenes.small_cylinders(passes=2)
    dt, steps = 0.5 * core.critical_dt, 400
    others = [bp.Stiffness(1.0), bp.Bipenalty(), bp.Bipenalty(1.0, rule="published"), *ALL]
    methods: list[Method] = [others[i % len(others)] for i in range(15)]
    methods.insert(6, method)
    none = {"velocity": None, "offset": None, "young": None, "density": None}
    runs = [SimpleNamespace(method=m, dt=dt, steps=steps - 7 * (i != 6) * i, **none) for i, m in enumerate(methods)]
    batch = _core.Batch(core, runs, scene.velocity, scene.displacement, lanes=16, every=1, energy_every=5)
    while batch.finished < len(batch):
        batch.advance(1, 0.5)
    alone = _core.Batch(core, runs[6:7], scene.velocity, scene.displacement, lanes=1, every=1, energy_every=5)
    while alone.finished < 1:
        alone.advance(1, 0.5)
    run = _core.Run(core, method, dt, False, scene.velocity, scene.displacement, "auto", None)
    run.configure(1, 5, [], math.inf, steps)
    run.advance(steps, True)
    ours = batch.observations(6)
    for theirs in (alone.observations(0), run.observations()):
        assert ours is not None
        assert theirs is not None
        assert ours["row_steps"] > 100
        for name, value in ours.items():
            if name not in ("seconds", "planned_steps"):
                np.testing.assert_array_equal(value, theirs[name], err_msg=name)


@each
def test_attributes_and_counts(method: Method) -> None:
    result = cylinders(method, 2)
    assert result.row_steps == int(result.active_rows.sum())
    assert result.method == method.label
    if isinstance(method, bp.PredictorCorrector):
        assert (result.ps, result.block_operations) == (method.ps, 0)
        assert math.isclose(result.R, method.s2 / result.dt**2)
    else:
        assert math.isnan(result.ps)
        assert (result.R, result.D, result.zeta) == (math.inf, 0.0, 0.0)
        assert result.block_operations > result.row_steps


@each
def test_rows_cost_no_time_step(method: Method) -> None:
    model = bp.Model(scenes.small_cylinders(), method)
    while not model._run.rows:
        model.step(10)
    limits = model.critical_step()
    assert limits.governs == "mesh"
    assert limits.rows == limits.assembled


@pytest.mark.parametrize("kind", [bp.CDLagrange, bp.ForwardIncrementLagrange])
@pytest.mark.parametrize("tolerance", [0.0, -1e-10, 0.01, math.nan, math.inf])
def test_tolerance_out_of_bounds(kind: Any, tolerance: float) -> None:
    with pytest.raises(bp.InputError, match=rf"{kind.__name__}: tolerance = .*must be in \[1e-13, 1e-3\]"):
        kind(tolerance)


@pytest.mark.parametrize("s2", [0.0, -1.0, 1.1, math.nan])
def test_s2_out_of_bounds(s2: float) -> None:
    with pytest.raises(bp.InputError, match="PredictorCorrector: s2 = "):
        bp.PredictorCorrector(1.0, s2)


def test_ps_out_of_bounds() -> None:
    with pytest.raises(bp.InputError, match="PredictorCorrector: ps = -1, must be >= 0"):
        bp.PredictorCorrector(-1.0)
    with pytest.raises(bp.InputError, match="PredictorCorrector: ps = 'auto', must be a number"):
        bp.PredictorCorrector("auto")
