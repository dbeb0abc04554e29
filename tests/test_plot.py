"""Figures: what is drawn is what the datasets hold, failed runs are marked and not drawn, nothing global is touched."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

import bipenalty as bp
from bipenalty import plot
from bipenalty.errors import InputError
from bipenalty.plot import mesh_drawing, style

PS = (0.01, 1.0, 100.0, 1e4)
LABELS = ["stiffness", "bipenalty", "bipenalty (D = 0.001)"]


def collision(element: str = "quad") -> bp.Scene:
    """Two coarse discs, of which the softer hits the stiffer one."""
    disc = bp.mesh.disc(radius=1.0, segments=24, element=element)
    top = bp.Body("top", disc.moved(0, 2), bp.LinearElastic(1000, 0.2, 0.1))
    bottom = bp.Body("bottom", disc, bp.LinearElastic(100, 0.2, 0.1), velocity=(1.0, 1.0))
    return bp.Scene([top, bottom], contacts=[bp.Contact("top", "bottom", passes=2)])


@pytest.fixture(scope="module")
def sweep() -> xr.Dataset:
    kinds = [
        bp.Stiffness,
        lambda ps: bp.Bipenalty(ps, rule="published"),
        lambda ps: bp.Bipenalty(ps, D=0.001, rule="published"),
    ]
    return bp.sweep(collision(), [kind(ps) for kind in kinds for ps in PS], 0.1, displacement_limit=1.0, histories=True)


@pytest.fixture(scope="module")
def result() -> bp.Result:
    return bp.Model(collision(), bp.Bipenalty(1.0, rule="published")).run(0.1, snapshots=np.linspace(0, 0.1, 6))


def of(sweep: xr.Dataset, method: str) -> xr.Dataset:
    return sweep.isel(run=np.flatnonzero(sweep["method"].values == method))


def test_penetration_draws_one_line_a_method_and_no_failed_run(sweep: xr.Dataset) -> None:
    failed = of(sweep, "stiffness")["failed"].values
    assert failed.any()
    assert not failed.all()
    ax = plot.penetration(sweep).axes[0]
    lines = {line.get_label(): line for line in ax.lines if not str(line.get_label()).startswith("_")}
    assert list(lines) == LABELS
    assert [text.get_text() for text in ax.get_legend().get_texts()] == LABELS
    for label, line in lines.items():
        runs = of(sweep, label)
        expected = np.where(runs["finished"], runs["max_penetration"], np.nan)
        np.testing.assert_array_equal(np.ma.filled(line.get_ydata(), np.nan), expected)
    assert ax.get_xscale() == ax.get_yscale() == "log"
    assert "p_s" in ax.get_xlabel()
    assert ax.get_ylabel() == "deepest penetration (m)"


def test_penetration_marks_where_a_method_fails_and_why(sweep: xr.Dataset) -> None:
    ax = plot.penetration(sweep, ["stiffness"]).axes[0]
    runs = of(sweep, "stiffness")
    crosses = [line for line in ax.lines if line.get_marker() == "x"]
    assert len(crosses) == 1
    np.testing.assert_array_equal(crosses[0].get_xdata(), runs["ps"].values[runs["failed"].values])
    assert "stiffness: spectral instability" in [text.get_text() for text in ax.texts]
    depths = runs["max_penetration"].values[runs["finished"].values]
    share = ax.get_yaxis().get_transform().transform(depths.max())
    bottom, top = ax.get_yaxis().get_transform().transform(np.array(ax.get_ylim()))
    assert (share - bottom) / (top - bottom) < crosses[0].get_ydata()[0]  # the strip is above the lines


def test_penetration_order_axes_and_title_are_the_callers(sweep: xr.Dataset) -> None:
    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert plot.penetration(sweep, LABELS[:0:-1], ax=right, title="Claim") is figure
    assert not left.lines
    assert right.get_title(loc="left") == "Claim"
    assert [text.get_text() for text in right.get_legend().get_texts()] == LABELS[:0:-1]


def test_penetration_without_a_finished_run(sweep: xr.Dataset, tmp_path: Path) -> None:
    lost = sweep.copy()
    lost["failed"], lost["finished"] = ~(sweep["failed"] & False), sweep["failed"] & False
    figure = plot.penetration(lost)
    figure.savefig(tmp_path / "figure.png")
    assert figure.axes[0].get_title(loc="left") == "No run finished"


def test_colour_tells_damping_and_dash_tells_family() -> None:
    looks = style.looks(["stiffness", "bipenalty", "stiffness (D = 0.01)", "bipenalty (D = 0.01)"])
    plain, mass, damped, both = looks.values()
    assert plain["color"] == mass["color"] != damped["color"] == both["color"]
    assert plain["linestyle"] == damped["linestyle"] != mass["linestyle"] == both["linestyle"]


def test_force_panels_hold_the_histories(sweep: xr.Dataset) -> None:
    figure = plot.force(sweep, LABELS, (0.01, 1), t_end=0.05, limits=(-1, 7), title="Claim")
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert [title.split(":")[0] for title in titles] == [f"({c}) {m}" for c, m in zip("abc", LABELS, strict=True)]
    assert figure.get_suptitle() == "Claim"
    assert figure.axes[-1].get_xlim() == (0, 0.05)
    assert figure.axes[0].get_ylim() == (-1, 7)
    assert figure.axes[-1].get_xlabel() == "time (s)"
    for ax, label in zip(figure.axes, LABELS, strict=True):
        assert ax.get_ylabel().endswith("(N/m)")
        lines = [line for line in ax.lines if not str(line.get_label()).startswith("_")]
        assert len(lines) == 2
        for line, i in zip(lines, (0, 1), strict=True):
            np.testing.assert_array_equal(line.get_ydata(), of(sweep, label)["contact_force"].values[i])
        peak = of(sweep, label)["peak_force"].values[:2].max()
        assert f"peak {peak:.3g} N/m" in ax.get_title(loc="left")


@pytest.mark.parametrize("element", ["quad", "triangle"])
def test_deformation_draws_every_element_where_it_is(element: str) -> None:
    run = bp.Model(collision(element), bp.Bipenalty(1.0, rule="published")).run(0.02, snapshots=[0.0, 0.02])
    figure = plot.deformation(run, title="Claim")
    assert [ax.get_title() for ax in figure.axes] == [f"t = {t:.4f} s" for t in run.snapshot_time.values]
    assert figure.get_suptitle() == "Claim"
    elements = run.dataset[f"{element}s"].values
    place = (run.points + run.displacement[1]).values
    filled = [c for c in figure.axes[1].collections if isinstance(c, PolyCollection)]
    corners = np.concatenate([[path.vertices[:-1] for path in c.get_paths()] for c in filled])
    np.testing.assert_array_equal(corners, place[elements])
    assert figure.axes[0].get_aspect() == 1


def test_deformation_zooms_in_on_the_contact(result: bp.Result) -> None:
    figure = plot.deformation(result)
    assert len(figure.axes) == 6
    (x0, x1), (y0, y1) = figure.axes[0].get_xlim(), figure.axes[0].get_ylim()
    assert x0 < 0 < x1 < 1
    assert 0 < y0 < 1 < y1 < 2
    near = plot.deformation(result, times=[0.0, 0.1], zoom=(-0.1, 0.2, 0.9, 1.1)).axes
    assert len(near) == 2
    assert near[1].get_xlim() == (-0.1, 0.2)
    assert near[1].get_ylim() == (0.9, 1.1)


def test_deformation_of_a_single_body_shows_all_of_it() -> None:
    bar = bp.Body("bar", bp.mesh.rectangle(2, 1, 4, 2), bp.LinearElastic(900, 0, 1), velocity=(1, 0))
    ax = plot.deformation(bp.Model(bp.Scene([bar])).run(0.1, snapshots=[0.0])).axes[0]
    assert ax.get_xlim()[1] - ax.get_xlim()[0] > 2
    assert len(mesh_drawing.boundary([bar.mesh.quads])) == 12


def test_figures_leave_pyplot_alone_and_can_be_saved(sweep: xr.Dataset, result: bp.Result, tmp_path: Path) -> None:
    before = plt.get_fignums()
    for i, figure in enumerate([plot.penetration(sweep), plot.force(sweep, LABELS, PS), plot.deformation(result)]):
        figure.savefig(tmp_path / f"{i}.png", dpi=50)
        assert (tmp_path / f"{i}.png").stat().st_size > 1000
        assert round(figure.get_figwidth() * 100) == 900  # the width of a README
    assert plt.get_fignums() == before


def test_errors_name_what_is_missing(sweep: xr.Dataset, result: bp.Result) -> None:
    with pytest.raises(InputError, match="'mortar', must be one of 'stiffness', 'bipenalty'"):
        plot.penetration(sweep, ["mortar"])
    with pytest.raises(InputError, match=r"p_s of stiffness = 3, must be one of 0.01, 1, 100, 1e\+04"):
        plot.force(sweep, ["stiffness"], [3])
    with pytest.raises(InputError, match="histories=True"):
        plot.force(sweep.drop_vars("contact_force"), ["stiffness"])
    with pytest.raises(InputError, match="give their times to run"):
        plot.deformation(result.dataset.isel(snapshot_time=slice(0)))
    with pytest.raises(InputError, match="what to draw = list"):
        plot.penetration([1, 2])  # type: ignore[arg-type]
