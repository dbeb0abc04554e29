"""What surrounds the arrays of a sweep: coordinates, attributes, and labels for runs that were not computed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from bipenalty.errors import InputError
from bipenalty.methods.method import Method, penalty_factor
from bipenalty.result_dataset import method_attributes
from bipenalty.sweeps.axes import PARAMETERS, Axis
from bipenalty.sweeps.layout import PENDING, Layout
from bipenalty.sweeps.plans import Plans, steps_to

Coordinates = dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]


def steps_over(plans: Plans) -> tuple[np.ndarray[Any, np.dtype[np.float64]], int, float]:
    """Time step (s) over the axes it differs along, NaN where refused; most steps of a run; mean steps of a run."""
    dts = np.full([len(plans.axes[i].values) for i in plans.step_axes], np.nan)
    ends = [plans.t_end] if plans.t_end is not None else plans.axes[plans.axes_of("t_end")[0]].values
    counts = []
    for place in np.ndindex(dts.shape):
        index = [0] * len(plans.axes)
        for i, at in zip(plans.step_axes, place, strict=True):
            index[i] = at
        try:
            dts[place] = plans.step_of(tuple(index))
        except InputError:
            counts.append(0)
            continue
        counts += [_steps(end, float(dts[place])) for end in ends]
    return dts, max(counts), sum(counts) / len(counts)


def _steps(end: float, dt: float) -> int:
    try:
        return steps_to(end, dt) if 0 < end < math.inf else 0
    except InputError:
        return 0


def coordinates(plans: Plans, layout: Layout, dts: Any, every: int) -> Coordinates:
    """Coordinates of a grid: name to (dimensions, values, attributes), SI units."""
    dt_dims = tuple(plans.axes[i].dim for i in plans.step_axes)
    found: Coordinates = {}
    for axis in plans.axes:
        found |= _of_axis(axis, dts, dt_dims)
    if dt_dims and "dt" not in found:
        found["dt"] = (dt_dims, dts, {"units": "s", "long_name": "time step"})
    if layout.samples:
        kept = np.arange(layout.samples) * every
        if dt_dims:
            found["step"] = (("step",), kept, {"units": "1", "long_name": "step"})
        times = dts[..., None] * kept if dt_dims else kept * float(dts)
        found["time"] = ((*dt_dims, layout.time_dim), times, {"units": "s", "long_name": "time"})
    return found


def _of_axis(axis: Axis, dts: Any, dt_dims: tuple[str, ...]) -> Coordinates:
    about = {"units": axis.units, "long_name": axis.long_name}
    if axis.is_vector:
        ends = zip("xy", np.array(axis.values, dtype=float).T, strict=True)
        return {
            f"{axis.dim}_{e}": ((axis.dim,), v, about | {"long_name": f"{about['long_name']}, {e}"}) for e, v in ends
        }
    if axis.kind != "method":
        return {axis.dim: ((axis.dim,), _values(axis.values), about)}
    found: Coordinates = {"method": ((axis.dim,), _values([m.label for m in axis.values]), {"long_name": "method"})}
    labels = [[_attributes(m, dt) for dt in np.ravel(dts).tolist()] for m in axis.values]
    for name in ("ps", "R", "D", "zeta"):
        units, long_name = PARAMETERS[name]
        table = np.array([[label[name] for label in row] for row in labels])
        found[name] = ((axis.dim, *dt_dims), table.reshape(-1, *dts.shape), {"units": units, "long_name": long_name})
    ps = [penalty_factor(m) for m in axis.values]  # the only one that no time step changes
    found["ps"] = ((axis.dim,), np.array(ps), found["ps"][2])
    return found


def _attributes(method: Method, dt: float) -> dict[str, Any]:
    return method_attributes(method, dt) if dt > 0 else dict.fromkeys(("ps", "R", "D", "zeta"), math.nan)


def _values(values: Any) -> Any:
    numbers = all(isinstance(v, float) for v in values)
    return np.array(values, dtype=float) if numbers else np.array([str(v) for v in values], dtype=object)


def label_rest(data: xr.Dataset, layout: Layout, lost: Mapping[int, str], rest: str) -> xr.Dataset:
    """The dataset with the runs that were not computed labelled "lost", with the reason, or `rest`."""
    outcome = np.array(data["outcome"].values.tolist(), dtype=object).reshape(layout.shape)
    reason = np.array(data["reason"].values.tolist(), dtype=object).reshape(layout.shape)
    failed = data["failed"].values.copy()
    for task, why in lost.items():
        region = layout.region(task)
        outcome[region], reason[region], failed[region] = "lost", why, True
    pending = outcome == PENDING
    outcome[pending] = rest
    changed = {"outcome": outcome, "reason": reason, "failed": failed}
    if pending.any():
        changed["steps"] = np.where(pending, 0.0, data["steps"].values)
    return data.assign({name: data[name].copy(data=values) for name, values in changed.items()})
