"""What the figures share: colours, one look a method, causes of failure in a few words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from bipenalty import checks

#: Told apart with any common colour blindness and in print (Okabe and Ito 2008), the strongest first.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")
#: Width of a figure, inches: 900 pixels at dpi = 100.
WIDTH = 9.0


def dataset(source: Any) -> xr.Dataset:
    """The dataset of a `Result`, or the dataset itself."""
    found = getattr(source, "dataset", source)
    checks.within(
        "plot",
        "what to draw",
        type(source).__name__,
        isinstance(found, xr.Dataset),
        "a Result or an xarray.Dataset",
        "give what run or sweep returned",
    )
    return found  # type: ignore[no-any-return]


def labels(sweep: xr.Dataset, methods: Sequence[str] | None) -> list[str]:
    """Labels of the methods to draw, in the order given or else in that of the sweep."""
    known = list(dict.fromkeys(map(str, sweep["method"].values)))
    for method in methods or ():
        checks.within(
            "plot",
            "method",
            repr(method),
            method in known,
            f"one of {', '.join(map(repr, known))}",
            "choose among the sweep's labels",
        )
    return list(methods) if methods is not None else known


def looks(methods: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Line style of each label: the family by dash and marker, its damping by colour.

    >>> looks(["bipenalty", "bipenalty (D = 0.01)"])["bipenalty (D = 0.01)"]["color"]
    '#0072B2'
    """
    found: dict[str, dict[str, Any]] = {}
    dampings = [""]
    for label in methods:
        family, _, damping = label.partition(" ")
        if damping not in dampings:
            dampings.append(damping)
        colour = COLOURS[dampings.index(damping) % len(COLOURS)]
        lines: dict[str, Any] = {"linestyle": "-", "marker": "o"}
        if family == "stiffness":
            lines = {"linestyle": (0, (4, 1.5)), "marker": "s", "markerfacecolor": "white"}
        found[label] = {"color": colour, "linewidth": 1.7, "markersize": 4.0, **lines}
    return found


def own_figure(figure: Figure | SubFigure | None, width: float, height: float) -> Figure | SubFigure:
    """The figure to draw into: a new one, outside pyplot, unless given."""
    return Figure(figsize=(width, height), layout="constrained") if figure is None else figure


def whole(part: Axes | Figure | SubFigure) -> Figure:
    """The figure that a part belongs to."""
    figure = part if isinstance(part, Figure) else part.figure
    return figure if isinstance(figure, Figure) else whole(figure)


def grid(ax: Axes) -> None:
    """A grid behind the lines, and no frame where nothing is read off."""
    ax.grid(color="0.88", linewidth=0.7)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
