"""What a run needs of a penalty method."""

from __future__ import annotations

import math
from typing import Protocol, runtime_checkable

from bipenalty import _core, checks

#: Name and value of a rule, as the core reads it.
Rule = tuple[str, float]

NO_RULE: Rule = ("none", 0.0)


@runtime_checkable
class Method(Protocol):
    """A rule for each penalty; `ps` is NaN where no stiffness penalty factor is given.

    A method that has an `enforcement_rule` too gets its row forces otherwise than by penalties in the equation of motion.
    """

    @property
    def stiffness_rule(self) -> Rule: ...
    @property
    def kappa_rule(self) -> float: ...
    @property
    def mass_rule(self) -> Rule: ...
    @property
    def damping_rule(self) -> Rule: ...
    @property
    def label(self) -> str: ...


class StiffnessOnly:
    """Base of methods that penalise stiffness alone: no cap, no mass penalty, no damping."""

    @property
    def kappa_rule(self) -> float:
        """No cap."""
        return math.inf

    @property
    def mass_rule(self) -> Rule:
        """No mass penalty."""
        return NO_RULE

    @property
    def damping_rule(self) -> Rule:
        """No damping penalty."""
        return NO_RULE


def settle(method: Method, *names: str, required: str = "") -> None:
    """Make the named parameters floats, unless they are left out, and let the core check the bounds of all."""
    owner = type(method).__name__
    for name in names:
        if name == required or getattr(method, name) is not None:
            object.__setattr__(method, name, checks.number(owner, name, getattr(method, name)))
    _core.check_method(owner, method)


def by_penalty(method: Method) -> bool:
    """True for penalties in the equation of motion: they alone change its frequencies."""
    return not hasattr(method, "enforcement_rule")


def penalty_ratio(method: Method, dt: float) -> float:
    """R = alpha_s / alpha_m, 1/s^2; infinite without a mass penalty."""
    name, value = method.mass_rule
    return {"none": math.inf, "ratio": value, "ratio from step": value * 4 / dt**2, "critical": value / dt**2}[name]


def damping_factor(method: Method, dt: float) -> float:
    """D = alpha_d / alpha_s, s; 0 without a damping penalty."""
    name, value = method.damping_rule
    ratio = penalty_ratio(method, dt)
    return {"none": 0.0, "factor": value, "ratio": 2 * value / math.sqrt(ratio), "critical": 2 / (dt * ratio)}[name]


def penalty_factor(method: Method) -> float:
    """p_s = alpha_s / (E_max 1 m), -; NaN where another rule chooses alpha_s."""
    name, value = method.stiffness_rule
    return value if name == "factor" else math.nan
