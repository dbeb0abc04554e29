"""Deepest penetration against the stiffness penalty factor: one line a method, failed runs on a strip above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import LogLocator, NullFormatter

from bipenalty.plot import style

ROW = 0.055  # height of one method's row on the strip of failed runs, of the axes
STRIP = "0.94"  # its grey


def penetration(
    sweep: xr.Dataset,
    methods: Sequence[str] | None = None,
    *,
    ax: Axes | None = None,
    title: str | None = None,
    size: tuple[float, float] = (style.WIDTH, 5.2),
) -> Figure:
    """Draw deepest penetration (m) against p_s (-), both logarithmic, one line a method in the order given.

    Only runs that finished are on the lines. A failed run is a cross on the strip at the top, at its p_s, with the
    cause of the method's first failure; a dotted line leads there from where the curve ends.

    Parameters
    ----------
    sweep : dataset of `bipenalty.sweep`.
    methods : labels to draw, in this order; all of the sweep unless given.
    ax : axes to draw into; a new figure of `size` (inches) unless given.
    title : the claim; unless given, the lowest of the lines and where the first method fails.

    Raises
    ------
    InputError : a label that the sweep does not have.

    Example
    -------
    >>> import bipenalty as bp
    >>> from bipenalty import plot
    >>> bar = bp.Body("bar", bp.mesh.rectangle(1, 1, 4, 4), bp.LinearElastic(900, 0, 1), velocity=(-1, 0))
    >>> wall = bp.HalfPlane("wall", point=(0, 0), normal=(1, 0))
    >>> scene = bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])
    >>> sweep = bp.sweep(scene, [bp.Bipenalty(ps) for ps in (0.1, 1.0, 10.0)], t_end=0.1)
    >>> plot.penetration(sweep).axes[0].get_ylabel()
    'deepest penetration (m)'
    """
    data = style.dataset(sweep)
    chosen = style.labels(data, methods)
    if ax is None:
        ax = Figure(figsize=size, layout="constrained").add_subplot()
    failures = {}
    for label, look in style.looks(chosen).items():
        runs = data.isel(run=np.flatnonzero(data["method"].values == label)).sortby("ps")
        ps, finished, failed = (runs[name].values for name in ("ps", "finished", "failed"))
        depth = np.where(finished & (runs["max_penetration"].values > 0), runs["max_penetration"].values, np.nan)
        ax.plot(ps, depth, label=label, **look)
        if failed.any():
            first = int(np.argmax(failed))
            end = (ps[first - 1], depth[first - 1]) if first and depth[first - 1] > 0 else None
            failures[label] = (ps[failed], str(runs["outcome"].values[first]), end)
    ax.set(xscale="log", yscale="log", xlabel="stiffness penalty factor $p_s$ (–)", ylabel="deepest penetration (m)")
    style.grid(ax)
    ax.xaxis.set_major_locator(LogLocator(numticks=20))
    ax.xaxis.set_minor_formatter(NullFormatter())
    factors = data["ps"].values[data["ps"].values > 0]
    if len(factors):
        ax.set_xlim(factors.min() / 1.25, factors.max() * 1.25)
    if all(np.isnan(line.get_ydata()).all() for line in ax.lines):  # nothing to take the limits from
        ax.set_ylim(1e-6, 1)
    _strip(ax, failures, style.looks(chosen))
    ax.set_title(_claim(data, chosen, failures) if title is None else title, loc="left")
    damped = "damping factor D in s" if any("D =" in label for label in chosen) else None
    legend = ax.legend(
        title=damped, title_fontsize=9, loc="lower left", frameon=False, handlelength=2.6, fontsize=9, labelspacing=0.3
    )
    legend.set(alignment="left")
    return style.whole(ax)


def _strip(ax: Axes, failures: dict[str, Any], looks: dict[str, dict[str, Any]]) -> None:
    """Crosses of the failed runs above the lines, one row a method."""
    if not failures:
        return
    low, high = ax.get_ylim()
    height = min(ROW, 0.5 / len(failures))
    share = 1 - height * (len(failures) + 0.5)  # what is left of the axes for the lines
    ax.set_ylim(low, low * (high / low) ** (1 / share))
    across = ax.get_xaxis_transform()
    ax.add_patch(Rectangle((0, share), 1, 1 - share, transform=ax.transAxes, color=STRIP, linewidth=0, zorder=1.5))
    left, right = np.log(ax.get_xlim())
    latest_first = sorted(failures.items(), key=lambda item: -float(item[1][0][0]))  # then no dots cross a text
    for row, (label, (ps, cause, end)) in enumerate(latest_first):
        colour, y = looks[label]["color"], 1 - height * (row + 0.75)
        ax.plot(ps, np.full(len(ps), y), "x", color=colour, markersize=6, markeredgewidth=1.6, transform=across)
        if end is not None:
            dots = {"arrowstyle": "-", "linestyle": ":", "color": colour, "shrinkA": 3, "shrinkB": 4}
            ax.annotate("", (ps[0], y), xycoords=across, xytext=end, textcoords="data", arrowprops=dots)
        before = np.log(ps[0]) - left > right - np.log(ps[-1])
        ax.annotate(
            f"{label}: {cause}",
            (ps[0] if before else ps[-1], y),
            xycoords=across,
            xytext=(-9 if before else 9, 0),
            textcoords="offset points",
            color=colour,
            fontsize=9,
            bbox={"facecolor": STRIP, "edgecolor": "none", "pad": 0.5},
            ha="right" if before else "left",
            va="center",
        )


def _claim(data: xr.Dataset, chosen: list[str], failures: dict[str, Any]) -> str:
    drawn = np.isin(data["method"].values, chosen) & data["finished"].values
    depths = data["max_penetration"].values[drawn]
    if not len(depths):
        return "No run finished"
    claim = f"Penetration falls to {depths.min():.2g} m"
    if not failures:
        return f"{claim}; no run fails"
    first = min(failures, key=lambda label: float(failures[label][0][0]))
    return f"{claim}; {first} fails from $p_s$ = {failures[first][0][0]:.3g}"
