"""Deformed meshes at chosen instants: the contact region large, the whole scene small beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Rectangle

from bipenalty import checks
from bipenalty.plot import style

Window = tuple[float, float, float, float]
FILL = ("#9CC9E8", "#F6C77D", "#A9D9C3", "#E3B7CF", "#D9D9D9")
RIM = ("#00507D", "#8A4B00", "#00614A", "#7A3A5E", "#404040")


def deformation(
    result: Any,
    times: Sequence[float] | None = None,
    zoom: Window | None = None,
    *,
    title: str | None = None,
    figure: Figure | SubFigure | None = None,
    size: tuple[float, float] | None = None,
) -> Figure:
    """Draw the bodies where they are (true scale) at the snapshots of a run, zoomed in on where they touch.

    Parameters
    ----------
    result : a `Result`, or its dataset, of `Model.run(t_end, snapshots=...)`.
    times : s; the snapshots nearest to these, all of them unless given.
    zoom : (x0, x1, y0, y1) of the panels, m; around the nodes that come near another body unless given.
    title : the claim, above the panels.
    figure : figure or subfigure to draw into; a new one of `size` (inches) unless given.

    Raises
    ------
    InputError : a run without snapshots.
    """
    data = style.dataset(result)
    kept = data.sizes.get("snapshot_time", 0)
    checks.within("plot.deformation", "number of snapshots", kept, kept > 0, ">= 1",
                  "give their times to run(t_end, snapshots=...)")
    if times is not None:
        data = data.sel(snapshot_time=list(times), method="nearest")
    places = (data["points"] + data["displacement"]).transpose("snapshot_time", "node", "axis").values
    body = data["body_of_node"].values
    elements = [data[name].values for name in ("triangles", "quads") if data[name].size]
    rims = [_boundary([e[body[e[:, 0]] == b] for e in elements]) for b in range(int(body.max()) + 1)]
    window = zoom or _near(places, rims)
    columns = min(3, len(places))
    rows = -(-len(places) // columns)
    aspect = (window[3] - window[2]) / (window[1] - window[0])
    drawn = style.own_figure(figure, *(size or (style.WIDTH, 0.5 + rows * (0.35 + style.WIDTH / columns * aspect))))
    panels = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for ax in panels.flat[len(places):]:
        ax.set_visible(False)
    scene = _box(places.reshape(-1, 2), 0.03)
    for ax, place, time in zip(panels.flat, places, data["snapshot_time"].values, strict=False):
        _bodies(ax, place, body, elements, rims, fine=True)
        ax.set(xlim=window[:2], ylim=window[2:], aspect="equal", title=f"t = {time:.3f} s")
        inset = ax.inset_axes((0.0, 0.0, 0.3, 0.42), xticks=[], yticks=[])
        _bodies(inset, place, body, elements, rims, fine=False)
        inset.set(xlim=scene[:2], ylim=scene[2:], aspect="equal")
        corner = (window[0], window[2])
        inset.add_patch(Rectangle(corner, window[1] - window[0], window[3] - window[2], fill=False, linewidth=1.2))
    for ax in panels[-1]:
        ax.set_xlabel("x (m)")
    for ax in panels[:, 0]:
        ax.set_ylabel("y (m)")
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)
