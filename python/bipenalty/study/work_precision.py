"""Speed against accuracy: every method, parameter, mesh and time step of a case, its errors and what it cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from bipenalty import checks, progress
from bipenalty.methods import Method
from bipenalty.study import errors, timing, trials
from bipenalty.study.case import FACTORS, Case
from bipenalty.study.lineup import Candidate, lineup, takes_ps

#: Time steps by name: the limit and the share of it. The first is that of the published set-up.
DTS = {"0.5 element": ("element", 0.5), "0.9 element": ("element", 0.9), "0.98 assembled": ("assembled", 0.98)}

DIMS = ("method", "parameter", "refinement", "dt")
#: What is counted or timed of a run: unit and words.
COSTS = {
    "seconds": ("s", "processor time of the steps, median of the repeats"),
    "spread": ("1", "half of the range between the quartiles over the median of the seconds"),
    "repeats": ("1", "how often it was timed"),
    "steps": ("1", "steps taken"),
    "node_steps": ("1", "nodes times steps"),
    "row_steps": ("1", "active rows, summed over the steps"),
    "block_operations": ("1", "operations in the mass block"),
}


def work_precision(
    case: Any,
    methods: Mapping[str, Candidate] | None = None,
    refinements: Sequence[int] | None = None,
    dts: Mapping[str, tuple[str, float]] | None = None,
    factors: Sequence[float] = FACTORS,
    repeats: int = 5,
    show_progress: bool | None = None,
) -> xr.Dataset:
    """Run a case with each method, p_s, mesh and time step: errors against its answer, time and operation counts.

    Parameters
    ----------
    case : a `Case`, or a benchmark of `bipenalty.exact`.
    methods : by name, a method or, for one with a parameter, a function of p_s; `lineup()` unless given.
    refinements : meshes; those of the case unless given.
    dts : by name, ("element" or "assembled", share of that limit); `DTS` unless given.
    factors : p_s of the methods with a parameter.
    repeats : rounds in which each mesh and time step is timed with every method, one after the other, so that what
        slows the machine slows all alike. Of a method with a parameter, the best by any measure are timed; the other
        factors have their operation counts, and the time per step of the best.
    show_progress : None for a bar on a terminal only.

    Returns
    -------
    Dataset over (method, parameter, refinement, dt): the `errors.MEASURES` (-), NaN for runs that stopped early; the
    `COSTS`; outcome ("not run" for a method without a parameter after its first), reason; ps, the value of each
    parameter; step (s), nodes and setup_seconds of making the model, over (refinement, dt). Attributes tell the case.

    Raises
    ------
    InputError : a wrong case, no methods, a refinement the scene does not take.

    Example
    -------
    >>> import bipenalty as bp
    >>> methods = {"parameter-free": bp.Bipenalty(), "stiffness": bp.Stiffness}
    >>> data = work_precision(bp.exact.ThrownBar(), methods, [10, 20], factors=[1.0, 10.0], repeats=1)
    >>> dict(data.sizes) == {"method": 2, "parameter": 2, "refinement": 2, "dt": 3}
    True
    >>> str(data["outcome"].sel({"method": "stiffness", "refinement": 20, "dt": "0.98 assembled"}).values[1])
    'spectral instability'
    """
    judged = Case.of(case)
    chosen = lineup() if methods is None else dict(methods)
    checks.within("work_precision", "number of methods", len(chosen), len(chosen) > 0, ">= 1", "name one")
    meshes = judged.refinements if refinements is None else tuple(refinements)
    checks.within("work_precision", "number of refinements", len(meshes), len(meshes) > 0, ">= 1", "name one")
    steps = DTS if dts is None else dict(dts)
    checks.whole("work_precision", "repeats", repeats, 1)
    tried = {name: _made(candidate, factors) for name, candidate in chosen.items()}
    width = max(map(len, tried.values()))
    data = _empty(chosen, factors, width, meshes, steps)
    with progress.bar(len(meshes) * len(steps), "setting", judged.name, show_progress) as bar:
        for (r, refinement), (d, (limit, share)) in product(enumerate(meshes), enumerate(steps.values())):
            _setting(data, (r, d), judged, refinement, (limit, share), tried, repeats)
            bar.update(1)
    about = {"case": judged.name, "answer": judged.answer, "width": judged.width, "length": judged.length}
    known = {f"uncertainty_{measure}": value for measure, value in judged.uncertainty.items()}
    return data.assign_attrs(about | known | {"t_end": judged.t_end})


def _setting(
    data: xr.Dataset,
    at: tuple[int, int],
    case: Case,
    refinement: int,
    limit: tuple[str, float],
    tried: Mapping[str, Sequence[Method]],
    repeats: int,
) -> None:
    """All methods on one mesh at one time step."""
    scene = case.scene(refinement)
    setup, dt = timing.setup(scene, limit, repeats)
    data["setup_seconds"].values[at], data["step"].values[at], data["nodes"].values[at[0]] = setup, dt, scene.n_nodes
    found = trials.run_all(case, scene, dt, [method for methods in tried.values() for method in methods])
    keys = [(m, p) for m, methods in enumerate(tried.values()) for p in range(len(methods))]
    flat = [method for methods in tried.values() for method in methods]
    for name in found[0]:
        values = data[name].values
        for key, trial in zip(keys, found, strict=True):
            values[(*key, *at)] = trial[name]
    runs: dict[tuple[int, int], tuple[Method, int]] = {}
    for m in range(len(tried)):
        mine = [i for i, key in enumerate(keys) if key[0] == m]
        runs |= {keys[mine[p]]: (flat[mine[p]], int(found[mine[p]]["steps"])) for p in _best([found[i] for i in mine])}
    samples = timing.interleaved(scene, dt, runs, repeats)
    seconds, spread, times = (data[name].values for name in ("seconds", "spread", "repeats"))
    for (m, p), trial in zip(keys, found, strict=True):
        if (m, p) in samples:
            lower, median, upper = np.percentile(samples[m, p], [25, 50, 75])
            seconds[(m, p, *at)], spread[(m, p, *at)] = median, (upper - lower) / 2 / median
            times[(m, p, *at)] = repeats
        else:  # the time per step of those of its method that were timed
            steps = [np.median(taken) / runs[key][1] for key, taken in samples.items() if key[0] == m]
            seconds[(m, p, *at)], times[(m, p, *at)] = np.median(steps) * trial["steps"], 0


def _made(candidate: Any, factors: Sequence[float]) -> list[Method]:
    """The methods to run: one for each factor if it takes one."""
    return [candidate(ps) for ps in factors] if takes_ps(candidate) else [candidate]


def _best(found: Sequence[Mapping[str, Any]]) -> list[int]:
    """Parameters with which a method is best in any measure; the first if nothing reached the end."""
    best = set[int]()
    for measure in ("force", "impulse", "displacement", "half_width"):
        values = [trial[measure] for trial in found]
        if np.isfinite(values).any():
            best.add(int(np.nanargmin(values)))
    return sorted(best) or [0]


def _empty(
    methods: Mapping[str, Candidate],
    factors: Sequence[float],
    width: int,
    meshes: Sequence[int],
    dts: Mapping[str, tuple[str, float]],
) -> xr.Dataset:
    """The dataset before the first run."""
    shape = (len(methods), width, len(meshes), len(dts))
    about = {name: ("1", words) for name, words in errors.MEASURES.items()} | COSTS
    data: dict[str, Any] = {
        name: (DIMS, np.full(shape, np.nan), {"units": unit, "long_name": words})
        for name, (unit, words) in about.items()
    }
    data["outcome"] = (DIMS, np.full(shape, "not run", dtype=object), {"long_name": "how the run ended"})
    data["reason"] = (DIMS, np.full(shape, "", dtype=object), {"long_name": "why"})
    for name, unit, words in (("step", "s", "time step"), ("setup_seconds", "s", "processor time of making the model")):
        data[name] = (DIMS[2:], np.full(shape[2:], np.nan), {"units": unit, "long_name": words})
    data["nodes"] = (DIMS[2:3], np.full(shape[2:3], np.nan), {"units": "1", "long_name": "nodes of the scene"})
    ps = np.full(shape[:2], np.nan)
    for m, each in enumerate(methods.values()):
        if takes_ps(each):
            ps[m] = list(factors)
    data["ps"] = (DIMS[:2], ps, {"units": "1", "long_name": "stiffness penalty factor"})
    return xr.Dataset(data, {"method": list(methods), "refinement": list(meshes), "dt": list(dts)})
