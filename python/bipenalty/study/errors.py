"""What a run got wrong, in the measures of the charts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bipenalty.errors import InputError
from bipenalty.exact import HertzDisc
from bipenalty.force_error import Impulse, force_error, impulse_of, relative_error, released
from bipenalty.model import Model
from bipenalty.result import Result
from bipenalty.study.case import Case
from bipenalty.study.sampling import Sampler

Floats = npt.NDArray[np.float64]

#: Each measure in words; all are free of units.
MEASURES = {
    "force": "relative L2 error of the total contact force after a moving average",
    "impulse": "largest error of the cumulated impulse, averaged likewise, over the last",
    "displacement": "relative L2 error of the displacements in space and time",
    "energy": "energy at the end over that at the start, less 1",
    "penetration": "deepest penetration over the length of the case",
    "release": "error of the end of the first contact, over its duration",
    "half_width": "relative error of the half-width of the contact, mean over the compression",
    "pressure": "relative L2 error of the contact pressure, mean over the compression",
}
#: Instants at which displacements are compared, and widths and pressures.
PICTURES, FOOTPRINTS = 24, 12
#: Instants at which cumulated impulses are compared, per width of the average, and of the average itself.
SAMPLES = 10


@dataclass(frozen=True)
class Seen:
    """What errors are taken of.

    Parameters
    ----------
    force : (n,) N/m at t_n = n dt.
    dt : s.
    energy_ratio : at the end over that at the start, -.
    penetration : deepest, m.
    times : (k,) of the snapshots, s.
    displacement : (k, N, 2), m.
    """

    force: Floats
    dt: float
    energy_ratio: float
    penetration: float
    times: Floats
    displacement: Floats

    @classmethod
    def of(cls, result: Result) -> Seen:
        """Of a result of `Model.run(t_end, snapshots=...)`."""
        data, told = result.dataset, result.dataset.attrs
        arrays = (data[name].values for name in ("snapshot_time", "displacement"))
        force, dt = data["contact_force"].values, float(told["dt"])
        return cls(force, dt, float(told["energy_ratio"]), float(told["max_penetration"]), *arrays)


def of(
    seen: Seen | Result, case: Case, sampler: Sampler | None = None, wanted: Floats | None = None
) -> dict[str, float]:
    """Errors of a run that has reached its end, by the names of `MEASURES`; NaN for what it cannot tell.

    Parameters
    ----------
    seen : of `Model(case.scene(refinement), ...).run(case.t_end, snapshots=...)`.
    case : what it is held against.
    sampler : takes nodal values to the probes of the case; needed if it has any.
    wanted : displacements there should be at the snapshots, `pictures` of the case; no such error without.
    """
    run = Seen.of(seen) if isinstance(seen, Result) else seen
    due, got, nothing = case.impulse, impulse_of(run.force, run.dt), float("nan")
    t = np.linspace(0, case.t_end, max(2, round(SAMPLES * case.t_end / case.width)))
    whole = float(due(np.array(case.t_end)))
    start, end, until = case.contact
    displacement = nothing
    if wanted is not None and len(run.times):
        displacement = relative_error(run.displacement if sampler is None else sampler(run.displacement), wanted)
    return {
        "force": force_error(run.force, run.dt, due, case.width),
        "impulse": float(np.abs(_averaged(got, t, case.width) - _averaged(due, t, case.width)).max()) / whole,
        "displacement": displacement,
        "energy": run.energy_ratio - 1,
        "penetration": run.penetration / case.length,
        "release": abs(released(got, until) - case.release) / (end - start),
        "half_width": nothing,
        "pressure": nothing,
    }


def _averaged(impulse: Impulse, t: Floats, width: float) -> Floats:
    """Impulse averaged over `width` around times, N s/m: a jolt on closing counts by what it adds, not by its instant."""
    offsets = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
    return np.asarray(impulse(t[:, None] + width * offsets).mean(axis=1))


def footprints(known: HertzDisc, model: Model) -> tuple[float, float]:
    """Errors of half-width and pressure of a disc on a plane, means over the compression; NaN without contact."""
    wide, pressed = [], []
    for share in np.linspace(0.05, 0.36, FOOTPRINTS):
        steps = round(share * known.t_end / model.dt) - model.steps
        model.step(max(0, steps))
        try:
            seen = known.footprint(model)
        except InputError:  # no contact at this instant
            return float("nan"), float("nan")
        if seen.force <= 0:
            return float("nan"), float("nan")
        exact = known.contact.pressure(seen.x, seen.force)
        wide.append(abs(seen.half_width / float(known.contact.half_width(seen.force)) - 1))
        pressed.append(relative_error(seen.pressure, exact) if exact.any() else float("nan"))  # all nodes outside
    return float(np.mean(wide)), float(np.mean(pressed))


def snapshots(case: Case) -> Any:
    """Times at which displacements are compared, s."""
    return np.linspace(0, case.t_end, PICTURES + 1)[1:]


def pictures(times: Floats, points: Floats, case: Case) -> Floats:
    """Displacements there should be at times (s), of all nodes at `points` (m) or of the probes of the case, m."""
    places = points if case.probes is None else case.probes[0]
    return np.array([case.displacement(places, min(float(t), case.t_end)) for t in times])
