"""Deformed meshes at chosen instants: the contact region large, the whole scene small beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Rectangle

from bipenalty import checks
from bipenalty.plot import mesh_drawing, style


def deformation(
    result: Any,
    times: Sequence[float] | None = None,
    zoom: mesh_drawing.Window | None = None,
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
    checks.within(
        "plot.deformation",
        "number of snapshots",
        kept,
        kept > 0,
        ">= 1",
        "give their times to run(t_end, snapshots=...)",
    )
    if times is not None:
        data = data.sel(snapshot_time=list(times), method="nearest")
    places = (data["points"] + data["displacement"]).transpose("snapshot_time", "node", "axis").values
    parts = _parts(data)
    rims = [mesh_drawing.boundary(elements) for elements in parts]
    window = zoom or mesh_drawing.contact_window(places, rims)
    scene = mesh_drawing.box(places.reshape(-1, 2), 0.03)
    columns = min(3, len(places))
    rows = -(-len(places) // columns)
    width, height = window[1] - window[0], window[3] - window[2]
    tall = 0.5 + 0.25 * bool(title) + rows * (0.28 + 2.72 * height / width)
    drawn = style.own_figure(figure, *(size or (style.WIDTH, tall)))
    panels = drawn.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    instants = data["snapshot_time"].values
    decimals = max(0, 2 - math.floor(math.log10(instants.max()))) if instants.max() > 0 else 0
    for ax, place, instant in zip(panels.flat, places, instants, strict=False):
        mesh_drawing.bodies(ax, place, parts, rims, fine=True)
        ax.set(xlim=window[:2], ylim=window[2:], aspect="equal", title=f"t = {instant:.{decimals}f} s")
        inset = ax.inset_axes((0.0, 0.0, 0.3, 0.42), xticks=[], yticks=[], anchor="SW")
        mesh_drawing.bodies(inset, place, parts, rims, fine=False)
        inset.set(xlim=scene[:2], ylim=scene[2:], aspect="equal")
        inset.add_patch(Rectangle((window[0], window[2]), width, height, fill=False, linewidth=1.2))
    names = [str(name) for name in data["body"].values]
    mesh_drawing.names(panels.flat[0], places[0], parts, names, window)
    for ax in panels.flat[len(places) :]:
        ax.set_visible(False)
    for ax in panels[-1]:
        ax.set_xlabel("x (m)")
    for ax in panels[:, 0]:
        ax.set_ylabel("y (m)")
    if title:
        drawn.suptitle(title, x=0.01, ha="left")
    return style.whole(drawn)


def _parts(data: xr.Dataset) -> list[list[mesh_drawing.Ints]]:
    """Connectivity of the elements of each body."""
    body = data["body_of_node"].values
    kinds = [data[name].values.astype(np.int64) for name in ("triangles", "quads")]
    return [
        [corners[body[corners[:, 0]] == b] for corners in kinds if (body[corners[:, 0]] == b).any()]
        for b in range(int(body.max()) + 1)
    ]
