"""Stiffness penalties as codes in use choose them."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty.methods.method import Rule, StiffnessOnly, settle


@dataclass(frozen=True)
class _Scaled(StiffnessOnly):
    """A stiffness rule of one scale factor; no mass penalty, no damping, no cap."""

    scale: float = 0.1

    def __post_init__(self) -> None:
        settle(self, "scale", required="scale")

    @property
    def stiffness_rule(self) -> Rule:
        """Which rule."""
        raise NotImplementedError

    @property
    def label(self) -> str:
        """Name for legends and tables."""
        return f"{self.stiffness_rule[0]} stiffness ({self.scale:g})"


@dataclass(frozen=True)
class ElementStiffness(_Scaled):
    """alpha_s = scale K A^2/V: bulk modulus, segment area and volume of the element behind the primary segment.

    Parameters
    ----------
    scale : scale factor f_s, -, > 0.

    The pressure K (g A)/V that would close the gap g within the element, times its area, is K A^2/V g; the scale
    factor protects the time step (Hallquist, Goudreau and Benson 1985). At a rigid obstacle the elements behind
    the secondary node count.

    Example
    -------
    >>> ElementStiffness(0.1).label
    'element stiffness (0.1)'
    """

    @property
    def stiffness_rule(self) -> Rule:
        """alpha_s = scale K A^2/V."""
        return "element", self.scale


@dataclass(frozen=True)
class NodalMassStiffness(_Scaled):
    """alpha_s = 0.5 scale m*/dt^2 with m* the smallest nodal mass of the row.

    Parameters
    ----------
    scale : scale factor (SOFSCL in codes in use), -, > 0.

    A spring of m*/dt^2 on one mass m* has omega dt = 1; the scale keeps the row well inside the limit of 2
    whatever the moduli (soft constraint formulation of codes in use).

    Example
    -------
    >>> NodalMassStiffness(0.1).label
    'nodal mass stiffness (0.1)'
    """

    @property
    def stiffness_rule(self) -> Rule:
        """alpha_s = 0.5 scale m*/dt^2."""
        return "nodal mass", self.scale
