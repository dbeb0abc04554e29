"""How far a contact force is from the one it should be: moving averages, relative errors, closures.

Node by node the force of any method is noisy at the scale of the mesh, and so is a converged one. What bodies feel
is the impulse; errors are therefore taken of moving averages, and those from the cumulated impulse, so that forces
sampled at different time steps compare.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from bipenalty import checks

Floats = npt.NDArray[np.float64]

#: Cumulated impulse (N s/m) at times (s).
Impulse = Callable[[Floats], Floats]

#: Instants at which averages are compared, per width of the average.
SAMPLES = 10
#: A contact is over when this share of its impulse has been given: the last, weak touches of a mesh do not count.
GIVEN = 0.99


def impulse_of(force: Any, dt: float) -> Impulse:
    """Impulse cumulated by a sampled force, as a function of time.

    Parameters
    ----------
    force : (n,), N/m, at t_n = n dt.
    dt : s, > 0.

    In central differences the force of t_n acts from t_{n-1/2} to t_{n+1/2}: in between the impulse is linear. It is
    constant before and after.

    Raises
    ------
    InputError : a force of another shape than (n,), n >= 1, or not finite; dt out of its bounds.

    Example
    -------
    >>> impulse_of([300.0, 300.0], dt=0.5)(np.array([-1.0, 0.25, 9.0]))
    array([  0., 150., 300.])
    """
    values = np.asarray(force, dtype=np.float64)
    shape, finite = values.shape, bool(np.isfinite(values).all())
    checks.within("impulse_of", "shape of force", shape, len(shape) == 1 and shape[0] > 0, "(n,)", "give one run")
    checks.within("impulse_of", "force", "nan or inf", finite, "finite", "leave out runs that stopped early")
    checks.within("impulse_of", "dt", dt, 0 < dt < np.inf, "> 0 and finite", "give seconds")
    instants = (np.arange(len(values) + 1) - 0.5) * dt
    cumulated = np.concatenate([[0.0], np.cumsum(values) * dt])
    return lambda t: np.interp(t, instants, cumulated)


def moving_average(impulse: Impulse, width: float, at: Any) -> Floats:
    """Force (N/m) averaged over `width` (s), centred at the times `at` (s): the impulse gained over the width.

    Example
    -------
    >>> moving_average(lambda t: 300 * t, width=1e-3, at=[0.1, 0.2]).round(9)
    array([300., 300.])
    """
    checks.within("moving_average", "width", width, 0 < width < np.inf, "> 0 and finite", "give seconds")
    centres = np.asarray(at, dtype=np.float64)
    return (impulse(centres + width / 2) - impulse(centres - width / 2)) / width


def relative_error(values: Any, reference: Any) -> float:
    """||values - reference|| / ||reference|| in the L2 norm of equally spaced samples, -.

    Example
    -------
    >>> relative_error([3.0, 5.0], [3.0, 4.0])
    0.2
    """
    difference = np.asarray(values, dtype=np.float64) - np.asarray(reference, dtype=np.float64)
    return float(np.linalg.norm(difference) / np.linalg.norm(reference))


def force_error(force: Any, dt: float, reference: Impulse, width: float) -> float:
    """Relative L2 error of a force after a moving average, -, over the time it was sampled.

    Parameters
    ----------
    force : (n,), N/m, at t_n = n dt.
    dt : s.
    reference : impulse that should have been cumulated, N s/m: exact, or `impulse_of` a converged run.
    width : of the average, s.

    Example
    -------
    >>> round(force_error([0.0, 110.0, 110.0, 0.0], 0.5, impulse_of([0.0, 100.0, 100.0, 0.0], 0.5), 0.5), 6)
    0.1
    """
    at = np.linspace(0.0, len(force) * dt, max(2, round(SAMPLES * len(force) * dt / width)))
    got, wanted = (moving_average(impulse, width, at) for impulse in (impulse_of(force, dt), reference))
    return relative_error(got, wanted)


def closures(force: Any) -> int:
    """How often contact closes: changes from no force to some.

    Example
    -------
    >>> closures([0.0, 2.0, 0.0, 0.0, 1.0, 1.0])
    2
    """
    touching = np.concatenate([[False], np.asarray(force) != 0])
    return int(np.count_nonzero(touching[1:] & ~touching[:-1]))


def released(impulse: Impulse, until: float) -> float:
    """When 99 % of the impulse up to `until` (s) has been given for good, s; NaN if there was none.

    Example
    -------
    >>> round(released(lambda t: np.clip(t - 1.0, 0, 1), until=5.0), 2)
    1.99
    """
    t = np.linspace(0, until, 20_000)
    share = impulse(t)
    below = np.flatnonzero(share < GIVEN * share[-1])
    return float(t[below[-1]]) if share[-1] > 0 else float("nan")


def of_sweep(sweep: xr.Dataset, reference: Impulse, width: float) -> xr.Dataset:
    """What the runs of a sweep got wrong.

    Parameters
    ----------
    sweep : dataset of `bipenalty.sweep` with histories of every step.
    reference : impulse that should have been cumulated, N s/m.
    width : of the moving average, s.

    Returns
    -------
    Dataset over `run`: force_error (-), impulse_error (-), closures; NaN for runs that stopped early.

    Raises
    ------
    InputError : a sweep without histories, or with some steps left out.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(10, 1, 20, 1), bp.LinearElastic(900, 0, 1), velocity=(-10, 0))
    >>> wall = bp.HalfPlane("wall", point=(-5, 0), normal=(1, 0))
    >>> scene = bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])
    >>> sweep = bp.sweep(scene, [bp.Bipenalty()], t_end=2.0, histories=True)
    >>> exact = lambda t: 300 * np.clip(t - 0.5, 0, 2 / 3)  # rho c v for as long as the wave takes there and back
    >>> errors = of_sweep(sweep, exact, width=0.5 / 30)
    >>> bool(errors["force_error"][0] < 0.15), int(errors["closures"][0])
    (True, 1)
    """
    kept = sweep.attrs.get("every", 1) if "contact_force" in sweep else "none"
    checks.within("of_sweep", "histories", kept, kept == 1, "of every step", "run sweep(..., histories=True)")
    dt = float(sweep.attrs["dt"])
    found = np.full((3, sweep.sizes["run"]), np.nan)
    for i in np.flatnonzero(~sweep["failed"].values):
        force = sweep["contact_force"].values[i]
        gained = float(np.diff(reference(np.array([0.0, len(force) * dt])))[0])
        found[:, i] = force_error(force, dt, reference, width), dt * force.sum() / gained - 1, closures(force)
    about = {
        "force_error": "relative L2 error of the force after a moving average",
        "impulse_error": "relative error of the impulse",
        "closures": "how often contact closes",
    }
    data = {
        name: ("run", row, {"units": "1", "long_name": words})
        for (name, words), row in zip(about.items(), found, strict=True)
    }
    return xr.Dataset(data, {name: sweep[name] for name in ("method", "ps")}, {"width": width})
