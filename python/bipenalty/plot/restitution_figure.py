"""The restitution map: where contact throws back faster than it was hit, and what runs make of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from bipenalty.plot import style
from bipenalty.plot.stability_figure import BLUES, FORCE, ORANGES, Levels, cells, key, quantities
from bipenalty.row_restitution import RestitutionMap

#: Below 1 contact takes energy (blue), above it makes energy (orange).
_SIGNED: dict[str, Any] = {
    "bounds": (0.05, 0.5, 1.0 + 1e-9, 1.5, 2.0),
    "words": ("0.05", "0.5", "1", "1.5", "2"),
    "colours": (*BLUES, "#DCEAF3", "#F8DDB5", *ORANGES),
    "remark": "> 1: energy made",
}
LARGEST = Levels("fastest exit: sup |e|", **_SIGNED)
MEAN_SQUARE = Levels("energy back: mean of $e^2$", **_SIGNED)
#: The published choice, as (R dt^2, zeta), and the critical rule's usual one.
PUBLISHED, CRITICAL = (3.6, 0.0), (1.0, 1.0)
LABEL = "$R\\,dt^2 = s^2$ (–)"


def restitution(
    chart: RestitutionMap,
    *,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    size: tuple[float, float] = (style.WIDTH, 4.7),
) -> Figure:
    """Draw the largest |e| and the mean of e^2 over s^2 = R dt^2 and zeta, the published and critical rules marked.

    Parameters
    ----------
    chart : of `bipenalty.restitution_map`; the figures at the marks are those of its nearest points.
    title : the claim, above the panels.
    figure : figure or subfigure to draw into; a new one of `size` (inches) unless given.

    Example
    -------
    >>> import bipenalty as bp
    >>> drawn = restitution(bp.restitution_map([1.0, 2.0, 3.6], [0.0, 0.5, 1.0]))
    >>> drawn.axes[0].get_xlabel()
    '$R\\\\,dt^2 = s^2$ (–)'
    """
    drawn = style.own_figure(figure, *size)
    panels = drawn.subplots(1, 2, sharey=True)
    fields = ((chart.largest, LARGEST, "sup |e|"), (chart.mean_square, MEAN_SQUARE, "mean $e^2$"))
    for ax, (values, levels, short) in zip(panels, fields, strict=True):
        _panel(ax, chart.s2, chart.zeta, values, np.zeros(values.shape, dtype=bool), levels)
        at = [_nearest(chart, values, point) for point in (PUBLISHED, CRITICAL)]
        _say(ax, PUBLISHED, (14, 22), f"published $R\\,dt^2 = 3.6$, $\\zeta = 0$:\n{short} = {at[0]:.2g}", "right")
        _say(ax, CRITICAL, (14, 14), f"critical rule $\\zeta s = 1$:\n{short} = {at[1]:.2g}", "left")
        key(drawn, [ax], levels)
    panels[0].set_ylabel("damping ratio $\\zeta$ (–)")
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def restitution_and_runs(
    row: RestitutionMap,
    chart: xr.Dataset,
    *,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    size: tuple[float, float] = (style.WIDTH, 7.2),
) -> Figure:
    """Draw the restitution map of one row beside force error and energy of whole runs, over s^2 and zeta.

    Parameters
    ----------
    row : of `bipenalty.restitution_map`.
    chart : dataset with force_error and energy_ratio (-) and stopped (bool), each over (scene, zeta, s2); `x_label`
        over scene if there is one.
    title : the claim, above the panels.
    figure : figure or subfigure to draw into; a new one of `size` (inches) unless given.
    """
    drawn = style.own_figure(figure, *size)
    panels = drawn.subplots(2, 1 + chart.sizes["scene"], sharex=True, sharey=True)
    none = np.zeros(row.largest.shape, dtype=bool)
    theory = [(row.largest, LARGEST), (row.mean_square, MEAN_SQUARE)]
    columns = [("one row, theory", row.s2, row.zeta, none, theory)]
    labels = [LABEL]
    for i, scene in enumerate(chart["scene"].values):
        part = chart.isel(scene=i).transpose("zeta", "s2", ...)
        grid = part["s2"].values, part["zeta"].values, part["stopped"].values
        columns.append((str(scene), *grid, quantities(part)))
        labels.append(str(part["x_label"].values) if "x_label" in part else LABEL)
    for pair, label, (name, s2, zeta, stopped, fields) in zip(panels.T, labels, columns, strict=True):
        for ax, (values, levels) in zip(pair, fields, strict=True):
            _panel(ax, s2, zeta, values, stopped, levels)
            ax.set_title(f"{name}:\n{levels.shows}", loc="left", fontsize=10)
        pair[0].set_xlabel("")
        pair[1].set_xlabel(label)
    _say(panels[0, 0], CRITICAL, (9, 5), "critical rule:\n$\\zeta s = 1$", "left")
    _say(panels[0, 0], PUBLISHED, (10, 8), "published:\n$\\zeta = 0$", "right")
    for ax in panels[:, 0]:
        ax.set_ylabel("damping ratio $\\zeta$ (–)")
    for line, of_runs in zip(panels, quantities(chart), strict=True):
        key(drawn, line[:1], theory[0 if of_runs[1] is FORCE else 1][1])
        key(drawn, line[1:], of_runs[1])
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def _panel(ax: Axes, s2: Any, zeta: Any, values: Any, stopped: Any, levels: Levels) -> None:
    """One map with the two rules on it."""
    cells(ax, s2, zeta, values, stopped, levels)
    rule = np.linspace(max(s2[0], 1 / zeta[-1] ** 2), 2.0, 200)
    ax.plot(rule, 1 / np.sqrt(rule), color="white", linewidth=4.0)
    ax.plot(rule, 1 / np.sqrt(rule), color="black", linewidth=1.8)
    for point, marker, large in ((PUBLISHED, "X", 11), (CRITICAL, "o", 9)):
        ax.plot(*point, marker, color="black", markeredgecolor="white", markersize=large, clip_on=False, zorder=5)
    ax.set_xlabel(LABEL)


def _say(ax: Axes, point: tuple[float, float], offset: tuple[float, float], words: str, side: str) -> None:
    """A remark at a point."""
    box = {"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "none", "alpha": 0.9}
    ax.annotate(words, point, xytext=offset, textcoords="offset points", ha=side, va="bottom", fontsize=9, bbox=box)


def _nearest(chart: RestitutionMap, values: Any, point: tuple[float, float]) -> float:
    """Value of the map nearest to a point (s2, zeta)."""
    return float(values[abs(chart.zeta - point[1]).argmin(), abs(chart.s2 - point[0]).argmin()])
