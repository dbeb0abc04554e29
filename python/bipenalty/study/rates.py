"""How fast errors fall with the mesh and with the time step, beside what theory expects."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from bipenalty import checks
from bipenalty.force_error import impulse_of
from bipenalty.methods import Bipenalty, Method
from bipenalty.model import Model
from bipenalty.result import Result
from bipenalty.scene import Scene
from bipenalty.study import errors
from bipenalty.study.case import Case

Floats = npt.NDArray[np.float64]

#: Order in h with dt in proportion, and where it is from.
EXPECTED_H = {
    "force": (1.0, "closing is seen up to dt late, and the surface layer has a mass of order h"),
    "impulse": (1.0, "the same"),
    "displacement": (1.0, "kinks on characteristics, u in H^(3/2): 3/2 times 2/3 (Brenner, Thomee, Wahlbin 1975)"),
    "energy": (1.0, "closing takes the energy of a surface layer of thickness h"),
    "penetration": (1.0, "v_n dt; with a fixed p_s the force over the penalty, 0"),
    "release": (1.0, "as the closing"),
    "half_width": (2.0, "second moment of a smooth pressure"),
    "pressure": (1.0, "square root at the edge of the contact"),
}
#: Order in dt on one mesh.
EXPECTED_DT = {
    "force": (1.0, "rows close and open at whole steps"),
    "impulse": (2.0, "central differences; a late closing gives the depth it went in back"),
    "displacement": (1.0, "the depth of a late closing while it lasts"),
}


def rates(data: xr.Dataset) -> xr.Dataset:
    """Orders of convergence in the element size, fitted for each method and share of the time step.

    Parameters
    ----------
    data : dataset of `work_precision`, at least two refinements.

    Returns
    -------
    Dataset over (method, dt, measure): rate, the slope of log error over log h with the parameter that is best on
    each mesh; wobble, its standard error; NaN with fewer than two meshes (three for the wobble). expected and why,
    over measure.

    Example
    -------
    >>> import bipenalty as bp
    >>> from bipenalty import study
    >>> data = study.work_precision(bp.exact.ThrownBar(), {"ours": bp.Bipenalty()}, [20, 40, 80, 160], repeats=1)
    >>> table = rates(data).sel({"method": "ours", "dt": "0.98 assembled", "measure": "impulse"})
    >>> bool(0.7 < table["rate"] < 1.3), float(table["expected"])
    (True, 1.0)
    """
    meshes = data["refinement"].values
    checks.within("rates", "number of refinements", len(meshes), len(meshes) > 1, ">= 2", "refine")
    names = list(EXPECTED_H)
    found = np.full((2, data.sizes["method"], data.sizes["dt"], len(names)), np.nan)
    finished = data["outcome"] == "finished"
    for k, name in enumerate(names):
        size = abs(data[name]).where(finished).min("parameter").transpose("method", "dt", "refinement").values
        for m, d in np.ndindex(size.shape[:2]):
            found[:, m, d, k] = slope(1 / meshes, size[m, d])
    return _table(found, EXPECTED_H, {"method": data["method"].values, "dt": data["dt"].values})


def rates_in_dt(
    case: Any, method: Method | None = None, refinement: int | None = None, halvings: int = 4
) -> xr.Dataset:
    """Orders of convergence in the time step on one mesh, of the distance from a run at a much smaller one.

    Parameters
    ----------
    case : a `Case`, or a benchmark of `bipenalty.exact`.
    method : the parameter-free one unless given.
    refinement : of the mesh; the middle one of the case unless given.
    halvings : of the time step, from 0.98 of the limit of the assembled mesh on, three runs to each: where within a step
        contact begins changes from run to run, and the fit averages over it. The run they are held against has an
        eighth of the smallest step.

    Returns
    -------
    Dataset over measure: rate, wobble, expected, why.

    Example
    -------
    >>> import bipenalty as bp
    >>> bool(rates_in_dt(bp.exact.ThrownBar(), refinement=20)["rate"].sel(measure="impulse") > 0.6)
    True
    """
    checks.whole("rates_in_dt", "halvings", halvings, 2, 12)
    judged = Case.of(case)
    mesh = judged.refinements[len(judged.refinements) // 2] if refinement is None else refinement
    scene = judged.scene(mesh)
    usual = Model(scene, dt="assembled").dt
    first = judged.t_end / usual / errors.PICTURES
    counts = [math.ceil(first * 2 ** (k / 3)) for k in range(3 * halvings + 1)]
    chosen = Bipenalty() if method is None else method
    finest = _run(judged, scene, chosen, 8 * counts[-1])
    shown = finest.displacement.values
    fine = replace(judged, impulse=impulse_of(finest.contact_force.values, float(finest.dt)), probes=None)
    runs = [_run(judged, scene, chosen, n) for n in sorted(set(counts))]
    steps = [float(run.dt) for run in runs]
    wrong = [[errors.of(run, fine, wanted=shown)[name] for name in EXPECTED_DT] for run in runs]
    found = np.transpose([slope(np.array(steps), row) for row in np.transpose(wrong)])
    return _table(found, EXPECTED_DT, {})


def _run(case: Case, scene: Scene, method: Method, steps: int) -> Result:
    """A run of so many steps between two pictures, so that pictures are at whole steps."""
    model = Model(scene, method, case.t_end / (steps * errors.PICTURES))
    return model.run(case.t_end, snapshots=errors.snapshots(case), show_progress=False, throw=True)


def slope(size: Floats, wrong: Floats) -> tuple[float, float]:
    """Least-squares slope of log error over log size, and its standard error; of what is finite and not zero.

    Example
    -------
    >>> order, wobble = slope(np.array([0.1, 0.05, 0.025]), np.array([0.4, 0.1, 0.025]))
    >>> round(order, 9), round(wobble, 9) + 0.0
    (2.0, 0.0)
    """
    good = np.isfinite(wrong) & (wrong > 0)
    n = int(good.sum())
    if n < 2:
        return float("nan"), float("nan")
    x, y = np.log(size[good]), np.log(wrong[good])
    x = x - x.mean()
    order = float((x * y).sum() / (x * x).sum())
    left = y - y.mean() - order * x
    return order, float(np.sqrt((left @ left) / (n - 2) / (x @ x))) if n > 2 else float("nan")


def _table(found: Floats, expected: dict[str, tuple[float, str]], coords: dict[str, Any]) -> xr.Dataset:
    """Rates beside what is expected."""
    dims = (*coords, "measure")
    data = {
        "rate": (dims, found[0], {"units": "1", "long_name": "order of convergence"}),
        "wobble": (dims, found[1], {"units": "1", "long_name": "standard error of the order"}),
        "expected": ("measure", [order for order, _ in expected.values()], {"units": "1"}),
        "why": ("measure", [why for _, why in expected.values()]),
    }
    return xr.Dataset(data, {**coords, "measure": list(expected)})
