"""Speed against accuracy: fronts, choices and rates on made-up data, references, and a small study of real runs."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bipenalty as bp
from bipenalty import force_error, plot, study
from bipenalty.study import errors
from bipenalty.study.case import CONVERGED
from bipenalty.study.converge import converge
from bipenalty.study.sampling import Sampler, centroids

DIMS = ("method", "parameter", "refinement", "dt")
METHODS = {
    "parameter-free": bp.Bipenalty(),
    "published": lambda ps: bp.Bipenalty(ps, rule="published"),
    "stiffness": bp.Stiffness,
}


def made_up(cost: Any, error: Any, outcome: Any = "finished") -> xr.Dataset:
    """A dataset of methods "a", "b", ... with runs that differ in mesh only: (method, refinement) of cost and error."""
    spent, wrong = np.asarray(cost, dtype=float), np.asarray(error, dtype=float)
    shape = (spent.shape[0], 1, spent.shape[1], 1)
    ended = np.broadcast_to(np.asarray(outcome, dtype=object), spent.shape).reshape(shape)
    meshes = 10 * 2 ** np.arange(spent.shape[1])
    data = {
        "seconds": (DIMS, spent.reshape(shape)),
        "impulse": (DIMS, wrong.reshape(shape)),
        "outcome": (DIMS, ended),
        "ps": (DIMS[:2], np.full(shape[:2], np.nan)),
        "step": (DIMS[2:], np.full(shape[2:], 0.1)),
    }
    names = [chr(ord("a") + m) for m in range(shape[0])]
    return xr.Dataset(data, {"method": names, "refinement": meshes, "dt": ["usual"]}, {"case": "made up"})


def on_front(data: xr.Dataset) -> list[list[bool]]:
    """Whether each run is on the front, (method, refinement)."""
    found: list[list[bool]] = study.pareto(data).values[:, 0, :, 0].tolist()
    return found


# The front


def test_front_is_what_no_run_beats() -> None:
    data = made_up([[1, 2, 4], [1.5, 3, 5]], [[0.1, 0.05, 0.01], [0.08, 0.05, 0.02]])
    assert on_front(data) == [[True, True, True], [True, False, False]]


def test_front_keeps_ties_and_leaves_out_what_ties_in_one_and_loses_in_the_other() -> None:
    alike = made_up([[1, 2], [1, 2]], [[0.1, 0.05], [0.1, 0.05]])
    assert on_front(alike) == [[True, True], [True, True]]
    dearer = made_up([[1, 2], [1, 3]], [[0.1, 0.05], [0.2, 0.05]])
    assert on_front(dearer) == [[True, True], [False, False]]


def test_failed_runs_are_never_on_the_front_nor_in_a_cost() -> None:
    outcome = [["energy made by contact", "finished"], ["finished", "spectral instability"]]
    data = made_up([[1, 4], [2, 8]], [[0.01, 0.1], [0.2, np.nan]], outcome)
    assert on_front(data) == [[False, True], [True, False]]
    assert study.cost_at(data, 0.15).values[0] == 4
    assert math.isnan(study.cost_at(data, 0.15).values[1])
    nothing = made_up([[1.0]], [[0.1]], "not finite")
    assert not study.pareto(nothing).any()
    assert np.isnan(study.distance_to_front(nothing)["cost_ratio"]).all()


def test_front_by_brute_force() -> None:
    random = np.random.default_rng(1)
    spent, wrong = random.integers(1, 12, (2, 5, 30)) / 10  # coarse values, so that ties occur
    found = np.array(on_front(made_up(spent, wrong)))
    for i in np.ndindex(spent.shape):
        beaten = (spent <= spent[i]) & (wrong <= wrong[i]) & ((spent < spent[i]) | (wrong < wrong[i]))
        assert found[i] == (not beaten.any())


def test_cost_of_an_accuracy_is_straight_in_logarithms() -> None:
    data = made_up([[1, 4, 16]], [[0.1, 0.025, 0.00625]])  # error = 0.1/cost
    assert float(study.cost_at(data, 0.05)[0]) == pytest.approx(2.0)
    assert float(study.cost_at(data, 0.5)[0]) == 1.0  # the cheapest run is better than need be
    assert math.isnan(study.cost_at(data, 0.001)[0])
    with pytest.raises(bp.InputError, match="cost_at: accuracy = -1, must be > 0"):
        study.cost_at(data, -1)


def test_distance_to_the_front_is_the_ratio_that_was_put_in() -> None:
    cost, wrong = np.array([1.0, 4.0, 16.0]), np.array([0.4, 0.1, 0.025])  # error = 0.4/cost
    data = made_up([cost, 3 * cost, cost], [wrong, wrong, 2 * wrong])
    found = study.distance_to_front(data)
    np.testing.assert_allclose(found["cost_ratio"], [1, 3, 2], rtol=0.13)  # c is cheapest where a has nothing yet
    assert found["error_ratio"][0] == pytest.approx(1)
    assert found["largest_cost_ratio"].values == pytest.approx([1, 3, 2])
    assert found["largest_error_ratio"].values == pytest.approx([1, 3, 2])
    assert (found["least_cost_ratio"] >= 1 - 1e-12).all()


def test_signed_errors_count_by_size() -> None:
    data = made_up([[1, 2]], [[-0.5, 0.1]])
    assert on_front(data) == [[True, True]]
    assert math.isnan(study.cost_at(data, 0.05)[0])


def test_names_that_are_not_there_are_named() -> None:
    with pytest.raises(bp.InputError, match=r"study: error = 'pulse', must be one of .*impulse"):
        study.pareto(made_up([[1]], [[1]]), error="pulse")


# The choice


def test_best_for_an_accuracy_in_words() -> None:
    data = made_up([[1, 4], [0.5, 8]], [[0.015, 0.002], [0.1, 0.001]])
    words = study.best_for(data, 0.02)
    assert words.startswith(
        "made up, impulse to 2 %: a, refinement 10, dt = 0.1 s (usual limit), 1e+03 ms, error 1.5 %"
    )
    assert "next, b, at 1.32 times" in words  # 0.5 * 16^(ln 5/ln 100)
    assert "no run is as accurate; the closest is b, refinement 20" in study.best_for(data, 1e-4)


def test_best_prefers_what_needs_no_parameter_when_equally_cheap() -> None:
    data = made_up([[1], [1]], [[0.01], [0.02]])
    data["ps"][0] = 10.0
    assert ": b, refinement 10" in study.best_for(data, 0.02)
    assert "no run is as accurate; none has finished" in study.best_for(made_up([[1]], [[0.01]], "not finite"), 0.02)


# Rates


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_rates_are_those_put_in(order: float) -> None:
    wrong = 0.3 * (1 / (10 * 2.0 ** np.arange(5))) ** order
    data = made_up([np.ones(5), np.ones(5)], [wrong, wrong], [["finished"] * 5, ["finished", *["not finite"] * 4]])
    for name in errors.MEASURES:
        data[name] = data["impulse"]
    table = study.rates(data)
    fitted = table.sel(dt="usual", measure="impulse")
    assert float(fitted["rate"][0]) == pytest.approx(order)
    assert float(fitted["wobble"][0]) == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(fitted["rate"][1])  # one run that finished has no rate
    assert float(table["expected"].sel(measure="half_width")) == 2.0
    with pytest.raises(bp.InputError, match="number of refinements = 1"):
        study.rates(data.isel(refinement=[0]))


def test_contact_is_of_first_order_in_the_time_step() -> None:
    table = study.rates_in_dt(bp.exact.TwoBars(), refinement=16)
    assert 0.7 < float(table["rate"].sel(measure="impulse")) < 1.6
    with pytest.raises(bp.InputError, match="halvings = 1"):
        study.rates_in_dt(bp.exact.TwoBars(), halvings=1)


# Answers


def test_release_is_when_the_impulse_is_given() -> None:
    impulse = force_error.impulse_of([0.0, *[2.0] * 100, 0.0, 0.0], 0.01)
    assert force_error.released(impulse, 1.02) == pytest.approx(1.005 - 0.01, abs=1e-3)
    assert math.isnan(force_error.released(lambda t: 0 * t, 1.0))


def test_sampler_is_exact_for_linear_fields() -> None:
    scene = study.converged("stack").scene(28)
    places, bodies = centroids(scene)
    points = np.concatenate([body.mesh.points for body in scene.bodies])
    linear = lambda x: np.stack([1 + 2 * x[:, 0] - x[:, 1], 3 * x[:, 1]], axis=1)  # noqa: E731
    np.testing.assert_allclose(Sampler(scene, places, bodies)(linear(points)), linear(places), atol=1e-12)


@pytest.mark.parametrize("name", list(CONVERGED))
def test_stored_references_say_how_certain_they_are(name: str) -> None:
    reference = study.Reference.load(name)
    assert (np.diff(reference.impulse) > -1e-3 * reference.impulse[-1]).all()
    assert {"force", "impulse", "displacement", "release"} == set(reference.uncertainty)
    assert reference.uncertainty["impulse"] < 0.002
    assert reference.uncertainty["force"] < 0.005
    assert abs(reference.energy - 1) < 1e-3
    assert "converged on 464 segments" in reference.about
    at_start = reference.displacement_at(reference.probes, 0.0)
    assert np.abs(at_start).max() < 1e-3
    with pytest.raises(bp.InputError, match="reference: points = "):
        reference.displacement_at(np.zeros((3, 2)), 0.0)


def test_references_keep_momentum() -> None:
    """Free cylinders: what they have at the end is what they had; the lower one has given the impulse."""
    reference, scene = study.Reference.load("cylinders"), study.converged("cylinders").scene(464)
    mass = 0.1 * np.pi * (1 - 2 * np.pi**2 / (3 * 464**2))  # of the polygon, to fourth order
    np.testing.assert_allclose(reference.momentum.sum(axis=0), [mass * 2**0.5] * 2, rtol=1e-4)
    assert scene.n_nodes > 40_000
    assert reference.momentum[0, 1] == pytest.approx(reference.impulse[-1], rel=0.02)  # normals fan out a little


def test_regenerated_at_coarse_resolution_it_agrees_within_its_own_uncertainty() -> None:
    coarse, stored = converge("cylinders", (40, 80)), study.Reference.load("cylinders")
    apart = np.abs(coarse.impulse - stored.impulse).max() / stored.impulse[-1]
    assert apart < coarse.uncertainty["impulse"] + stored.uncertainty["impulse"]
    assert coarse.uncertainty["impulse"] < 0.02
    with pytest.raises(bp.InputError, match=r"converge: meshes = \(40,\)"):
        converge("cylinders", (40,))


def test_unknown_cases_and_references_are_refused() -> None:
    with pytest.raises(bp.InputError, match="study: case = 'spheres', must be one of cylinders"):
        study.converged("spheres")
    with pytest.raises(bp.InputError, match="reference: name = 'spheres'"):
        study.Reference.load("spheres")
    with pytest.raises(bp.InputError, match="study: case = int"):
        study.work_precision(3)
    with pytest.raises(bp.InputError, match="its force over time is stored"):
        study.Case.of(bp.exact.HertzDisc(speed=0.5))


# Real runs


@pytest.fixture(scope="module")
def small() -> xr.Dataset:
    """Three methods on the thrown bar."""
    return study.work_precision(bp.exact.ThrownBar(), METHODS, [12, 24], factors=[1.0, 10.0, 1e3], repeats=2)


def test_every_run_is_there_and_failed_ones_are_labelled(small: xr.Dataset) -> None:
    assert dict(small.sizes) == {"method": 3, "parameter": 3, "refinement": 2, "dt": 3}
    assert (small["outcome"].values[0, 1:] == "not run").all()
    ran = small["outcome"].values != "not run"
    failed = ran & (small["outcome"].values != "finished")
    assert failed[2].any()
    assert not failed[0].any()
    assert (small["reason"].values[failed] != "").all()
    for name in ("force", "impulse", "displacement", "energy", "penetration", "release"):
        assert np.isfinite(small[name].values[ran & ~failed]).all()
        assert np.isnan(small[name].values[~ran]).all()
    for name in ("seconds", "steps", "node_steps", "row_steps"):
        assert (small[name].values[ran] > 0).all() or name == "row_steps"
        assert small[name].attrs["long_name"]


def test_counts_are_those_of_the_runs(small: xr.Dataset) -> None:
    known = bp.exact.ThrownBar()
    model = bp.Model(known.scene(24), dt="assembled")
    result = model.run(known.t_end)
    own = small.isel(method=0, parameter=0).sel(refinement=24, dt="0.98 assembled")
    assert float(own["step"]) == pytest.approx(model.dt, rel=1e-12)
    assert int(own["steps"]) == result.steps
    assert int(own["node_steps"]) == result.steps * 50
    assert int(own["row_steps"]) == int(result.active_rows.sum())
    assert float(own["repeats"]) == 2


def test_errors_are_those_of_the_runs() -> None:
    """A force that is 2 % high, an impulse that is 2 % high, and nothing else wrong."""
    case = study.Case.of(bp.exact.ThrownBar())
    result = bp.Model(case.scene(24), dt=1e-3).run(case.t_end, snapshots=errors.snapshots(case))
    data = result.dataset
    t = data["time"].values
    due = np.diff(case.impulse(np.append(t, t[-1] + 1e-3) - 5e-4)) / 1e-3
    data["contact_force"].values[:] = 1.02 * due
    moved = [case.displacement(data["points"].values, float(s)) for s in data["snapshot_time"].values]
    data["displacement"].values[:] = moved
    wanted = errors.pictures(data["snapshot_time"].values, data["points"].values, case)
    found = errors.of(result, case, None, wanted)
    assert math.isnan(errors.of(result, case)["displacement"])
    assert found["force"] == pytest.approx(0.02, rel=1e-6)
    assert found["impulse"] == pytest.approx(0.02, rel=1e-6)
    assert found["displacement"] == pytest.approx(0.0, abs=1e-12)
    assert found["release"] < 1e-3


def test_hertz_is_judged_by_its_footprint() -> None:
    data = study.work_precision(bp.exact.HertzDisc(), {"ours": bp.Bipenalty()}, [84], repeats=1)
    one = data.isel(method=0, parameter=0, refinement=0).sel(dt="0.98 assembled")
    assert 0 < float(one["half_width"]) < 0.2
    assert 0 < float(one["pressure"]) < 0.3
    assert float(one["impulse"]) < 0.03


def test_figures_show_all_runs_and_mark_the_failed(small: xr.Dataset) -> None:
    figure = plot.work_precision(small)
    assert len(figure.axes) == 4
    ax = figure.axes[0]
    lines = {str(line.get_label()): line for line in ax.lines}
    assert "parameter-free" in lines
    assert "stiffness, best $p_s$" in lines
    finished = (small["outcome"].values == "finished") & (small["force"].values > 0)
    assert len(lines["a run"].get_xdata()) == finished.sum()
    crosses = [line for line in ax.lines if line.get_marker() == "x"]
    failed = ~np.isin(small["outcome"].values, ("finished", "not run"))
    assert len(crosses[0].get_xdata()) == failed.sum()
    own = lines["parameter-free"]
    assert (np.diff(own.get_xdata()) > 0).all()
    assert (np.diff(own.get_ydata()) < 0).all()
    overview = plot.work_precision_overview({"thrown bar": small, "again": small}, title="claim")
    assert [ax.get_title(loc="left") for ax in overview.axes[:2]] == ["thrown bar", "again"]
    with pytest.raises(bp.InputError, match="study: error = 'pulse'"):
        plot.work_precision(small, ["pulse"])


def test_lineup_takes_what_the_package_has(monkeypatch: pytest.MonkeyPatch) -> None:
    class Multipliers:
        """Stands for a method without a parameter."""

    monkeypatch.setattr(bp, "CDLagrange", Multipliers, raising=False)
    assert isinstance(study.lineup()["CD-Lagrange"], Multipliers)
