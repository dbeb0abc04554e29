"""The penalty sweep example, run as a user runs it: its files, their columns and contents, its summary."""

import csv
from pathlib import Path

import numpy as np
import pytest

import bipenalty as bp
import example

NUMBERS = ["max_penetration", "max_displacement", "peak_force", "impulse", "energy_ratio"]
COLUMNS = ["method", "ps", "D", *NUMBERS, "failed", "reason", "seconds"]
RUNS = 8 * 8  # methods times p_s, one a decade


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Folder and terminal output of a quick run."""
    folder = tmp_path_factory.mktemp("sweep")
    done = example.run("penalty_sweep.py", folder, "--quick")
    assert done.returncode == 0, done.stderr
    return folder / "out", done.stdout


def test_files(quick: tuple[Path, str]) -> None:
    names = {path.name for path in quick[0].iterdir()}
    assert names == {"penalty_sweep.csv", "penalty_sweep.nc", "deformation.png", "penetration.png", "force.png"}
    for path in quick[0].glob("*.png"):
        assert path.read_bytes().startswith(b"\x89PNG")


def test_table_has_every_run_with_every_digit(quick: tuple[Path, str]) -> None:
    with (quick[0] / "penalty_sweep.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == COLUMNS
    assert len(rows) == RUNS
    dataset = bp.io.read_netcdf(quick[0] / "penalty_sweep.nc")
    for name in ("ps", "D", *NUMBERS):
        np.testing.assert_array_equal([float(row[name]) for row in rows], dataset[name])
    assert [row["failed"] for row in rows] == [str(bool(failed)) for failed in dataset["failed"]]
    assert {row["D"] for row in rows} == {"0.0", "0.01", "0.001", "0.0001"}
    for row in rows:
        assert row["failed"] == "False" or row["reason"] != ""


def test_dataset_has_the_histories(quick: tuple[Path, str]) -> None:
    dataset = bp.io.read_netcdf(quick[0] / "penalty_sweep.nc")
    assert dataset["contact_force"].dims == ("run", "time")
    assert dataset["contact_force"].attrs["units"] == "N/m"
    assert dataset.sizes["run"] == RUNS
    assert dataset["time"][-1] == pytest.approx(0.18, abs=2 * dataset.attrs["dt"])
    finished = dataset["contact_force"].values[dataset["finished"].values]
    assert len(finished) > RUNS / 2
    assert np.isfinite(finished).all()
    np.testing.assert_array_equal(finished.max(axis=1), dataset["peak_force"].values[dataset["finished"].values])
    assert dataset.attrs["displacement_limit"] == 1.0


def test_summary_names_cause_and_window(quick: tuple[Path, str]) -> None:
    lines = {line[:24].strip(): line for line in quick[1].splitlines()}
    assert "spectral instability" in lines["stiffness"]
    assert "10 to 10" in lines["bipenalty (D = 0.001)"]
    assert lines["bipenalty (D = 0.001)"].endswith("none")  # no failed run


@pytest.mark.slow
def test_full_study_holds_its_own_numbers(tmp_path: Path) -> None:
    done = example.run("penalty_sweep.py", tmp_path, "--out", "elsewhere")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "elsewhere" / "force.png").is_file()
