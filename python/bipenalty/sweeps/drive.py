"""The drive of a sweep: what is computed, in which blocks, into which store, within which memory."""

from __future__ import annotations

import math
import uuid
from typing import Any

import xarray as xr

from bipenalty import checks
from bipenalty.result_dataset import package_version
from bipenalty.scene import Scene
from bipenalty.sweeps import memory
from bipenalty.sweeps.dataset import coordinates, steps_over
from bipenalty.sweeps.fill import Store, fill
from bipenalty.sweeps.fingerprint import fingerprint
from bipenalty.sweeps.how import How
from bipenalty.sweeps.layout import Layout, block_shape
from bipenalty.sweeps.plans import Plans
from bipenalty.sweeps.store_memory import MemoryStore
from bipenalty.sweeps.store_netcdf import NetcdfStore
from bipenalty.sweeps.store_zarr import ZarrStore
from bipenalty.sweeps.work import Lowered, Options

#: Tasks that a sweep is cut into at least when they are to be shared out or stored.
TASKS = 64


def drive(scene: Scene, lowered: Lowered, plans: Plans, how: How) -> xr.Dataset:
    """Do all runs of a sweep, or those that its store does not have, and return the dataset.

    Raises
    ------
    InputError : more memory than there is, a store of another call or in use.
    """
    dts, longest, mean = steps_over(plans)
    shape = tuple(len(axis.values) for axis in plans.axes)
    samples = memory.samples(longest, how.every)
    attrs = _attributes(plans, how, dts)
    kind = _kind(how)
    chunk = how.chunk or _chunk(scene.n_nodes, math.prod(shape), longest, how)
    if how.store is not None:
        names = [axis.dim for axis in plans.axes if "/" in axis.dim]
        checks.within("sweep", "axis", names, not names, 'without "/" in a store', "rename the body")
        spec = (plans.axes, plans.method, plans.t_end, plans.dt, plans.safety, how.allow_unstable, how.isa)
        attrs["fingerprint"] = fingerprint(scene, *spec, attrs)
        # Blocks are what they were when the store was made.
        chunk = attrs["chunk"] = kind.chunk_of(how.store) or chunk
    room: dict[str, Any] = {
        "histories": how.every,
        "chunk": chunk,
        "in_flight": how.in_flight or 0,
        "stored": kind is ZarrStore,
    }
    needed = memory.sweep_memory(scene, math.prod(shape), max(1, longest), **room)
    memory.check_memory(needed)
    dims, time_dim = tuple(axis.dim for axis in plans.axes), "step" if plans.step_axes else "time"
    layout = Layout(dims, shape, block_shape(shape, chunk), samples, time_dim)
    store: Store = kind(layout, coordinates(plans, layout, dts, how.every), attrs, how.store)
    options = Options(
        how.allow_unstable,
        how.displacement_limit,
        how.every,
        samples,
        how.threads,
        package_version(),
        uuid.uuid4().hex,
        how.isa,
    )
    with store.opened():
        lost, interrupted = fill(store, plans, scene, lowered, options, how, mean)
        data = store.finish(lost, "interrupted")
    # Of this call, not of its result: they are not stored.
    data.attrs |= {"memory": needed, "interrupted": int(interrupted)}
    return data


def _kind(how: How) -> Any:
    if how.store is None:
        return MemoryStore
    return ZarrStore if how.store.suffix == ".zarr" else NetcdfStore


def _chunk(nodes: int, runs: int, steps: int, how: How) -> int:
    shared = how.executor is not None
    tasks = TASKS if shared or how.store is not None else 1
    return memory.default_chunk(nodes, runs, steps, how.every, tasks=tasks, threads=0 if shared else how.threads)


def _attributes(plans: Plans, how: How, dts: Any) -> dict[str, Any]:
    """What all runs have in common: dt and t_end in s where they do."""
    attrs: dict[str, Any] = {} if plans.step_axes else {"dt": float(dts)}
    attrs |= {"critical_dt": plans.core.critical_dt}
    attrs |= {} if plans.t_end is None else {"t_end": plans.t_end}
    limit = math.inf if how.displacement_limit is None else how.displacement_limit
    return attrs | {"displacement_limit": limit, "every": how.every, "version": package_version()}
