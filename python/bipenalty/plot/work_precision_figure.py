"""Error against cost: one line a method along its best runs, every run behind it, failed ones on a strip above."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullFormatter

from bipenalty.plot import style
from bipenalty.study.errors import MEASURES
from bipenalty.study.front import cost_at, line, values_of

#: Look of the methods; the first is the one that the charts are about. Others take what is left of the palette.
LOOKS: dict[str, dict[str, Any]] = {
    "parameter-free": {"color": "#D55E00", "linewidth": 2.6, "marker": "o", "markersize": 5.5, "zorder": 6},
    "critical": {"color": "#E69F00", "linewidth": 1.3, "marker": "o", "markersize": 3.5, "zorder": 5},
    "CD-Lagrange": {"color": "#000000", "linewidth": 1.5, "marker": "D", "markersize": 3.5, "zorder": 5},
    "forward increment": {"color": "#000000", "linewidth": 1.2, "linestyle": ":", "marker": "D", "markersize": 3.5},
    "predictor-corrector": {"color": "#CC79A7", "linewidth": 1.4, "marker": "P", "markersize": 4.5},
    "published": {"color": "#0072B2", "linewidth": 1.4, "marker": "s", "markersize": 3.8},
    "published, D = 1e-4 s": {"color": "#56B4E9", "linewidth": 1.4, "marker": "s", "markersize": 3.8},
    "stiffness": {"color": "#009E73", "linewidth": 1.4, "marker": "^", "markersize": 4.2},
    "element stiffness": {"color": "#888888", "linewidth": 1.1, "linestyle": "--", "marker": "v", "markersize": 3.5},
    "nodal mass stiffness": {"color": "#888888", "linewidth": 1.1, "marker": "v", "markersize": 3.5},
}
#: The published set-up: method, time step, and its look.
SOURCE = ("published", "0.5 element")
SOURCE_LOOK: dict[str, Any] = {"color": "#0072B2", "linewidth": 1.8, "linestyle": (0, (4, 1.5)), "marker": "s", "markersize": 4.5,
               "markerfacecolor": "white", "zorder": 5, "label": "source's set-up (dt = half), best $p_s$"}  # fmt: skip
FRONT: dict[str, Any] = {
    "color": "#F6DE9A",
    "linewidth": 9,
    "solid_capstyle": "round",
    "zorder": 1,
    "label": "best of all runs",
}
UNITS = {"seconds": (1e3, "processor time (ms)"), "node_steps": (1.0, "node-steps")}
UNCERTAIN = "below the answer's uncertainty"
#: Accuracies that a gain is shown at, the most accurate that both reach.
LEVELS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)


def work_precision(
    data: xr.Dataset,
    errors: Sequence[str] = ("force", "impulse", "displacement", "energy"),
    cost: str = "seconds",
    *,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    size: tuple[float, float] | None = None,
) -> Figure:
    """Draw errors of one case against what runs cost, one panel an error, both axes logarithmic.

    Parameters
    ----------
    data : dataset of `bipenalty.study.work_precision`.
    errors : measures, one panel each.
    cost : "seconds" or a count, e.g. "node_steps".
    title : the claim, above the panels.
    figure : figure or subfigure to draw into; a new one of `size` (inches) unless given.

    A method's line joins the runs of it that no other run of it beats; with a parameter, the best p_s are in it by
    hindsight. Dots are all runs that finished, crosses at the top those that did not.

    Raises
    ------
    InputError : an error or a cost that the dataset does not have.
    """
    columns = min(2, len(errors))
    rows = -(-len(errors) // columns)
    drawn = style.own_figure(figure, *(size or (style.WIDTH, 1.3 + 2.9 * rows)))
    panels = drawn.subplots(rows, columns, squeeze=False)
    for ax, error in zip(panels.flat, errors, strict=False):
        panel(ax, data, error, cost, list(map(str, data["method"].values)), arrow=error in ("force", "impulse"))
        ax.set_title(MEASURES[error][0].upper() + MEASURES[error][1:], loc="left", fontsize=8, wrap=True)
        ax.set_ylabel(f"{error.replace('_', ' ')} error (%)")
    for ax in panels[-1]:
        ax.set_xlabel(UNITS.get(cost, (1.0, cost))[1])
    for ax in panels.flat[len(errors) :]:
        ax.set_visible(False)
    handles, words = key(list(panels.flat))
    drawn.legend(handles, words, loc="outside lower center", ncols=4, frameon=False, fontsize=8, columnspacing=1.2)
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def work_precision_overview(
    charts: Mapping[str, xr.Dataset],
    error: str = "force",
    cost: str = "seconds",
    *,
    methods: Sequence[str] = ("parameter-free", "CD-Lagrange", "predictor-corrector", "published", "stiffness"),
    title: str | None = None,
    size: tuple[float, float] | None = None,
) -> Figure:
    """Draw one small panel a case: error against cost of the methods, and the gain over the published set-up.

    Parameters
    ----------
    charts : datasets of `bipenalty.study.work_precision` by the name of the case.
    error, cost : names in the datasets.
    methods : lines to draw, as far as the datasets have them.
    title : the claim, above the panels.
    size : inches.
    """
    cells = len(charts) + 1  # the last is for the key
    columns = min(4, cells)
    rows = -(-cells // columns)
    drawn = style.own_figure(None, *(size or (style.WIDTH * 1.25, 0.7 + 2.6 * rows)))
    panels = drawn.subplots(rows, columns, squeeze=False)
    for i, (ax, (name, data)) in enumerate(zip(panels.flat, charts.items(), strict=False)):
        panel(ax, data, error, cost, [m for m in methods if m in data["method"].values], arrow=True)
        ax.set_title(name, loc="left", fontsize=10.5, fontweight="bold")
        if i % columns == 0:
            ax.set_ylabel(f"{error.replace('_', ' ')} error (%)")
        if i + columns >= len(charts):
            ax.set_xlabel(UNITS.get(cost, (1.0, cost))[1])
    for ax in panels.flat[len(charts) :]:
        ax.set_axis_off()
    handles, words = key(list(panels.flat))
    panels.flat[len(charts)].legend(handles, words, loc="center left", frameon=False, fontsize=9, borderaxespad=0)
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def panel(ax: Axes, data: xr.Dataset, error: str, cost: str, methods: Sequence[str], arrow: bool) -> None:
    """Fill one panel: all runs, the front, a line a method, the published set-up, the gain over it."""
    factor = UNITS.get(cost, (1.0, cost))[0]
    names = list(map(str, data["method"].values))
    spent, wrong = values_of(data, error, cost)
    good = np.isfinite(spent) & (wrong > 0)
    ax.plot(factor * spent[good], 100 * wrong[good], ".", color="0.84", markersize=2.5, zorder=0, label="a run")
    lines = {name: line(*values_of(data.isel(method=[m]), error, cost)) for m, name in enumerate(names)}
    _band(ax, line(spent, wrong), factor)
    for name in methods:
        look = {"linestyle": "-", "zorder": 3, "color": "#CC79A7", "linewidth": 1.2, **LOOKS.get(name, {})}
        hindsight = ", best $p_s$" if np.isfinite(data["ps"].values[names.index(name)]).any() else ""
        x, y = lines[name]
        ax.plot(factor * np.exp(x), 100 * np.exp(y), label=name + hindsight, **look)
    if SOURCE[0] in names and SOURCE[1] in data["dt"].values:
        part = data.isel(method=[names.index(SOURCE[0])], dt=[list(data["dt"].values).index(SOURCE[1])])
        x, y = line(*values_of(part, error, cost))
        ax.plot(factor * np.exp(x), 100 * np.exp(y), **SOURCE_LOOK)
        if arrow and names[0] in methods:
            _gain(ax, part, data.isel(method=[0]), error, cost, factor)
    _frame(ax, data, error, cost, (factor * spent[good], wrong[good]), factor)


def key(panels: Sequence[Axes]) -> tuple[list[Any], list[str]]:
    """Handles and words of the legend, each once, in the order that matters."""
    found = {word: handle for ax in panels for handle, word in zip(*ax.get_legend_handles_labels(), strict=True)}
    last = ("a run", FRONT["label"], UNCERTAIN)
    words = sorted(found, key=lambda word: (word in last, list(found).index(word)))
    crosses = Line2D([], [], linestyle="", marker="x", color="0.35", markersize=5)
    return [*(found[word] for word in words), crosses], [*words, "failed runs, at what they cost"]


def _band(ax: Axes, front: tuple[Any, Any], factor: float) -> None:
    """The front of all runs, broad and pale."""
    x, y = front
    ax.plot(factor * np.exp(x), 100 * np.exp(y), **FRONT)


def _gain(ax: Axes, source: xr.Dataset, ours: xr.Dataset, error: str, cost: str, factor: float) -> None:
    """An arrow from the published set-up to ours at an accuracy that both reach, with the ratio of costs."""
    for level in LEVELS:
        theirs, own = (float(cost_at(part, level, error, cost)[0]) for part in (source, ours))
        within = [np.exp(line(*values_of(part, error, cost))[1]).max(initial=0) >= level for part in (source, ours)]
        if np.isfinite(theirs) and np.isfinite(own) and all(within):
            style_of = {"arrowstyle": "-|>", "color": "black", "linewidth": 1.3, "shrinkA": 0, "shrinkB": 0}
            ends = (factor * own, 100 * level), (factor * theirs, 100 * level)
            ax.annotate("", ends[0], ends[1], arrowprops=style_of, zorder=8)
            ratio = f"{theirs / own:.1f}× cheaper" if theirs >= own else f"{own / theirs:.1f}× dearer"
            words = f"{ratio} at {100 * level:g} %"
            ax.text(0.97, 0.87, words, transform=ax.transAxes, fontsize=9.5, va="top", ha="right", zorder=8,
                    bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.85})  # fmt: skip
            return


def _frame(ax: Axes, data: xr.Dataset, error: str, cost: str, runs: tuple[Any, Any], factor: float) -> None:
    """Scales, limits, the strip of failed runs, and how certain the answer is."""
    ax.set(xscale="log", yscale="log")
    spent, wrong = runs
    if spent.size:
        ax.set_xlim(spent.min() / 1.6, spent.max() * 1.6)
    low, high = (100 * wrong.min() * 0.6, min(100 * wrong.max() * 1.3, 120.0)) if wrong.size else (0.1, 100.0)
    top = high * (high / low) ** 0.09
    ax.set_ylim(low, top)
    ax.axhspan(high, top, color="0.94", zorder=0, linewidth=0)
    ended = ~np.isin(data["outcome"].values, ("finished", "not run"))
    failed = factor * data[cost].values[ended]
    ax.plot(failed, np.full(failed.shape, (high * top) ** 0.5), "x", color="0.35", markersize=3.2, alpha=0.5, zorder=4)
    known = data.attrs.get(f"uncertainty_{error}")
    if known is not None and 100 * known > low:
        ax.axhspan(
            low, 100 * known, facecolor="0.9", zorder=0, linewidth=0, hatch="////", edgecolor="white", label=UNCERTAIN
        )
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    style.grid(ax)
