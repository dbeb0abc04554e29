"""Drawing deformed bodies: filled elements with thin edges, bold boundaries, and where bodies come near."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

Floats = np.ndarray[Any, np.dtype[np.float64]]
Ints = np.ndarray[Any, np.dtype[np.int64]]
Window = tuple[float, float, float, float]

#: Light fills and dark rims, told apart with any common colour blindness; the bodies in turn.
FILLS = ("#A8D1EE", "#F8CF8E", "#B3DFCB", "#E6C3D8", "#DADADA")
RIMS = ("#00456E", "#8A4300", "#005A43", "#7A3A5E", "#303030")


def boundary(elements: Sequence[Ints]) -> Ints:
    """Edges, (E, 2) node numbers, that belong to one element only.

    >>> len(boundary([np.array([[0, 1, 2], [0, 2, 3]])]))
    4
    """
    edges = np.concatenate([np.stack([e, np.roll(e, -1, axis=1)], axis=-1).reshape(-1, 2) for e in elements])
    _, first, count = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    alone: Ints = edges[first[count == 1]]
    return alone


def bodies(ax: Axes, place: Floats, parts: Sequence[Sequence[Ints]], rims: Sequence[Ints], fine: bool) -> None:
    """Draw the bodies with their nodes at place (N, 2), m; with element edges when fine."""
    for b, (elements, rim) in enumerate(zip(parts, rims, strict=True)):
        fill, dark = FILLS[b % len(FILLS)], RIMS[b % len(RIMS)]
        for corners in elements:
            edge = dark if fine else fill
            ax.add_collection(PolyCollection(list(place[corners]), facecolor=fill, edgecolor=edge, linewidth=0.35))
        ax.add_collection(LineCollection(list(place[rim]), color=dark, linewidth=1.6 if fine else 0.8))


def names(ax: Axes, place: Floats, parts: Sequence[Sequence[Ints]], words: Sequence[str], window: Window) -> None:
    """Write the name of each body on what the window, (x0, x1, y0, y1) in m, shows of it."""
    x0, x1, y0, y1 = window
    for b, (elements, word) in enumerate(zip(parts, words, strict=True)):
        x, y = np.concatenate([place[corners].reshape(-1, 2) for corners in elements]).T
        seen = (x > x0) & (x < x1) & (y > y0) & (y < y1)
        if seen.any():
            colour = RIMS[b % len(RIMS)]
            ax.text(
                x[seen].mean(),
                y[seen].mean(),
                word,
                color=colour,
                weight="bold",
                ha="center",
                va="center",
                bbox={"boxstyle": "round,pad=0.2", "facecolor": "white", "edgecolor": "none", "alpha": 0.85},
            )


def box(points: Floats, margin: float) -> Window:
    """Window (x0, x1, y0, y1) around points, (N, 2), with a margin as a share of its size."""
    low, high = points.min(axis=0), points.max(axis=0)
    edge = margin * max(high - low)
    return float(low[0] - edge), float(high[0] + edge), float(low[1] - edge), float(high[1] + edge)


def contact_window(places: Floats, rims: Sequence[Ints], aspect: float = 0.8) -> Window:
    """Window around the boundary nodes that come nearer to another body than an edge, at any instant.

    Parameters
    ----------
    places : (instants, N, 2), m.
    rims : boundary edges of each body.
    aspect : height over width.
    """
    near = []
    for place in places:
        for a, rim in enumerate(rims):
            nodes = place[np.unique(rim)]
            reach = np.linalg.norm(place[rim[:, 1]] - place[rim[:, 0]], axis=1).mean()
            others = [place[np.unique(other)] for b, other in enumerate(rims) if b != a]
            near += [nodes[_distance(nodes, other) < reach] for other in others]
    found = np.concatenate(near) if near else np.empty((0, 2))
    if not len(found):
        return box(places.reshape(-1, 2), 0.03)
    x0, x1, y0, y1 = box(found, 0.25)
    half = max(x1 - x0, (y1 - y0) / aspect) / 2
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    return x - half, x + half, y - aspect * half, y + aspect * half


def _distance(nodes: Floats, others: Floats) -> Floats:
    """Distance of each node to the nearest other, a few at a time to keep the table small."""
    parts = [np.linalg.norm(nodes[i : i + 256, None] - others, axis=-1).min(axis=1) for i in range(0, len(nodes), 256)]
    return np.concatenate(parts)
