"""Where methods hold: maps of force error and energy, right in blue, wrong in orange, diverged in black."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, to_rgb
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import LogLocator, NullFormatter

from bipenalty import checks
from bipenalty.plot import style

#: From right to wrong, told apart with any common colour blindness: blues, a pale middle, oranges.
BLUES, MIDDLE, ORANGES = ("#1F5FA0", "#9CC8E8"), "#F1EEE4", ("#F2AE57", "#BF4A12")
STOPPED = "#1C1C1C"


@dataclass(frozen=True)
class Levels:
    """What a map shows, in few levels: the bounds between them, their words, and one colour more than bounds."""

    shows: str
    bounds: tuple[float, ...]
    words: tuple[str, ...]
    colours: tuple[str, ...] = (*BLUES, MIDDLE, *ORANGES)
    remark: str = "black cross: diverged"


FORCE = Levels("force error (relative L2)", (0.02, 0.06, 0.15, 0.5), ("2 %", "6 %", "15 %", "50 %"))
ENERGY = Levels("energy made or lost", (0.001, 0.01, 0.05, 0.5), ("0.1 %", "1 %", "5 %", "50 %"))


def stability(
    chart: xr.Dataset,
    x: str,
    *,
    scenes: Sequence[str] | None = None,
    emphasis: Sequence[str] = (),
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    size: tuple[float, float] | None = None,
) -> Figure:
    """Draw force error and deviation of the energy for each method (rows) over x, one row of panels a scene.

    Parameters
    ----------
    chart : dataset with force_error and energy_ratio (-) and stopped (bool), each over (scene, method, x).
    x : name of the dimension along the panels; logarithmic where its values spread evenly so. Its `long_name` is the
        label; a variable `x_label` over scene goes before that, and `marks` over scene is a value of x to mark.
    scenes : labels, one row of panels each, in this order; all of the chart unless given.
    emphasis : labels of the methods in bold.
    title : the claim, above the panels.
    figure : figure or subfigure to draw into; a new one of `size` (inches) unless given.

    Raises
    ------
    InputError : a scene that the chart does not have.
    """
    known = [str(scene) for scene in chart["scene"].values]
    chosen = list(known if scenes is None else scenes)
    for scene in chosen:
        checks.within("plot.stability", "scene", repr(scene), scene in known, f"one of {known}", "choose among them")
    names = [str(name) for name in chart["method"].values]
    tall = 1.35 + len(chosen) * (0.75 + 0.215 * len(names))
    drawn = style.own_figure(figure, *(size or (style.WIDTH, tall)))
    panels = drawn.subplots(len(chosen), 2, sharey=True, squeeze=False)
    for row, scene in zip(panels, chosen, strict=True):
        part = chart.isel(scene=known.index(scene)).transpose("method", x, ...)
        y = np.arange(len(names), dtype=float)
        for ax, (values, levels) in zip(row, quantities(part), strict=True):
            cells(ax, part[x].values, y, values, part["stopped"].values, levels, _spreads(part[x].values))
            ax.set_title(f"{scene}: {levels.shows}", loc="left", fontsize=10)
            ax.set_xlabel(str(part["x_label"].values) if "x_label" in part else str(part[x].attrs.get("long_name", x)))
            ax.set_yticks(y, names)
            ax.set_ylim(len(names) - 0.5, -0.5)
            ax.tick_params(length=0, axis="y")
            if "marks" in part and np.isfinite(part["marks"]):
                ax.axvline(float(part["marks"]), color="black", linewidth=1.4, linestyle=(0, (4, 2)))
        for label in row[0].get_yticklabels():
            label.set_fontweight("bold" if label.get_text() in emphasis else "normal")
    for column, levels in zip(panels.T, (FORCE, ENERGY), strict=True):
        key(drawn, column, levels)
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def quantities(part: xr.Dataset) -> list[tuple[Any, Levels]]:
    """Force error and deviation of the energy, with their levels."""
    return [(part["force_error"].values, FORCE), (abs(part["energy_ratio"].values - 1), ENERGY)]


def cells(ax: Axes, x: Any, y: Any, values: Any, stopped: Any, levels: Levels, logarithmic: bool = False) -> None:
    """Fill a panel with one cell per value, (y, x), coloured by level; a cross where the run was stopped."""
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    edges = np.exp(_edges(np.log(x))) if logarithmic else _edges(x)
    level = np.searchsorted(levels.bounds, np.nan_to_num(values, nan=np.inf))
    colours = np.array([to_rgb(colour) for colour in (*levels.colours, STOPPED)])
    gaps = {"edgecolor": "white", "linewidth": 0.4} if len(x) < 50 else {"rasterized": True}
    ax.pcolormesh(edges, _edges(y), colours[np.where(stopped, len(levels.colours), level)], **gaps)
    rows, columns = np.nonzero(stopped)
    ax.plot(x[columns], y[rows], "x", color="white", markersize=3.2, markeredgewidth=0.9)
    if logarithmic:
        ax.set_xscale("log")
        ax.xaxis.set_major_locator(LogLocator(numticks=8))
        ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set_xlim(edges[0], edges[-1])
    ax.spines[:].set_visible(False)


def key(drawn: Figure | SubFigure, panels: Any, levels: Levels) -> None:
    """What the colours mean, below a column of panels."""
    count = len(levels.colours)
    steps = ScalarMappable(BoundaryNorm(np.arange(count + 1.0), count), ListedColormap(list(levels.colours)))
    bar = drawn.colorbar(steps, ax=list(panels), location="bottom", aspect=30, pad=0.02)
    bar.set_ticks(list(range(1, count)), labels=list(levels.words))
    bar.set_label(f"{levels.shows}; {levels.remark}", fontsize=9)
    bar.ax.tick_params(length=0, labelsize=9)
    bar.outline.set_visible(False)


def _spreads(x: Any) -> bool:
    """Whether values spread evenly on a logarithmic scale."""
    return len(x) > 2 and bool(x[0] > 0) and np.allclose(np.diff(np.log(x)), np.log(x[1] / x[0]), rtol=1e-3)


def _edges(centres: Any) -> Any:
    """Edges of cells around their centres."""
    between = (centres[1:] + centres[:-1]) / 2
    return np.concatenate([[2 * centres[0] - between[0]], between, [2 * centres[-1] - between[-1]]])
