"""Materials."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty import _core, checks


@dataclass(frozen=True)
class LinearElastic:
    """Isotropic linear elasticity.

    Parameters
    ----------
    young : Young's modulus E, N/m^2, > 0.
    poisson : Poisson's ratio nu, in (-1, 0.5).
    density : mass density rho, kg/m^3, > 0.
    plane : "strain" (no strain out of the plane) or "stress" (no stress out of it).

    Raises
    ------
    InputError : a constant out of its bounds.

    Example
    -------
    >>> LinearElastic(young=210e9, poisson=0.3, density=7800.0).plane
    'strain'
    """

    young: float
    poisson: float
    density: float
    plane: str = "strain"

    def __post_init__(self) -> None:
        for name in ("young", "poisson", "density"):
            object.__setattr__(self, name, checks.number("LinearElastic", name, getattr(self, name)))
        object.__setattr__(self, "plane", checks.text("LinearElastic", "plane", self.plane))
        _core.check_elastic("LinearElastic", self)
