"""A grid: one scene, every combination of what varies, one dataset with a dimension for each."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from bipenalty import checks
from bipenalty.methods import Bipenalty, Method
from bipenalty.scene import Scene
from bipenalty.sweeps.axes import parse
from bipenalty.sweeps.drive import drive
from bipenalty.sweeps.how import how
from bipenalty.sweeps.plans import Plans
from bipenalty.sweeps.work import lowered


def grid(
    scene: Scene,
    t_end: float | None,
    axes: Mapping[str, Sequence[Any]],
    method: type[Method] | Method | None = None,
    *,
    dt: str | float = "element",
    safety: float | None = None,
    allow_unstable: bool = False,
    displacement_limit: float | None = None,
    histories: bool | int = False,
    threads: int | None = None,
    executor: Any = None,
    chunk: int | None = None,
    in_flight: int | None = None,
    store: str | os.PathLike[str] | None = None,
    show_progress: bool | None = None,
    isa: str = "auto",
) -> xr.Dataset:
    """Run a scene for every combination of the values of some axes; a run that fails or cannot start is an entry.

    Parameters
    ----------
    scene : what there is.
    t_end : s; None where it is an axis.
    axes : name to values, of
        "method": methods;
        a parameter of `method`, such as "ps", "s2", "D": its values;
        "dt", "t_end": s;
        "top.young", "top.density" for a body "top": factors on its constants, -;
        "top.velocity": pairs (vx, vy), m/s, instead of its initial velocity;
        "top.offset": pairs (dx, dy), m, by which it is moved before the start.
    method : class or instance whose parameters vary, the others as they are there; `Bipenalty` unless given.
    dt : as for `Model`; a rule is taken anew for every combination of factors on young and density.
    safety, allow_unstable, displacement_limit, histories, threads, executor, chunk, in_flight, store, show_progress, isa :
        as for `sweep`.

    Returns
    -------
    Dataset with the dimensions of `axes` in their order, and the variables of `sweep`. Coordinates in SI units; a
    pair has a dimension without labels and coordinates with _x and _y appended to its name; methods have ps, R, D,
    zeta. A run that cannot start has outcome "refused" and the message as reason. Histories are over `time`, or,
    where the time step differs between runs, over `step` with `time` as a coordinate of more dimensions.

    Raises
    ------
    InputError : as for `sweep`; an axis that is not known, or that is given as a keyword too.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(1, 1, 4, 4), bp.LinearElastic(900, 0, 1), velocity=(-1, 0))
    >>> wall = bp.HalfPlane("wall", point=(0, 0), normal=(1, 0))
    >>> scene = bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])
    >>> data = bp.grid(scene, 0.1, {"ps": [0.1, 1.0, 10.0], "s2": [0.5, 1.5, 2.5]})
    >>> dict(data.sizes), data.outcome.sel(ps=1.0, s2=2.5).item()
    ({'ps': 3, 's2': 3}, 'refused')
    """
    chosen = how(
        allow_unstable, displacement_limit, histories, threads, executor, chunk, in_flight, store, show_progress, isa
    )
    ready = lowered(scene)
    listed: Any = axes  # whatever the caller has put there
    named = listed if isinstance(listed, Mapping) else {}
    given = {"method": method is not None, "t_end": t_end is not None, "dt": dt != "element"}
    twice = [name for name, there in given.items() if there and name in named]
    checks.within("grid", "given as axis and as argument", twice, not twice, "one of the two", "leave one out")
    varied: Any = method
    if varied is None and "method" not in named:
        varied = Bipenalty
    plans = Plans(ready.core, parse(axes, scene, varied), len(scene.bodies), varied, t_end, dt, safety)
    return drive(scene, ready, plans, chosen)
