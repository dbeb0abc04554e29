"""Total contact force in time: one panel a method, one line a stiffness penalty factor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from bipenalty import checks
from bipenalty.plot import style

#: From the smallest p_s to the largest, which is the noisiest and lies at the back.
COLOURS = ("#000000", "#D55E00", "#0072B2", "#A9B7C4", "#CC79A7", "#E69F00")
METHODS = ("stiffness", "bipenalty", "bipenalty (D = 0.0001)")


def force(
    sweep: xr.Dataset,
    methods: Sequence[str] = METHODS,
    ps: Sequence[float] = (0.01, 0.1, 1, 10),
    *,
    t_end: float | None = None,
    limits: tuple[float, float] | None = None,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    size: tuple[float, float] | None = None,
) -> Figure:
    """Draw the total contact force (N/m, compression positive) against time (s), one panel a method.

    The highest force stands above each panel, also when it lies outside of it; a run that failed is drawn as far as
    it came.

    Parameters
    ----------
    sweep : dataset of `bipenalty.sweep` with histories.
    methods : labels, one panel each, in this order.
    ps : stiffness penalty factors, one line each, the largest at the back.
    t_end : s; the whole run unless given.
    limits : lowest and highest force shown, N/m; all of it unless given.
    title : the claim, above the panels.
    figure : figure or subfigure to draw into; a new one of `size` (inches) unless given.

    Raises
    ------
    InputError : a label or a factor that the sweep does not have, or a sweep without histories.
    """
    data = style.dataset(sweep)
    checks.within(
        "plot.force", "histories", "none", "contact_force" in data, "in the sweep", "run sweep(..., histories=True)"
    )
    chosen = style.labels(data, methods)
    drawn = style.own_figure(figure, *(size or (style.WIDTH, 1.2 + 2.2 * len(chosen))))
    panels = drawn.subplots(len(chosen), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for i, (ax, label) in enumerate(zip(panels, chosen, strict=True)):
        highest = _panel(ax, data.isel(run=np.flatnonzero(data["method"].values == label)), label, ps)
        ax.set_title(f"({chr(ord('a') + i)}) {label}: {highest}", loc="left", fontsize=11)
        ax.set_ylabel("total contact force (N/m)")
    panels[-1].set(xlabel="time (s)", xlim=(0, t_end or float(data["time"].max())))
    if limits is not None:
        panels[-1].set_ylim(*limits)
    panels[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.03), ncols=len(ps), frameon=False, borderaxespad=0)
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def _panel(ax: Axes, runs: xr.Dataset, label: str, ps: Sequence[float]) -> str:
    """Draw the lines; returns the highest peak in words."""
    known = runs["ps"].values
    peaks = []
    for i, factor in enumerate(sorted(ps)):
        found = np.flatnonzero(np.isclose(known, factor, rtol=1e-6))
        checks.within(
            "plot.force",
            f"p_s of {label}",
            factor,
            len(found) > 0,
            f"one of {', '.join(f'{p:.4g}' for p in known)}",
            "choose among the sweep's factors",
        )
        run = runs.isel(run=int(found[0]))
        peak, failed = float(run["peak_force"]), ", where it fails" if bool(run["failed"]) else ""
        peaks.append((peak, f"peak {peak:.3g} N/m at $p_s$ = {factor:g}{failed}"))
        ax.plot(
            run["time"],
            run["contact_force"],
            color=COLOURS[i % len(COLOURS)],
            linewidth=1.2,
            zorder=3 - i / len(ps),
            label=f"$p_s$ = {factor:g}",
        )
    ax.axhline(0, color="0.6", linewidth=0.7, zorder=1)
    style.grid(ax)
    return max(peaks)[1]
