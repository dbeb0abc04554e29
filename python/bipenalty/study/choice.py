"""The best setting for a wanted accuracy, in words."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from bipenalty import checks
from bipenalty.study.front import cost_at, values_of


def best_for(data: xr.Dataset, accuracy: float, error: str = "impulse", cost: str = "seconds") -> str:
    """The cheapest run with an error no larger than wanted, as a sentence; of two as cheap, one without a parameter.

    Parameters
    ----------
    data : dataset of `work_precision`.
    accuracy : error that is allowed, > 0.
    error, cost : names in the dataset.

    Example
    -------
    >>> import bipenalty as bp
    >>> from bipenalty import study
    >>> data = study.work_precision(bp.exact.ThrownBar(), {"ours": bp.Bipenalty()}, [20, 40], repeats=1)
    >>> study.best_for(data, 0.04, cost="node_steps").split(":")[0]
    'thrown bar, impulse to 4 %'
    >>> study.best_for(data, 1e-6).split(";")[0]
    'thrown bar, impulse to 0.0001 %: no run is as accurate'
    """
    checks.within("best_for", "accuracy", accuracy, 0 < accuracy < np.inf, "> 0 and finite", "give an error, e.g. 0.02")
    spent, wrong = values_of(data, error, cost)
    head = f"{data.attrs.get('case', 'study')}, {error} to {100 * accuracy:.3g} %"
    good = np.flatnonzero(wrong <= accuracy)
    if len(good) == 0:
        if not np.isfinite(wrong).any():
            return f"{head}: no run is as accurate; none has finished with such an error"
        closest = int(wrong.argmin())
        return f"{head}: no run is as accurate; the closest is {setting(data, closest)}, {100 * wrong[closest]:.2g} %"
    ps = np.broadcast_to(data["ps"].values[:, :, None, None], data["outcome"].shape).ravel()
    best = int(min(good, key=lambda i: (spent[i], bool(np.isfinite(ps[i])), wrong[i])))
    words = f"{head}: {setting(data, best)}, {amount(spent[best], cost)}, error {100 * wrong[best]:.2g} %"
    name = str(data["method"].values[np.unravel_index(best, data["outcome"].shape)[0]])
    others = cost_at(data, accuracy, error, cost)
    others = others.isel(method=[str(m) != name for m in others["method"].values]).dropna("method")
    if others.size:
        own = float(cost_at(data, accuracy, error, cost).sel({"method": name}))
        next_best = others.isel(method=int(np.argmin(others.values)))
        words += (
            f"; next, {next_best['method'].values}, at {float(next_best) / own:.2f} times the cost of that accuracy"
        )
    return words


def setting(data: xr.Dataset, run: int) -> str:
    """Method, parameter, mesh and time step of a run, by its place in the flat order."""
    m, p, r, d = np.unravel_index(run, data["outcome"].shape)
    ps = float(data["ps"][m, p])
    factor = "" if np.isnan(ps) else f" with p_s = {ps:.3g}"
    step = f"dt = {float(data['step'][r, d]):.3g} s ({data['dt'].values[d]} limit)"
    return f"{data['method'].values[m]}{factor}, refinement {data['refinement'].values[r]}, {step}"


def amount(value: Any, cost: str) -> str:
    """A cost with its unit."""
    return f"{1000 * value:.3g} ms" if cost == "seconds" else f"{value:.3g} {cost.replace('_', ' ')}"
