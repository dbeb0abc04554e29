"""Two scenes in two dimensions whose answer is converged, not known in closed form. SI units."""

from __future__ import annotations

from bipenalty.body import Body
from bipenalty.constraints import Support
from bipenalty.contact import Contact
from bipenalty.materials import LinearElastic
from bipenalty.mesh import disc, rectangle
from bipenalty.scene import Scene


def cylinders(refinement: int) -> Scene:
    """Two discs of `refinement` segments: 1000 N/m^2 at rest on top, 100 N/m^2 coming up at 2 m/s and 45 degrees.

    Radius 1 m, nu = 0.2, rho = 0.1 kg/m^3, plane strain, gap 0, one pass, no friction.
    """
    round_one = disc(radius=1.0, segments=refinement)
    stiff, soft = (LinearElastic(young, poisson=0.2, density=0.1) for young in (1000, 100))
    top = Body("top", round_one.moved(0, 2), stiff)
    bottom = Body("bottom", round_one, soft, velocity=(2**0.5, 2**0.5))
    return Scene([top, bottom], [Contact("top", "bottom")])


def stack(refinement: int) -> Scene:
    """A tilted hammer comes down at 1 m/s on a soft cushion of `refinement` segments that lies on a held anvil.

         ______
        |______| v    E = 1000 N/m^2, nu = 0.25, rho = 0.4 kg/m^3, quads
          ____
         (____)       E = 50 N/m^2, nu = 0.4, rho = 0.05 kg/m^3, triangles
        _______________
        |_____________|    E = 500 N/m^2, nu = 0.3, rho = 0.5 kg/m^3, triangles, held at its foot

    Three unlike bodies without symmetry, elements of one size, two contacts of one pass each. Plane strain.
    """
    size = refinement / 104
    wide, high = max(2, round(62 * size)), max(1, round(12 * size))
    anvil = rectangle(3, 0.6, wide, high, element="triangle").moved(-1.55, -0.6)
    cushion = disc(0.5, refinement, element="triangle").rotated(0.05).moved(0.03, 0.504)
    hammer = rectangle(0.8, 0.4, max(2, round(26 * size)), max(1, round(14 * size)))
    hammer = hammer.moved(-0.4, 0).rotated(0.12).moved(0.08, 1.035)
    bodies = [
        Body("anvil", anvil, LinearElastic(500, 0.3, 0.5)),
        Body("cushion", cushion, LinearElastic(50, 0.4, 0.05)),
        Body("hammer", hammer, LinearElastic(1000, 0.25, 0.4), velocity=(0.2, -1.0)),
    ]
    contacts = [Contact("cushion", "anvil"), Contact("hammer", "cushion")]
    return Scene(bodies, contacts, [Support("anvil", "bottom")])
