"""A disc that meets a rigid plane slowly: at every instant a line contact of Hertz's under the force there is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bipenalty import checks, mesh_checks
from bipenalty.body import Body
from bipenalty.contact import Contact
from bipenalty.exact.known import Floats
from bipenalty.exact.line_contact import LineContact
from bipenalty.materials import LinearElastic
from bipenalty.mesh import disc
from bipenalty.model import Model
from bipenalty.obstacles import HalfPlane
from bipenalty.scene import Scene


@dataclass(frozen=True)
class Footprint:
    """What a step saw of a contact.

    Parameters
    ----------
    x : (n,) places of the touching nodes before deformation, from the middle, m.
    pressure : (n,) force of each over the length of the rim it stands for, N/m^2.
    force : P, N/m.
    half_width : a = 2 sqrt(mean of x^2 weighted by force), m: exact for half an ellipse, and finer than the mesh.
    """

    x: Floats
    pressure: Floats
    force: float
    half_width: float


@dataclass(frozen=True)
class HertzDisc:
    """A disc on a rigid plane, thrown at it at a speed far below that of sound. Plane strain.

            /     \\       y = 0 at the plane, the disc touches it at the start
            \\ ___ / | v   c = sqrt(E (1 - nu)/(rho (1 + nu)(1 - 2 nu)))
        ________________

    How the force goes with time is not known: contact lasts some 8 R/c whatever the speed, so the disc as a whole
    rings. But waves cross the contact in a/c, far less: there, width and pressure are those of `LineContact` under the
    force of that instant. This holds for a << R; the code's is the problem of small strains, so places are those
    before deformation. `footprint` observes it; what is known of time only is None.
    Measured at 1 m/s (a up to 0.13 R) with 116, 232 and 464 segments, 6, 11 and 21 nodes touching at most: half-width
    to 5.4, 1.6 and 0.4 %, pressure to 7, 3 and 1.4 % (L2), means over the compression.

    Source: Johnson, Contact Mechanics (1985), sections 4.2(c) and 11.4 (when impact is quasi-static).

    Parameters
    ----------
    radius : R, m, > 0.
    young, poisson, density : of the disc.
    speed : v, m/s, > 0.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> import bipenalty as bp
    >>> known = HertzDisc()
    >>> model = bp.Model(known.scene(232), dt="assembled")
    >>> model.step(round(0.3 * known.t_end / model.dt))
    >>> seen = known.footprint(model)
    >>> bool(abs(seen.half_width / known.contact.half_width(seen.force) - 1) < 0.03)
    True
    """

    name = "Hertz disc"
    release_time = None
    contact_intervals = None
    impulse = None
    radius: float = 1.0
    young: float = 1000.0
    poisson: float = 0.2
    density: float = 0.1
    speed: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", mesh_checks.positive(self.name, "radius", self.radius))
        object.__setattr__(self, "speed", mesh_checks.positive(self.name, "speed", self.speed, "give it in m/s"))
        checks.within(self.name, "speed", self.speed, self.speed < 0.1 * self.speed_of_sound,
                      f"< 0.1 c = {0.1 * self.speed_of_sound:.3g} m/s", "the contact would not be narrow")  # fmt: skip

    @property
    def material(self) -> LinearElastic:
        """That of the disc, plane strain."""
        return LinearElastic(self.young, self.poisson, self.density)

    @property
    def contact(self) -> LineContact:
        """Hertz's contact: E* = E/(1 - nu^2) on a rigid plane."""
        return LineContact(self.radius, self.young / (1 - self.poisson**2))

    @property
    def t_end(self) -> float:
        """10 R/c, s: contact is over."""
        return 10 * self.radius / self.speed_of_sound

    @property
    def speed_of_sound(self) -> float:
        """That of pressure waves, m/s."""
        material, nu = self.material, self.poisson
        return float(np.sqrt(material.young * (1 - nu) / (material.density * (1 + nu) * (1 - 2 * nu))))

    @property
    def energy(self) -> float:
        """m v^2/2 of the round disc, J/m; that of a mesh is a little less."""
        return np.pi * self.radius**2 * self.density * self.speed**2 / 2

    @property
    def contact_end(self) -> tuple[str, str]:
        """The rim of the disc."""
        return "disc", "rim"

    def scene(self, refinement: int) -> Scene:
        """The disc of `refinement` segments, a multiple of 4, and the plane."""
        mesh = disc(self.radius, refinement, centre=(0.0, self.radius))
        body = Body("disc", mesh, self.material, velocity=(0.0, -self.speed))
        return Scene([body], [Contact("disc", "plane")], obstacles=[HalfPlane("plane", (0.0, 0.0), (0.0, 1.0))])

    def footprint(self, model: Model) -> Footprint:
        """The contact of a model of `scene`, observed over one step that is taken for it.

        Raises
        ------
        InputError : no contact at this instant.
        """
        mesh = model.scene.bodies[0].mesh
        height = (mesh.points + model.displacement)[:, 1]
        model.step()
        rows = np.array(model._run.rows, dtype=np.float64).reshape(-1, 2)
        checks.within(self.name, "touching nodes", len(rows), len(rows) > 0, ">= 1", "ask while there is contact")
        # Rows come without their nodes, but their gaps are the heights of the lowest nodes.
        nodes = np.argsort(height)[: len(rows)]
        force = rows[np.argsort(rows[:, 0]), 1]
        x, total = mesh.points[nodes, 0], float(force.sum())
        first, second = mesh.points[mesh.boundaries["rim"][0]]
        chord = float(np.linalg.norm(second - first))
        order = np.argsort(x)
        return Footprint(x[order], force[order] / chord, total, float(2 * np.sqrt((force * x**2).sum() / total)))

    def contact_force(self, t: Any) -> None:
        """Not known over time."""

    def impulse_until(self, t: Any) -> None:
        """Not known over time."""

    def displacement_at(self, points: Any, t: float) -> None:
        """Not known over time."""
