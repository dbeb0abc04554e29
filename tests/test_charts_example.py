"""The charts example, run as a user runs it: its files, its report and what its verdicts are made of."""

from pathlib import Path

import numpy as np
import pytest

import bipenalty as bp
import example

CASES = ("thrown_bar", "cylinders")


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Folder and terminal output of a quick run."""
    folder = tmp_path_factory.mktemp("charts")
    done = example.run("charts.py", folder, "--quick")
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


def test_files(quick: tuple[Path, str]) -> None:
    names = {f"work_precision_{case}.{kind}" for case in CASES for kind in ("png", "nc")}
    assert {path.name for path in (quick[0] / "out").iterdir()} == {"work_precision.png", *names}
    for path in (quick[0] / "out").glob("*.png"):
        assert path.read_bytes().startswith(b"\x89PNG")


def test_report_tells_of_every_case_and_links_its_figure(quick: tuple[Path, str]) -> None:
    report = (quick[0] / "docs" / "charts.md").read_text(encoding="utf-8")
    for case in CASES:
        assert f"figures/work_precision_{case}.png" in report
    for heading in ("# Speed against accuracy", "## Thrown bar", "## Cylinders", "## Rates"):
        assert heading in report.splitlines()
    assert "| source's set-up |" in report
    assert "nan" not in report.replace("nan (nan)", "")


def test_datasets_come_back_with_every_outcome(quick: tuple[Path, str]) -> None:
    for case in CASES:
        data = bp.io.read_netcdf(quick[0] / "out" / f"work_precision_{case}.nc")
        ran = data["outcome"].values != "not run"
        finished = data["outcome"].values == "finished"
        assert finished[0][ran[0]].all()  # parameter-free
        assert not finished[ran].all()
        assert np.isfinite(data["seconds"].values[ran]).all()
        assert np.isfinite(data["force"].values[finished]).all()


def test_quick_runs_converge(quick: tuple[Path, str]) -> None:
    for case in CASES:
        data = bp.io.read_netcdf(quick[0] / "out" / f"work_precision_{case}.nc")
        ours = data["impulse"].values[0, 0]
        assert (ours[1] < ours[0]).all()


@pytest.mark.slow
def test_full_charts_hold_their_own_numbers(tmp_path: Path) -> None:
    done = example.run("charts.py", tmp_path, "--repeats", "1", "--report", "charts.md")
    assert done.returncode == 0, done.stderr
    assert "PASS" in (tmp_path / "charts.md").read_text(encoding="utf-8")
