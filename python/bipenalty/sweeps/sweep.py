"""A sweep: one scene, many methods, one dataset."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import xarray as xr

from bipenalty.methods import Method
from bipenalty.scene import Scene
from bipenalty.sweeps import core_batch
from bipenalty.sweeps.axes import method_axis
from bipenalty.sweeps.drive import drive
from bipenalty.sweeps.how import how
from bipenalty.sweeps.plans import Plans
from bipenalty.sweeps.work import lowered


def sweep(
    scene: Scene,
    methods: Sequence[Method],
    t_end: float,
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
    """Run a scene with each method; a failed run is a labelled entry, never an exception for the rest.

    Parameters
    ----------
    scene, dt, safety, allow_unstable : as for `Model`; the mesh is lowered once for all runs.
    methods : penalty methods.
    t_end : s, > 0.
    displacement_limit : m; a run that passes it has failed and ends there.
    histories : False for peaks only; True for contact force and penetration of every step too (16 bytes a run and
        step), a whole number for every so many steps.
    threads : how many; all processors unless given, 1 of each worker of an executor.
    executor : of concurrent.futures or alike (processes, dask's `client.get_executor()`, mpi4py); this process
        unless given. A task whose worker dies is tried again, three times in all; then its runs are "lost".
    chunk : runs of a task, which is sent to a worker and stored as one; chosen unless given.
    in_flight : tasks submitted at a time; two a worker where their number is known, else 64, unless given.
    store : path ending in .zarr or .nc. The same call goes on where one that was killed has ended, and the result is
        that of one that was not. A .zarr store is opened, not loaded; seconds are not stored.
    show_progress : None for a bar on a terminal only.
    isa : instruction set, as for `Model`: named, a run is the same to the last bit on every machine that has it.

    Returns
    -------
    Dataset over `run` (coordinates method, ps, R, D, zeta) with the peaks, `outcome` and `reason`, `failed` (ended
    before t_end by itself) and `finished` (got there, whatever its energy), and over `run` and `time` the histories,
    NaN after an early end. Attribute `memory`: bytes it was expected to take (see `sweep_memory`). Ctrl-C returns
    what there is, the rest labelled "interrupted".

    Raises
    ------
    InputError : a value out of its bounds, more memory than there is, a store that another call has made or uses.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(1, 1, 4, 4), bp.LinearElastic(900, 0, 1), velocity=(-1, 0))
    >>> wall = bp.HalfPlane("wall", point=(0, 0), normal=(1, 0))
    >>> scene = bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])
    >>> bp.sweep(scene, [bp.Stiffness(1.0), bp.Bipenalty(1.0)], t_end=0.1).sizes["run"]
    2
    """
    axis = method_axis("run", methods, "sweep")
    chosen = how(
        allow_unstable, displacement_limit, histories, threads, executor, chunk, in_flight, store, show_progress, isa
    )
    ready = lowered(scene)
    plans = Plans(ready.core, [axis], len(scene.bodies), None, t_end, dt, safety)
    # Step, state and scene are the same for all: what is wrong with one run's is wrong with the call.
    core_batch.start(
        ready.core,
        [plans.plan((0,))],
        ready.velocity,
        ready.displacement,
        allow_unstable=chosen.allow_unstable,
        displacement_limit=chosen.displacement_limit,
        every=0,
    ).check(0)
    return drive(scene, ready, plans, chosen)
