"""The benchmarks run on a coarse mesh and give sane numbers; how fast anything is, no test asks.

Machine and load decide what the benchmarks measure. What can be tested is that package and script compute the same
collision, that each timed scene holds what its name says, and that the arithmetic of rounds and verdicts is right.
"""

import importlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bipenalty as bp

FOLDER = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def load(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Imports a module of the benchmarks by its name."""
    pytest.importorskip("scipy")
    monkeypatch.syspath_prepend(FOLDER)
    return importlib.import_module


def leaves(tree: Any) -> list[Any]:
    """Everything in nested dicts and lists that is neither."""
    if isinstance(tree, (dict, list)):
        return [leaf for item in (tree.values() if isinstance(tree, dict) else tree) for leaf in leaves(item)]
    return [tree]


def measured_only(tree: Any, counted: set[str]) -> Any:
    """Nested dicts and lists without the entries whose names are `counted`."""
    if isinstance(tree, dict):
        return {name: measured_only(item, counted) for name, item in tree.items() if name not in counted}
    return [measured_only(item, counted) for item in tree] if isinstance(tree, list) else tree


def test_quick_run_writes_finite_numbers_and_a_report(load: Any, tmp_path: Path, capsys: Any) -> None:
    load("run").main(["--quick", "--out", str(tmp_path)])
    data = json.loads((tmp_path / "bench.json").read_text(encoding="utf-8"))
    text = (tmp_path / "bench.md").read_text(encoding="utf-8")
    assert capsys.readouterr().out.strip() == text.strip()

    times = [*data["seconds_per_step"].values(), *(d[key] for d in data["against_script"] for key in ("loop", "call"))]
    assert all(0 < seconds < 60 for seconds in leaves(times))
    collision, free = data["against_script"]
    assert 0 <= max(collision["difference"].values()) < 1e-9
    assert set(free["difference"].values()) == {None}  # no contact, nothing to compare
    speed = data["speed"]
    counted = {"runs", "steps", "nodes", "node_steps", "blocks", "lanes", "level", "name"}
    assert all(0 < seconds < 60 for seconds in leaves(measured_only(speed, counted)))
    assert speed["sweep"]["runs"] == 16
    assert 0 < speed["sweep"]["node_steps"] <= 16 * speed["sweep"]["steps"] * speed["sweep"]["nodes"]
    bounds = [claim.pop(bound) for claim in data["expectations"] for bound in ("least", "most")]
    assert bounds.count(None) == len(data["expectations"])  # one bound each
    assert None not in leaves(data["expectations"])
    titles = ("Machine", "ns per node-step", "SciPy script", "Cost follows the scene", "Expectations")
    for part in (
        *titles,
        "Kernel and machine",
        "whole sweep",
        "Number of lanes",
        "One run",
        "large model",
        "The start",
    ):
        assert part in text
    assert "nan" not in text
    assert "NOT COMPARABLE" not in text


def test_scenes_hold_what_their_names_say(load: Any) -> None:
    scenes, measure, plan = load("timed_scenes"), load("measure"), load("plan")
    cases = {case.name: case for case in scenes.cases(24)}
    rows = {name: measure._active_rows(case, plan.QUICK) for name, case in cases.items()}
    touching = {scenes.STIFFNESS, scenes.STIFFNESS_DAMPED, scenes.BIPENALTY, scenes.BIPENALTY_DAMPED, scenes.WALL}
    assert {name for name, active in rows.items() if active > 0} == touching
    assert {name for name, case in cases.items() if case.scene.contacts} == touching | {scenes.APART, scenes.WALL_FAR}
    assert [name for name, case in cases.items() if case.scene.constraints] == [scenes.SUPPORT]
    loaded = [name for name, case in cases.items() if any(body.body_force != (0, 0) for body in case.scene.bodies)]
    assert loaded == [scenes.LOAD]


def test_what_is_recorded_stays_set_while_it_is_timed(load: Any) -> None:
    scenes, measure, plan = load("timed_scenes"), load("measure"), load("plan")
    lengths = {}
    for case in scenes.cases(24):
        model = measure.started(case, plan.QUICK)
        model.step(20)
        data = model.result().dataset
        lengths[case.name] = data.sizes["time"], data.sizes["energy_time"]
    assert lengths[scenes.NOTHING] == (40, 5)  # steps 0 to 39; energies at 0, 10, 19, 20, 30
    assert lengths[scenes.UNSEEN] == (2, 2)  # the first step and the last one before it is timed


@pytest.mark.parametrize("search", ["brute", "lists"])
def test_script_and_package_agree_also_where_the_soft_body_is_dented(load: Any, search: str) -> None:
    """At this refinement the dent of the soft body has corners that are the closest points of nodes inside."""
    scenes, versus = load("timed_scenes"), load("versus_script")
    scene = scenes.collision(48)
    model = bp.Model(scene, bp.Stiffness(1.0))
    ours = model.run(0.18, show_progress=False).dataset
    problem = versus.prepared(scene)
    theirs = load("scipy_script").run(problem, 1000.0, model.dt, model.steps, scene.velocity, search)
    assert versus.apart(ours["contact_force"].values, theirs["contact_force"]) < 1e-9
    assert versus.apart(ours["penetration"].values, theirs["penetration"]) < 1e-9
    np.testing.assert_allclose(model.displacement, theirs["u"], atol=1e-9)


def test_spread_and_ratio_are_those_of_the_rounds(load: Any) -> None:
    measure = load("measure")
    found = measure.spread([5.0, 1.0, 2.0, 4.0, 3.0])
    assert [found.smallest, found.lower, found.median, found.upper, found.largest] == [1, 2, 3, 4, 5]
    assert math.isclose(found.error, 1.57 * 2 / math.sqrt(5))
    # A machine that slows down by the same factor for both changes no ratio.
    slow = np.array([1.0, 3.0, 7.0])
    assert measure.ratio(2 * slow, slow) == measure.spread([2.0, 2.0, 2.0])


def test_claims_are_met_up_to_their_bound(load: Any) -> None:
    claims, spread = load("claims"), load("measure").spread
    assert claims.Claim("a", spread([4.0]), least=4).met
    assert not claims.Claim("a", spread([3.9]), least=4).met
    assert claims.Claim("a", spread([1.5]), most=1.5).met
    assert not claims.Claim("a", spread([1.6]), most=1.5).met
    cases = ((1.0, True), (2.0, True), (2.0, False))
    verdicts = [claims.Claim("a", spread([r]), most=1.5, over=over).verdict for r, over in cases]
    assert verdicts == ["PASS", "not shown", "short"]


def test_unequal_results_void_the_comparison(load: Any) -> None:
    versus, report = load("versus_script"), load("report")
    times = {"brute": np.array([[1.0, 5.0]])}
    good, bad = (versus.Duel("collision", 10, 1e-4, times, times, {"brute": d}) for d in (1e-12, 1e-3))
    assert "NOT COMPARABLE" not in report.against_script([good])
    assert "NOT COMPARABLE: collision, 10 steps, brute" in report.against_script([bad])
