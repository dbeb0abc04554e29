"""What every program is given, what it has to hand back, and what it is asked before."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from timed_scenes import DENSITY, POISSON, YOUNG

import bipenalty as bp

__all__ = [
    "DENSITY",
    "POISSON",
    "VELOCITY",
    "YOUNG",
    "Array",
    "Case",
    "Outcome",
    "Peer",
    "impulse_of_steps",
    "unfinished",
]

Array = NDArray[np.float64]

#: Velocity of the bottom cylinder, m/s; the top one, a diameter above it, is at rest.
VELOCITY = (2**0.5, 2**0.5)


@dataclass(frozen=True)
class Case:
    """One collision, the same for all.

    Parameters
    ----------
    ps : stiffness penalty factor: a node that is d metres inside is pushed out with ps * E_max * d, N/m.
    dt : time step, s, of whoever lets itself be told one.
    t_end : s.
    limit : a program that has not finished after so many seconds is stopped.
    recorded : histories are wanted; where they cost time, a run that is timed goes without.
    """

    ps: float
    dt: float
    t_end: float = 0.18
    limit: float = 600.0
    recorded: bool = True

    @property
    def alpha_s(self) -> float:
        """Stiffness penalty by node, N/m per m."""
        return self.ps * max(YOUNG)

    @property
    def steps(self) -> int:
        """Steps of dt until t_end."""
        return int(np.ceil(self.t_end / self.dt - 1e-9))


def scene(mesh: bp.Mesh) -> bp.Scene:
    """Two of the disc, as the study has them: the one at rest above the softer one that comes."""
    stiff, soft = (bp.LinearElastic(young, POISSON, DENSITY) for young in YOUNG)
    bodies = [bp.Body("top", mesh.moved(0, 2), stiff), bp.Body("bottom", mesh, soft, velocity=VELOCITY)]
    return bp.Scene(bodies, contacts=[bp.Contact("top", "bottom")])


def segment_length(mesh: bp.Mesh) -> float:
    """Of the rim, m: what a contact node stands for where a penalty is a pressure per depth (N/m^3)."""
    rim = mesh.points[mesh.boundaries["rim"]]
    return float(np.linalg.norm(rim[:, 1] - rim[:, 0], axis=1).mean())


@dataclass(frozen=True)
class Outcome:
    """What one run gave.

    Parameters
    ----------
    seconds : wall time of the time loop.
    steps : taken.
    times, impulse : (n,) s and N s/m: impulse cumulated by the contact force.
    summed : the force is the sum over the contact nodes, as the package has it; else the resultant on the top
        cylinder, some 0.2 % less.
    penetration : deepest of a node of the top cylinder in the bottom one, m.
    momentum_error : change of the total momentum over what there was, -.
    energy_ratio : kinetic and strain energy at the end over that at the start, -.
    ended : "finished", "stopped" by the program itself, or "time limit".
    said : what the program itself said of trouble; empty if nothing.
    """

    seconds: float
    steps: int
    times: Array
    impulse: Array
    summed: bool
    penetration: float
    momentum_error: float
    energy_ratio: float
    ended: str = "finished"
    said: str = ""


class Peer(Protocol):
    """A program that can run the collision."""

    @property
    def name(self) -> str:
        """What tables call it."""

    @property
    def install(self) -> str:
        """How to install it, in words."""

    @property
    def better(self) -> str:
        """What it can do that the package cannot, in words; empty for the package itself."""

    @property
    def rounds(self) -> int:
        """Timed runs at most; fewer for one that takes long."""

    def available(self) -> str | None:
        """Its version, or None if it is not installed; `install` then says what to do."""

    def run(self, mesh: bp.Mesh, case: Case) -> Outcome:
        """Two of the discs as cylinders, collided as the case says."""


def impulse_of_steps(force: Any, dt: float) -> tuple[Array, Array]:
    """Times (n + 1,) s and impulse (n + 1,) N s/m of a force (n,) N/m that acts from t_{k-1/2} to t_{k+1/2}.

    Example
    -------
    >>> [values.tolist() for values in impulse_of_steps([2.0, 4.0], dt=0.5)]
    [[-0.25, 0.25, 0.75], [0.0, 1.0, 3.0]]
    """
    values = np.asarray(force, dtype=np.float64)
    times: Array = (np.arange(len(values) + 1, dtype=np.float64) - 0.5) * dt
    return times, np.concatenate([[0.0], np.cumsum(values) * dt])


def unfinished(ended: str, said: str, seconds: float, steps: int = 0, reached: float = 0.0) -> Outcome:
    """A run that left nothing to compare: `steps` taken, `reached` t (s), if that is known."""
    nothing = np.array([0.0, reached]), np.zeros(2)
    return Outcome(seconds, steps, *nothing, True, np.nan, np.nan, np.nan, ended, said)
