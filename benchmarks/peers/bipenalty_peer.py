"""The package itself, with the method it has by default and with the stiffness penalty that all others have."""

from dataclasses import dataclass

import numpy as np

import bipenalty as bp
from peers.interface import Case, Outcome, impulse_of_steps, scene


@dataclass(frozen=True)
class Package:
    """The package with one method.

    Parameters
    ----------
    stiffness : the stiffness penalty at the case's p_s; else the parameter-free method, which is given a p_s only where
        the case asks for another than 1 (the critical rule, capped).
    """

    stiffness: bool = False
    install: str = "it is this package"
    better: str = ""
    rounds: int = 9

    @property
    def name(self) -> str:
        """Package and method."""
        return "bipenalty, stiffness penalty" if self.stiffness else "bipenalty, parameter-free"

    def available(self) -> str | None:
        """Its version."""
        return bp.__version__

    def run(self, mesh: bp.Mesh, case: Case) -> Outcome:
        """One run; the total force is the sum over the contact nodes."""
        if self.stiffness:
            model = bp.Model(scene(mesh), bp.Stiffness(case.ps), dt=case.dt)
        else:
            model = bp.Model(scene(mesh), bp.Bipenalty() if case.ps == 1 else bp.Bipenalty(case.ps), dt=case.dt)
        result = model.run(case.t_end, show_progress=False)
        momentum = result.momentum.values.sum(axis=1)
        return Outcome(
            result.seconds,
            result.steps,
            *impulse_of_steps(result.contact_force.values, result.dt),
            summed=True,
            penetration=result.max_penetration,
            momentum_error=float(np.linalg.norm(momentum[-1] - momentum[0]) / np.linalg.norm(momentum[0])),
            energy_ratio=result.energy_ratio,
            ended="finished" if result.outcome == "finished" else "stopped",
            said=result.reason,
        )
