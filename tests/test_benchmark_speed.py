"""The arithmetic of the speed benchmarks: counts of a mesh, rounds, levels of memory, verdicts, tables."""

import importlib
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bipenalty as bp

FOLDER = Path(__file__).parents[1] / "benchmarks"
ROUNDS = np.ones(3)


@pytest.fixture
def load(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Imports a module of the benchmarks by its name."""
    pytest.importorskip("scipy")
    monkeypatch.syspath_prepend(FOLDER)
    return importlib.import_module


def cells(load: Any, seconds: float, multiply_add: float) -> list[Any]:
    """The kernel on two meshes with rows of nine blocks; memory alone takes 1 ns per node-step and lane."""
    kernel, ceilings = load("speed.kernel"), load("speed.ceilings")
    return [
        kernel.Cell(ceilings.Counts(n, 9 * n), lanes, seconds * ROUNDS, 1e-9 * ROUNDS, multiply_add * ROUNDS)
        for n in (1000, 3000)
        for lanes in kernel.LANES
    ]


def plates(load: Any, growth: float, levels: tuple[int, ...]) -> list[Any]:
    """Plates whose step grows with a power of their nodes; memory alone takes half of it."""
    large, ceilings = load("speed.large"), load("speed.ceilings")
    found = []
    for nodes, level in zip((1000, 10_000, 100_000, 1_000_000), levels, strict=True):
        seconds = 1e-9 * nodes ** (growth - 1) * ROUNDS
        found.append(large.Size(ceilings.Counts(nodes, 9 * nodes), level, {1: seconds, 2: seconds / 2}, seconds / 2))
    return found


def verdicts(claims: list[Any]) -> dict[str, str]:
    return {claim.text: claim.verdict for claim in claims}


def test_blocks_are_the_pairs_of_nodes_that_share_an_element(load: Any) -> None:
    disc, plate = bp.mesh.disc(radius=1.0, segments=16), bp.mesh.rectangle(1, 1, 3, 2)
    halves = np.concatenate([plate.quads[:, [0, 1, 2]], plate.quads[:, [0, 2, 3]]])
    split = bp.Mesh(plate.points, triangles=halves)
    for mesh in (disc, plate, split):
        pairs = {pair for e in (*mesh.quads, *mesh.triangles) for pair in itertools.product(e.tolist(), repeat=2)}
        scene = bp.Scene([bp.Body("a", mesh, bp.LinearElastic(1.0, 0.2, 1.0))])
        assert load("speed.ceilings").counts(scene).blocks == len(pairs)


def test_each_case_has_its_turns_in_every_round(load: Any) -> None:
    turns: list[str] = []

    def case(name: str) -> float:
        turns.append(name)
        return float(len(turns))

    names = ("a", "b", "c")
    found = load("speed.rounds").interleaved({n: lambda n=n: case(n) for n in names}, rounds=4, places=2, once="c")
    rounds = [turns[i : i + 5] for i in range(0, 20, 5)]
    assert all(sorted(turn) == ["a", "a", "b", "b", "c"] for turn in rounds)
    assert len({tuple(turn) for turn in rounds}) > 1
    for name in names:  # the earlier of its turns took less
        firsts = [1 + 5 * number + turn.index(name) for number, turn in enumerate(rounds)]
        assert found[name].tolist() == firsts


def test_kernel_is_judged_by_the_multiply_adds_that_there_can_be(load: Any) -> None:
    claims = load("speed.claims")
    text = "multiply-adds of the bare kernel over the machine's, 16 lanes, 1000 nodes"
    # 40 of them a node-step: shares of 0.9, 0.7, and one that no machine can have.
    for multiply_add, verdict in ((0.0225e-9, "PASS"), (0.0175e-9, "short"), (0.03e-9, "no ceiling")):
        found = verdicts(claims.of_kernel(cells(load, 1e-9, multiply_add)))
        assert found[text] == verdict


def test_one_lane_is_judged_by_memory(load: Any) -> None:
    claims = load("speed.claims")
    for seconds, verdict in ((1.2e-9, "PASS"), (1.4e-9, "short")):
        found = verdicts(claims.of_kernel(cells(load, seconds, 1e-11)))
        assert found["bare kernel of one lane over streaming its matrix and state, 3000 nodes"] == verdict


def test_sweep_is_compared_by_the_node_step(load: Any) -> None:
    claims, sweep = load("speed.claims"), load("speed.sweep")
    kernel = {1: 4e-9 * ROUNDS, 8: 2e-9 * ROUNDS, 16: 3e-9 * ROUNDS}
    threads = {1: 3.9 * ROUNDS, 2: 2.0 * ROUNDS}
    found = claims.of_sweep(sweep.Sweep(10, 100, 1000, 1e9, threads, {}, kernel, 81e-9 * ROUNDS))
    assert [round(claim.measured.median, 3) for claim in found] == [1.3, 1.95, 40.5, 1.95]
    assert [claim.verdict for claim in found] == ["PASS", "short", "PASS", "PASS"]
    alone = claims.of_sweep(sweep.Sweep(10, 100, 1000, 1e9, {1: threads[1]}, {}, kernel, 81e-9 * ROUNDS))
    assert len(alone) == 2  # one core: nothing is said of two


def test_single_run_and_its_start(load: Any) -> None:
    claims, scenes, single, start = (load(n) for n in ("speed.claims", "timed_scenes", "speed.single", "speed.start"))
    seconds = {single.BARE: 10.0, scenes.STIFFNESS: 11.0, scenes.BIPENALTY: 12.0}
    seconds |= {scenes.STIFFNESS + single.PEAKS: 13.0, scenes.BIPENALTY + single.PEAKS: 15.0}
    found = claims.of_single(single.Single(1000, 64, {name: value * ROUNDS for name, value in seconds.items()}))
    assert [claim.verdict for claim in found] == ["PASS", "PASS", "short", "short"]
    for whole, verdict in ((0.1, "PASS"), (0.11, "short")):
        begun = start.Start(1000, 2000, {start.LOWERING: whole * ROUNDS}, whole * ROUNDS, ROUNDS)
        assert claims.of_start(begun)[0].verdict == verdict


def test_growth_is_judged_within_each_level(load: Any) -> None:
    claims, large = load("speed.claims"), load("speed.large")
    found = large.exponents(plates(load, 1.1, (0, 0, 1, 1)))
    assert sorted(found) == [0, 1]
    np.testing.assert_allclose([*found.values()], 1.1)
    texts = verdicts(claims.of_large(plates(load, 1.1, (0, 0, 1, 2))))
    assert texts["exponent of the growth of a step, 1000 to 10000 nodes"] == "short"
    assert len(texts) == 3  # no exponent of a single size; the share of both sizes beyond the own cache
    assert verdicts(claims.of_large(plates(load, 1.0, (0, 0, 0, 0)))) == {
        "exponent of the growth of a step, 1000 to 1000000 nodes": "PASS"
    }


def test_levels_without_a_known_cache_are_jumps_of_the_probe(load: Any) -> None:
    levels = load("speed.large").levels_of
    assert levels([1, 2, 4, 8], [1.0, 1.6, 1.7, 3.0], own=0) == [0, 1, 1, 2]
    assert levels([1, 2, 4, 8], [1.0, 1.6, 1.7, 3.0], own=2) == [0, 0, 1, 2]


def test_tables_hold_what_they_are_given(load: Any) -> None:
    report, runs, widths = load("speed.report"), load("speed.report_runs"), load("speed.widths")
    text = report.kernel(cells(load, 2e-9, 0.04e-9))
    assert "| 1000 nodes, lanes: 16 | 1.11 MB | 2.00 | 1.60 | 1.00 | 0.800 ± 0.000 | 2.00 ± 0.00 |" in text
    assert "25.0 ± 0.0 10^9 multiply-adds" in text
    row = widths.Widths("stiffness", 1000, {lanes: (20 - lanes) * 1e-9 * ROUNDS for lanes in widths.WIDTHS})
    slow = widths.Widths("slow", 1000, {lanes: (4 + lanes) * 1e-9 * ROUNDS for lanes in widths.WIDTHS})
    text = report.widths([row], [slow])
    assert "| stiffness, 1000 nodes | 19.00 | 18.00 | 16.00 | 12.00 | 4.00 | 16 | 1.000 ± 0.000 |" in text
    assert "| 1 | 4.00 ± 0.00 |" in text
    text = runs.large(plates(load, 1.0, (0, 0, 1, 1)))
    assert "| 1000 nodes | 393 kB | 0 | 1.00 | 0.50 | 2.00 ± 0.00 | 0.50 | 816.0 | 0.500 ± 0.000 |" in text
    assert "level 0: 1.000 ± 0.000; level 1: 1.000 ± 0.000" in text
