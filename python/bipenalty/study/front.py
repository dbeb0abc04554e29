"""The Pareto front of speed and accuracy, and how far a method is from it."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from bipenalty import checks

Floats = npt.NDArray[np.float64]

#: Errors at which a front is compared, spread evenly over its range on a logarithmic scale.
SAMPLES = 50


def values_of(data: xr.Dataset, error: str, cost: str) -> tuple[Floats, Floats]:
    """Cost and size of the error of every run, flat; infinite where a run did not finish or has no number.

    Raises
    ------
    InputError : an error or a cost that the dataset does not have.
    """
    for kind, name in (("error", error), ("cost", cost)):
        known = [str(each) for each in data.data_vars if data[each].dims == data["outcome"].dims]
        checks.within("study", kind, repr(name), name in known, f"one of {', '.join(known)}", "choose among them")
    finished = (data["outcome"] == "finished").values.ravel()
    spent, wrong = data[cost].values.ravel().astype(float), np.abs(data[error].values.ravel().astype(float))
    good = finished & np.isfinite(spent) & np.isfinite(wrong) & (spent > 0)
    return np.where(good, spent, np.inf), np.where(good, wrong, np.inf)


def pareto(data: xr.Dataset, error: str = "impulse", cost: str = "seconds") -> xr.DataArray:
    """Which runs no other one beats in both error and cost; of two alike both are on the front.

    Parameters
    ----------
    data : dataset of `work_precision`.
    error : one of its measures; its size counts.
    cost : "seconds", "node_steps", "row_steps", ...

    Returns
    -------
    Booleans in the shape of the runs; False for runs that did not finish.

    Example
    -------
    >>> runs = {"outcome": ("run", ["finished"] * 3), "impulse": ("run", [0.1, 0.02, 0.03])}
    >>> pareto(xr.Dataset({**runs, "seconds": ("run", [1.0, 2.0, 3.0])})).values
    array([ True,  True, False])
    """
    spent, wrong = values_of(data, error, cost)
    return data["outcome"].copy(data=_front(spent, wrong).reshape(data["outcome"].shape)).astype(bool)


def _front(spent: Floats, wrong: Floats) -> npt.NDArray[np.bool_]:
    """Those that none is at least as good as in both and better in one."""
    found = np.zeros(len(spent), dtype=bool)
    good = np.flatnonzero(np.isfinite(spent) & np.isfinite(wrong))
    order = good[np.lexsort((wrong[good], spent[good]))]
    # In this order a run is beaten only by one before it; those that are alike stand side by side.
    least = np.minimum.accumulate(np.concatenate([[np.inf], wrong[order]]))[:-1]
    alike = np.concatenate([[False][: len(order)], (np.diff(spent[order]) == 0) & (np.diff(wrong[order]) == 0)])
    on = wrong[order] < least
    for i in np.flatnonzero(alike):
        on[i] = on[i - 1]
    found[order] = on
    return found


def line(spent: Floats, wrong: Floats) -> tuple[Floats, Floats]:
    """Logarithms of cost and error along the front, the cheapest first; errors no smaller than 1e-12 count."""
    on = _front(spent, wrong)
    pairs = np.unique(np.column_stack([np.log(spent[on]), np.log(np.maximum(wrong[on], 1e-12))]), axis=0)
    return pairs[:, 0], pairs[:, 1]


def cost_at(data: xr.Dataset, accuracy: float, error: str = "impulse", cost: str = "seconds") -> xr.DataArray:
    """What an accuracy costs with each method, at its best settings.

    Parameters
    ----------
    data : dataset of `work_precision`.
    accuracy : error that is allowed, > 0.
    error, cost : names in the dataset.

    Returns
    -------
    Over method, in the unit of the cost: along the method's own front between its runs, straight in logarithms; what
    its cheapest run costs where that is better than need be; NaN where no run is as good.

    Example
    -------
    >>> runs = {"outcome": ("run", ["finished"] * 2), "impulse": ("run", [0.1, 0.001]), "seconds": ("run", [1.0, 100.0])}
    >>> float(cost_at(xr.Dataset(runs).expand_dims(method=["only"]), 0.01).round(9)[0])
    10.0
    """
    checks.within("cost_at", "accuracy", accuracy, 0 < accuracy < np.inf, "> 0 and finite", "give an error, e.g. 0.02")
    found = [float(np.exp(_along(*line(*values_of(part, error, cost)), np.log(accuracy)))) for _, part in each(data)]
    return xr.DataArray(found, {"method": data["method"].values}, ["method"], cost, {"accuracy": accuracy})


def distance_to_front(data: xr.Dataset, error: str = "impulse", cost: str = "seconds") -> xr.Dataset:
    """How far each method is from the front of all: ratio of costs at equal error, and of errors at equal cost.

    Parameters
    ----------
    data : dataset of `work_precision`.
    error, cost : names in the dataset.

    Returns
    -------
    Over method: cost_ratio and error_ratio, each the geometric mean over the range of the method's own front, and
    least_ and largest_ of either; 1 on the front, NaN for a method of which no run finished.

    The front of each method is straight between its runs on logarithmic scales, that of all the best of theirs. A
    method's range is that from its cheapest to its most accurate run.

    Example
    -------
    >>> runs = {"outcome": (("method", "run"), [["finished"] * 2] * 2),
    ...         "impulse": (("method", "run"), [[0.1, 0.01], [0.1, 0.01]]),
    ...         "seconds": (("method", "run"), [[1.0, 10.0], [2.0, 20.0]])}
    >>> distance_to_front(xr.Dataset(runs, {"method": ["fast", "slow"]}))["cost_ratio"].values.round(9)
    array([1., 2.])
    """
    lines = [line(*values_of(part, error, cost)) for _, part in each(data)]
    names = [f"{which}{what}" for what in ("cost_ratio", "error_ratio") for which in ("", "least_", "largest_")]
    found = {name: np.full(len(lines), np.nan) for name in names}
    there = [one for one in lines if len(one[0])]
    for m, (costs, errors) in enumerate(lines):
        if len(costs) == 0:
            continue
        levels = np.linspace(errors.min(), errors.max(), SAMPLES)
        budgets = np.linspace(costs.min(), costs.max(), SAMPLES)
        more = _along(costs, errors, levels) - np.nanmin([_along(*other, levels) for other in there], axis=0)
        worse = _within(costs, errors, budgets) - np.nanmin([_within(*other, budgets) for other in there], axis=0)
        for what, ratio in (("cost_ratio", more), ("error_ratio", worse)):
            for which, value in (("", ratio.mean()), ("least_", ratio.min()), ("largest_", ratio.max())):
                found[f"{which}{what}"][m] = np.exp(value)
    return xr.Dataset({name: ("method", row) for name, row in found.items()}, {"method": data["method"].values})


def each(data: xr.Dataset) -> list[tuple[int, xr.Dataset]]:
    """The runs of each method."""
    return [(m, data.isel(method=[m])) for m in range(data.sizes["method"])]


def _along(costs: Floats, errors: Floats, levels: Any) -> Any:
    """Logarithm of the cost of an error along a front; NaN below its least error, the cheapest above its largest."""
    if len(costs) == 0:
        return np.full(np.shape(levels), np.nan)
    found = np.interp(levels, errors[::-1], costs[::-1])
    return np.where(np.asarray(levels) < errors[-1] - 1e-12, np.nan, found)


def _within(costs: Floats, errors: Floats, budgets: Any) -> Any:
    """Logarithm of the error that a cost buys; NaN below the cheapest run, the least error above the dearest."""
    return np.where(np.asarray(budgets) < costs[0] - 1e-12, np.nan, np.interp(budgets, costs, errors))
