"""Materials."""

from __future__ import annotations

from dataclasses import dataclass

from bipenalty import checks


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
        owner = "LinearElastic"
        for name, unit in (("young", "N/m^2"), ("density", "kg/m^3")):
            value = checks.number(owner, name, getattr(self, name))
            checks.within(owner, name, value, 0 < value < float("inf"), "> 0 and finite", f"give it in {unit}")
            object.__setattr__(self, name, value)
        nu = checks.number(owner, "poisson", self.poisson)
        checks.within(owner, "poisson", nu, -1 < nu < 0.5, "in (-1, 0.5)",
                      "an incompressible material (0.5) has no finite wave speed: use 0.499 at most")
        object.__setattr__(self, "poisson", nu)
        checks.within(owner, "plane", repr(self.plane), self.plane in ("strain", "stress"),
                      '"strain" or "stress"', "name one of the two")
