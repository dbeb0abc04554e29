"""The script a researcher would write: the SciPy one of the other benchmarks, on the same arrays."""

import warnings
from dataclasses import dataclass

import numpy as np
import scipy
import scipy_script
from versus_script import prepared

import bipenalty as bp
from peers.interface import Array, Case, Outcome, impulse_of_steps, scene


@dataclass(frozen=True)
class Script:
    """NumPy and SciPy, one hundred and fifty lines, stiffness penalty; candidates are kept in lists."""

    name: str = "SciPy script"
    install: str = "Python package scipy (pip)"
    better: str = "one page that anybody can change"
    rounds: int = 9

    def available(self) -> str | None:
        """Version of SciPy, which all benchmarks need."""
        return str(scipy.__version__)

    def run(self, mesh: bp.Mesh, case: Case) -> Outcome:
        """One run; NumPy's warnings are its words."""
        both = scene(mesh)
        problem = prepared(both)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ran = scipy_script.run(problem, case.alpha_s, case.dt, case.steps, both.velocity, search="lists")
        momentum, energy = changes(problem, both.velocity, ran["u"] - case.dt * ran["v"], ran["u"], ran["v"])
        return Outcome(
            ran["seconds"],
            case.steps,
            *impulse_of_steps(ran["contact_force"], case.dt),
            summed=True,
            penetration=float(ran["penetration"].max()),
            momentum_error=momentum,
            energy_ratio=energy,
            said="; ".join(sorted({str(warning.message) for warning in caught})),
        )


def changes(problem: dict[str, Array], before: Array, u0: Array, u1: Array, v: Array) -> tuple[float, float]:
    """Error of the momentum over what there was, and energy over what there was, both -.

    `before` (N, 2) m/s is the velocity at the start, when nothing is strained. With u_{n-1}, u_n and v_{n-1/2} the
    energy v' M v/2 + u_{n-1}' K u_n/2 is the one that central differences keep; with u_n twice and v_n the usual one.
    """
    mass = problem["mass"]
    with np.errstate(all="ignore"):  # a run that has overflowed is no reason for a warning here
        start, end = (mass @ velocity for velocity in (before, v))
        energy = mass @ (v**2).sum(axis=1) + u0.ravel() @ (problem["stiffness"] @ u1.ravel())
        ratio = energy / (mass @ (before**2).sum(axis=1))
        return float(np.linalg.norm(end - start) / np.linalg.norm(start)), float(ratio)
