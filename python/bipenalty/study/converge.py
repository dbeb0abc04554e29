"""Making a reference: mesh, time step and method are refined, and how far the answer still moves is measured.

python -m bipenalty.study.converge                 makes all that are stored anew (two minutes)
python -m bipenalty.study.converge cylinders       only this one
"""

from __future__ import annotations

import sys
from importlib import resources
from pathlib import Path

import numpy as np

from bipenalty import checks
from bipenalty.force_error import impulse_of, moving_average
from bipenalty.methods import Bipenalty, Method, Stiffness
from bipenalty.model import Model
from bipenalty.result import Result
from bipenalty.study import errors
from bipenalty.study.case import CONVERGED, Case, converged
from bipenalty.study.reference import INSTANTS, PICTURES, Reference
from bipenalty.study.sampling import Floats, Ints, Sampler, centroids

#: Refinements of the stored references; each has half the element size of the one before.
MESHES = (116, 232, 464)
#: Share of the usual time step (0.98 of the limit of the assembled mesh) that references are run at.
SHARE = 0.25
#: Measures of which a run's own error is known to vanish, so that changes say how certain the answer is.
CERTAIN = ("force", "impulse", "displacement", "release")


def converge(name: str, meshes: tuple[int, ...] = MESHES) -> Reference:
    """Reference of a case: the parameter-free method on the finest mesh, at a quarter of the usual time step.

    Parameters
    ----------
    name : of the case.
    meshes : refinements, coarse to fine, each with about half the element size of the one before.

    Its uncertainty is the largest of three changes: to the mesh before the finest; on the mesh before, to half of
    the time step; there, to another method, the stiffness penalty at half of what
    `Model.critical_ps` allows with a damping of D = 1e-5 s.

    Raises
    ------
    InputError : an unknown name, or fewer than two meshes.

    Example
    -------
    >>> coarse = converge("cylinders", (24, 48))
    >>> bool(abs(coarse.impulse[-1] / Reference.load("cylinders").impulse[-1] - 1) < coarse.uncertainty["impulse"])
    True
    """
    checks.within("converge", "meshes", meshes, len(meshes) > 1, "at least two", "give coarse ones first")
    checks.within("converge", "name", repr(name), name in CONVERGED, f"one of {', '.join(CONVERGED)}", "choose one")
    scene, charted, *_ = CONVERGED[name]
    places, bodies = centroids(scene(charted[0]))
    finest = _run(name, meshes[-1], Bipenalty(), SHARE)
    sampled = Sampler(scene(meshes[-1]), places, bodies)
    made = _reference(name, finest, (places, bodies), sampled, {}, "")
    case = converged(name, made)
    changes: dict[str, dict[str, float]] = {"mesh": {}, "dt": {}, "method": {}}
    before, sampler = meshes[-2], Sampler(scene(meshes[-2]), places, bodies)
    usual = _run(name, before, Bipenalty(), SHARE)
    changes["mesh"] = _change(usual, case, sampler)
    own = converged(name, _reference(name, usual, (places, bodies), sampler, {}, ""))
    changes["dt"] = _change(_run(name, before, Bipenalty(), SHARE / 2), own, sampler)
    changes["method"] = _change(_run(name, before, _other(name, before), SHARE), own, sampler)
    uncertainty = {measure: max(part[measure] for part in changes.values()) for measure in CERTAIN}
    words = "; ".join(
        f"{what}: " + ", ".join(f"{measure} {100 * part[measure]:.2g} %" for measure in CERTAIN)
        for what, part in changes.items()
    )
    about = f"converged on {meshes[-1]} segments, {finest.steps} steps of {finest.dt:.3g} s; changes with {words}"
    return _reference(name, finest, (places, bodies), sampled, uncertainty, about)


def _change(result: Result, case: Case, sampler: Sampler) -> dict[str, float]:
    """Errors of a run against a reference in the making."""
    wanted = errors.pictures(result.snapshot_time.values, np.empty((0, 2)), case)
    return errors.of(result, case, sampler, wanted)


def _other(name: str, refinement: int) -> Method:
    """The stiffness penalty, well inside its limit at the time step of a reference."""
    model = Model(CONVERGED[name][0](refinement), dt="assembled")
    return Stiffness(0.5 * model.critical_ps(SHARE * model.dt), D=1e-5)


def _run(name: str, refinement: int, method: Method, share: float) -> Result:
    """A run at a share of the usual time step, with the pictures of a reference."""
    scene, _, t_end, *_ = CONVERGED[name]
    built = scene(refinement)
    dt = share * Model(built, dt="assembled").dt
    shown = np.linspace(0, t_end, PICTURES)
    return Model(built, method, dt).run(t_end, snapshots=shown, show_progress=False, throw=True)


def _reference(
    name: str,
    result: Result,
    probes: tuple[Floats, Ints],
    sampler: Sampler,
    uncertainty: dict[str, float],
    about: str,
) -> Reference:
    """What is kept of a run, on even grids of time."""
    t_end = CONVERGED[name][2]
    time, pictures = np.linspace(0, t_end, INSTANTS), np.linspace(0, t_end, PICTURES)
    impulse = impulse_of(result.contact_force.values, float(result.dt))
    smooth = moving_average(impulse, t_end / 200, time)
    touching = time[smooth > 0.005 * smooth.max()]
    moved, taken = sampler(result.displacement.values), result.snapshot_time.values
    even = np.stack([np.interp(pictures, taken, row) for row in moved.reshape(len(taken), -1).T], axis=1)
    return Reference(
        name,
        time,
        impulse(time),
        *probes,
        pictures,
        even.reshape(len(pictures), -1, 2),
        result.momentum.values[-1],
        float(result.energy_ratio),
        (float(touching[0]), float(touching[-1])),
        uncertainty,
        about,
    )


def main(names: list[str]) -> None:
    """Make the references of the cases named anew, all unless any is."""
    folder = Path(str(resources.files("bipenalty.study"))) / "references"
    for name in names or list(CONVERGED):
        made = converge(name)
        path = made.save(folder)
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB, {made.about}")


if __name__ == "__main__":
    main(sys.argv[1:])
