"""What a study holds runs against: a scene at any refinement and its answer, exact or converged."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from bipenalty import checks
from bipenalty.exact import Bar, HertzDisc, Known, TwoBars
from bipenalty.force_error import Impulse, released
from bipenalty.scene import Scene
from bipenalty.study import scenes
from bipenalty.study.reference import Reference

Floats = npt.NDArray[np.float64]

#: Stiffness penalty factors p_s that a method with one is tried with.
FACTORS = tuple(float(ps) for ps in np.logspace(-0.5, 2.5, 7))


@dataclass(frozen=True)
class Case:
    """A scene and its answer.

    Attributes
    ----------
    name : what tables and figures call it.
    scene : the scene of a refinement: elements of a bar, segments of a disc; elements shrink as 1/refinement.
    refinements : the meshes of the study, coarse to fine.
    t_end : s.
    width : of the moving average of forces, s: a wave's way through one element of the coarsest mesh.
    length : m, that penetrations are told in.
    impulse : cumulated up to times (s), N s/m.
    displacement : (p, 2) in m of points at a time (s).
    contact : first closing and opening, s, and the time up to which the first contact is judged.
    answer : in words.
    probes : points (p, 2) in m and their bodies where displacements are compared; all nodes if None.
    uncertainty : of the answer, in each error measure; nothing for an exact one.
    footprint : what tells the width and pressure of the contact, if they are known.
    phases : runs of each setting, at time steps up to 2 % shorter, which shifts where within a step contact begins:
        a bar closes at once, and a single run can be lucky; errors are the root mean square of the runs.

    Example
    -------
    >>> import bipenalty as bp
    >>> case = Case.of(bp.exact.ThrownBar())
    >>> case.name, case.answer, round(case.width, 5)
    ('thrown bar', 'exact', 0.02083)
    """

    name: str
    scene: Callable[[int], Scene]
    refinements: tuple[int, ...]
    t_end: float
    width: float
    length: float
    impulse: Impulse
    displacement: Callable[[Floats, float], Floats]
    contact: tuple[float, float, float]
    answer: str
    probes: tuple[Floats, npt.NDArray[np.int64]] | None = None
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    footprint: HertzDisc | None = None
    phases: int = 1

    @cached_property
    def release(self) -> float:
        """When the first contact has given 99 % of its impulse, s."""
        return released(self.impulse, self.contact[2])

    @classmethod
    def of(cls, known: Any) -> Case:
        """The case of a benchmark of `bipenalty.exact`, or a case as it is.

        Raises
        ------
        InputError : neither of the two.
        """
        if isinstance(known, Case):
            return known
        if isinstance(known, HertzDisc):
            return hertz(known)
        ok = hasattr(known, "contact_intervals") and known.contact_intervals is not None
        remedy = "give one of bipenalty.exact or of study.cases()"
        checks.within("study", "case", type(known).__name__, ok, "a Case or a benchmark with a known force", remedy)
        return _exact(known)


def _exact(known: Known) -> Case:
    """A bar whose waves are known."""
    bar: Bar = known.right if isinstance(known, TwoBars) else known.bar  # type: ignore[attr-defined]
    meshes = (16, 27, 45, 75, 125, 200)
    intervals = known.contact_intervals or ()
    until = (intervals[0][1] + intervals[1][0]) / 2 if len(intervals) > 1 else known.t_end
    width = bar.length / meshes[0] / known.speed_of_sound
    exact: Any = known  # what is None for benchmarks without a known force is a number here
    return Case(known.name, known.scene, meshes, known.t_end, width, bar.length, exact.impulse_until,
                exact.displacement_at, (*intervals[0], until), "exact", phases=3)  # fmt: skip


#: Refinements, t_end (s), speed of sound (m/s) of the slowest body that touches, and radius (m) of the converged cases.
CONVERGED: dict[str, tuple[Callable[[int], Scene], tuple[int, ...], float, float, float]] = {
    "cylinders": (scenes.cylinders, (24, 36, 52, 72, 96, 124), 0.18, 33.3, 1.0),
    "stack": (scenes.stack, (20, 28, 40, 60, 84, 116), 0.36, 46.3, 0.5),
    "Hertz disc": (HertzDisc().scene, (24, 36, 56, 84, 116, 168), HertzDisc().t_end, HertzDisc().speed_of_sound, 1.0),
}


def converged(name: str, reference: Reference | None = None) -> Case:
    """A case that is held against a converged run: "cylinders", "stack" or "Hertz disc".

    Parameters
    ----------
    name : of the case.
    reference : the converged run; the stored one unless given.

    Example
    -------
    >>> case = converged("cylinders")
    >>> bool(0.404 < case.impulse(case.t_end) < 0.407), case.uncertainty["impulse"] < 2e-3
    (True, True)
    """
    checks.within("study", "case", repr(name), name in CONVERGED, f"one of {', '.join(CONVERGED)}", "name one of them")
    scene, meshes, t_end, speed, radius = CONVERGED[name]
    found = Reference.load(name) if reference is None else reference
    width = 2 * np.pi * radius / meshes[0] / speed
    closing, opening = found.contact
    return Case(name, scene, meshes, t_end, width, radius, found.impulse_until, found.displacement_at,
                (closing, opening, t_end), found.about, (found.probes, found.probe_bodies), found.uncertainty)  # fmt: skip


def hertz(known: HertzDisc) -> Case:
    """The disc on a plane: its force over time is converged, the width and pressure of its contact are exact."""
    usual = known == HertzDisc()
    checks.within(
        "study", "Hertz disc", "another", usual, "the default one", "its force over time is stored, not known"
    )
    case = converged("Hertz disc")
    return replace(case, footprint=known)


def cases() -> tuple[Case, ...]:
    """All cases of the charts: five benchmarks of `bipenalty.exact` and two scenes with converged answers."""
    from bipenalty.exact import BENCHMARKS

    return (*(Case.of(known) for known in BENCHMARKS), converged("cylinders"), converged("stack"))
