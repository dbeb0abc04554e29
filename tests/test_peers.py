"""The comparison with other programs: what they are given, how their output is read, and how outcomes are called.

How fast anything is, no test asks; and none needs another program: CalculiX is played by a script that prints what a
run of the package did, in CalculiX's own format.
"""

import doctest
import importlib
import json
import math
import sys
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import bipenalty as bp

FOLDER = Path(__file__).parents[1] / "benchmarks"
MODULES = (
    "interface",
    "bipenalty_peer",
    "scipy_peer",
    "calculix_files",
    "calculix_peer",
    "akantu_peer",
    "judge",
    "report",
)


@pytest.fixture
def load(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Imports a module of the comparison by its name."""
    pytest.importorskip("scipy")
    monkeypatch.syspath_prepend(FOLDER)
    return lambda name: importlib.import_module(f"peers.{name}")


@pytest.fixture
def mesh() -> bp.Mesh:
    """A coarse disc."""
    return bp.mesh.disc(radius=1.0, segments=24)


def case_of(load: Any, mesh: bp.Mesh, **others: Any) -> Any:
    """The collision of coarse discs, p_s = 1."""
    interface = load("interface")
    return interface.Case(1.0, bp.Model(interface.scene(mesh)).dt, **others)


def outcome_of(load: Any, **others: Any) -> Any:
    """A run without fault of ten steps of 0.1 s under a force of 1 N/m, but for what is given."""
    times, impulse = load("interface").impulse_of_steps(np.ones(10), 0.1)
    usual = {"seconds": 1.0, "steps": 10, "times": times, "impulse": impulse, "summed": True, "penetration": 0.0}
    return load("interface").Outcome(**usual | {"momentum_error": 0.0, "energy_ratio": 1.0} | others)


def test_examples_in_the_modules_hold(load: Any) -> None:
    results = [doctest.testmod(load(name)) for name in MODULES]
    assert any(result.attempted for result in results)
    assert not any(result.failed for result in results)


def test_script_agrees_with_the_package(load: Any, mesh: bp.Mesh) -> None:
    case = case_of(load, mesh)
    ours, theirs = (
        load("bipenalty_peer").Package(stiffness=True).run(mesh, case),
        load("scipy_peer").Script().run(mesh, case),
    )
    assert ours.steps == theirs.steps == case.steps
    np.testing.assert_allclose(theirs.impulse, ours.impulse, atol=1e-9)
    assert math.isclose(theirs.penetration, ours.penetration, rel_tol=1e-9)
    assert max(ours.momentum_error, theirs.momentum_error) < 1e-9
    assert theirs.energy_ratio == pytest.approx(ours.energy_ratio, abs=1e-2)


def test_same_collision_for_the_package_and_for_the_timed_scenes(load: Any, mesh: bp.Mesh) -> None:
    ours = load("interface").scene(mesh)
    timed = importlib.import_module("timed_scenes").collision(24)
    for mine, other in zip(ours.bodies, timed.bodies, strict=True):
        np.testing.assert_array_equal(mine.mesh.points, other.mesh.points)
        assert mine.material == other.material
    np.testing.assert_array_equal(ours.velocity, timed.velocity)


def test_programs_that_are_not_installed_are_skipped_by_name(
    load: Any, mesh: bp.Mesh, tmp_path: Path, capsys: Any
) -> None:
    nowhere = str(tmp_path / "nothing")
    names = ["Akantu", "CalculiX", "bipenalty, stiffness penalty"]
    arguments = ["--segments", "16", "--rounds", "1", "--only", *names, "--ccx", nowhere, "--akantu-python", nowhere]
    load("run").main([*arguments, "--docs", str(tmp_path), "--out", str(tmp_path)])
    seen, data = capsys.readouterr(), json.loads((tmp_path / "peers.json").read_text(encoding="utf-8"))
    assert seen.out.strip() == (tmp_path / "peers.md").read_text(encoding="utf-8").strip()
    for program in data["programs"]:
        skipped = program["name"] in names[:2]
        assert (program["version"] is None) == skipped
        assert (program["seconds"] == []) == skipped
        assert (f"{program['name']}: skipped, not installed ({program['install']})" in seen.err) == skipped
    assert (
        seen.out.count("| not installed |") == 2 * 1 + 2 * 2
    )  # once in the first table, for two penalties in the second
    for words in ("**What it shows.**", "**How measured.**", "**What to conclude.**"):
        assert seen.out.count(words) == 1


def test_table_shows_what_was_measured(load: Any) -> None:
    report, judge, page = load("report"), load("judge"), load("page")
    good = judge.Verdict(0.405, 0.001, 0.02, 1e-13, 0.99984, 2.5e-4, 100, True, "right", "")
    bad = judge.Verdict(
        math.inf, math.inf, math.nan, math.nan, math.nan, math.nan, 100, False, "overflow; no message", ""
    )
    rows = [report.Row("good", "1.2", "", "", [0.2, 0.1, 0.3], good, {1e3: good})]
    rows += [report.Row("bad", "3", "", "all else", [2.0], bad, {1e3: bad}), report.Row("gone", None, "ask for it", "")]
    line, broken, gone = report.collisions(rows, nodes=20).splitlines()[2:]
    figures = ["0.2 (0.1 to 0.3, n = 3)", "100", "1e+05", "2.50e-04", "0.4050 (+0.10 %)", "2.0 %", "1e-13", "0.9998"]
    assert [cell.strip() for cell in line.strip("|").split("|")] == ["good 1.2", *figures, "right"]
    assert "nan" not in broken
    assert gone.startswith("| gone | not installed |")
    assert line.count("|") == broken.count("|") == gone.count("|")
    assert "Right on this collision: good 1.2; not right: bad 3 (overflow; no message)" in page.shown(rows)
    assert "bad 10" in page.shown(rows)  # 2 s over the 0.2 s of the first round
    assert "right with every penalty tried: good 1.2; for" in page.concluded(rows)
    assert "bad (all else)" in page.concluded(rows)


def test_page_says_when_other_programs_ran(load: Any) -> None:
    case, page = load("interface").Case(1.0, dt=0.1, t_end=1.0), load("page")
    wanted = load("judge").Reference(*np.ones((3, 2)))
    busy, quiet, unknown = (
        page.notes(case, wanted, {}, [], {"load average": load}) for load in ("1.50", "0.1", "unknown")
    )
    assert "load average 1.50" in busy
    assert quiet == unknown
    assert "Other programs" not in quiet


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({}, "right"),
        ({"energy_ratio": 1.06}, "energy made; no message"),
        ({"energy_ratio": 0.9, "momentum_error": 0.1, "said": "?"}, "energy lost, momentum not kept; with a message"),
        ({"energy_ratio": math.nan}, "overflow; no message"),
        ({"energy_ratio": math.inf, "said": "overflow"}, "overflow; with a message"),
        ({"impulse": np.zeros(11)}, "wrong force; no message"),
        ({"steps": 40}, "right, 4 times the steps; no message"),
        ({"ended": "stopped", "said": "p_s too large"}, "stopped early, cause named"),
        ({"ended": "stopped", "energy_ratio": 9.0}, "stopped early, no cause named"),
        ({"ended": "time limit", "seconds": 60.0, "times": np.linspace(0, 0.5, 11), "energy_ratio": 2.0},
         "cut off after 60 s, 50 % done, energy made, 2 times the steps; no message"),
    ],
)  # fmt: skip
def test_words_follow_from_the_figures(load: Any, changed: dict[str, Any], words: str) -> None:
    judge, case = load("judge"), load("interface").Case(1.0, dt=0.1, t_end=1.0)
    times, impulse = load("interface").impulse_of_steps(np.ones(10), 0.1)
    verdict = judge.judged(outcome_of(load, **changed), case, judge.Reference(times, impulse, impulse))
    assert verdict.words == words
    assert verdict.right == words.startswith("right")


def test_force_is_compared_with_the_reference_of_its_own_kind(load: Any) -> None:
    judge, case = load("judge"), load("interface").Case(1.0, dt=0.1, t_end=1.0)
    times, impulse = load("interface").impulse_of_steps(np.ones(10), 0.1)
    wanted = judge.Reference(times, impulse, 0.8 * impulse)
    summed, resultant = (judge.judged(outcome_of(load, summed=kind), case, wanted) for kind in (True, False))
    assert summed.force_error < 1e-12
    assert resultant.force_error == pytest.approx(0.25)
    assert resultant.impulse_error == pytest.approx(0.25)


def test_deck_of_calculix_holds_the_two_cylinders(load: Any, mesh: bp.Mesh) -> None:
    text = load("calculix_files").deck(mesh, case_of(load, mesh), every=7)
    blocks = {block.splitlines()[0]: block.splitlines()[1:] for block in text.split("\n*")[1:]}
    nodes = np.array([line.split(",") for line in text.split("\n*")[0].splitlines()[1:]], dtype=float)
    assert len(nodes) == 4 * mesh.n_nodes
    np.testing.assert_allclose(nodes[mesh.n_nodes : 2 * mesh.n_nodes, 1:3], mesh.points, atol=1e-11)  # the bottom one
    for name in ("TOP", "BOTTOM"):
        bricks = np.array([line.split(",") for line in blocks[f"ELEMENT, TYPE=C3D8, ELSET=E{name}"]], dtype=int)
        assert len(bricks) == len(mesh.quads)
        corners = nodes[bricks[:, 1:] - 1, 1:]
        sides = (corners[:, i] - corners[:, 0] for i in (1, 3, 4))
        assert (np.linalg.det(np.stack(list(sides), axis=1)) > 0).all()
        assert len(blocks[f"SURFACE, NAME=S{name}, TYPE=ELEMENT"]) == 24
    slope = float(blocks["SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"][0].split(",")[0])
    assert slope * 2 * math.sin(math.pi / 24) == pytest.approx(1000.0)  # times the segment: p_s E_max
    assert "FREQUENCY=7" in text


def printed(result: Any, time: float) -> str:
    """Displacement and velocity of a snapshot as CalculiX prints them."""
    lines = []
    for words, name in (("displacements (vx,vy,vz)", "displacement"), ("velocities (vx,vy,vz)", "velocity")):
        values = result.dataset[name].sel(snapshot_time=time).values
        lines += ["", f" {words} for set FRONT and time  {time:.7E}", ""]
        lines += [f"{i:10d} {x:13.6E} {y:13.6E} {0:13.6E}" for i, (x, y) in enumerate(values, start=1)]
    return "\n".join(lines) + "\n"


def test_output_of_calculix_is_read(load: Any, mesh: bp.Mesh, tmp_path: Path) -> None:
    case = case_of(load, mesh)
    scene = load("interface").scene(mesh)
    at = case.dt * np.arange(2, case.steps, 2)
    result = bp.Model(scene, bp.Stiffness(1.0), dt=case.dt).run(case.t_end, snapshots=at, show_progress=False)
    times = result.snapshot_time.values
    (tmp_path / "output").write_text("".join(printed(result, time) for time in times) + "\n cut o", encoding="utf-8")
    ccx = tmp_path / "ccx"
    ccx.write_text(
        f"#!{sys.executable}\nimport shutil, sys\n"
        "if '-v' in sys.argv: print('\\nThis is Version 9.87\\n')\n"
        f"else: shutil.copy({str(tmp_path / 'output')!r}, 'discs.dat'); print(' *WARNING: slow\\n Job finished')\n",
        encoding="utf-8",
    )
    ccx.chmod(0o755)
    program = load("calculix_peer").CalculiX(str(ccx))
    assert program.available() == "9.87"
    outcome = program.run(mesh, case)
    assert (outcome.ended, outcome.said, outcome.summed) == ("finished", "*WARNING: slow", False)
    assert abs(outcome.steps - case.steps) <= 2
    resultant = np.linalg.norm(result.force_on.values.sum(axis=1), axis=1).sum() * case.dt
    assert outcome.impulse[-1] == pytest.approx(resultant, rel=2e-3)
    assert outcome.penetration == pytest.approx(result.penetration.values[2::2].max(), rel=1e-3)
    assert outcome.energy_ratio == pytest.approx(1.0, abs=1e-2)
    assert outcome.momentum_error < 1e-5


def test_input_of_akantu_is_the_same_mesh(load: Any, mesh: bp.Mesh, tmp_path: Path) -> None:
    load("akantu_peer").write(tmp_path, mesh, case_of(load, mesh))
    read = meshio.read(tmp_path / "discs.msh", file_format="gmsh")
    np.testing.assert_allclose(read.points[mesh.n_nodes :, :2], mesh.points, rtol=0, atol=0)
    assert len(read.get_cells_type("quad")) == 2 * len(mesh.quads)
    assert len(read.get_cells_type("line")) == 2 * 24
    assert set(read.field_data) == {"top", "bottom", "contact_top", "contact_bottom"}
    material = (tmp_path / "material.dat").read_text(encoding="utf-8")
    epsilon = float(material.split("epsilon_n = ")[1].split()[0])
    assert epsilon * 2 * math.sin(math.pi / 24) == pytest.approx(1000.0)


def test_output_of_akantu_is_read(load: Any, mesh: bp.Mesh, tmp_path: Path) -> None:
    case, akantu = case_of(load, mesh), load("akantu_peer")
    broken = akantu.read(tmp_path, case, -11, "first\n  it went wrong\n\n")
    assert (broken.ended, broken.said) == ("stopped", "exit code -11 it went wrong")
    force = np.arange(case.steps, dtype=float)
    np.savez(tmp_path / "result.npz", force=force, seconds=2.0, depth=0.1, momentum_error=0.3, energy_ratio=1.8)
    outcome = akantu.read(tmp_path, case, 0, "")
    assert (outcome.seconds, outcome.penetration, outcome.momentum_error) == (2.0, 0.1, 0.3)
    assert outcome.impulse[-1] == pytest.approx(case.dt * force.sum())
