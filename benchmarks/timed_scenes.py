"""The scenes that are timed: the two cylinders of the collision study, with and without what a scene may hold."""

from dataclasses import dataclass, replace

import bipenalty as bp
from bipenalty.methods import Method

#: Of both cylinders: Poisson's ratio (-), density (kg/m^3). Young's modulus (N/m^2) of the top and of the bottom one.
POISSON, DENSITY, YOUNG = 0.2, 0.1, (1000.0, 100.0)
DAMPING = 0.001  # D, s
FAR = 4.0  # m, farther than the bodies come in any run here

#: Names that the report asks for.
NOTHING = "no pair"
AGAIN = "no pair, measured again"
UNSEEN = "no pair, nothing recorded"
APART = "pair far apart"
STIFFNESS = "contact, stiffness"
STIFFNESS_DAMPED = "contact, stiffness with damping"
BIPENALTY = "contact, bipenalty"
BIPENALTY_DAMPED = "contact, bipenalty with damping"
WALL_FAR = "rigid wall far away"
WALL = "rigid wall touched"
SUPPORT = "support"
LOAD = "body force"
TINY = "no pair, one element a body"


@dataclass(frozen=True)
class Case:
    """A scene with a method, as it is timed.

    Parameters
    ----------
    name : what tables call it.
    scene, method : what is run.
    recorded : whether contact is recorded at every step and energies at every tenth, as by default.
    steps : how many steps it takes where the others take one; more for a scene too small to be timed.
    """

    name: str
    scene: bp.Scene
    method: Method
    recorded: bool = True
    steps: int = 1


def cylinders(segments: int, gap: float = 0.0, body_force: tuple[float, float] = (0.0, 0.0)) -> list[bp.Body]:
    """The cylinder at rest, `gap` m above the one that comes at 2 m/s, diagonally; `segments` edges on each rim.

    Example
    -------
    >>> [body.name for body in cylinders(8)]
    ['top', 'bottom']
    """
    disc = bp.mesh.disc(radius=1.0, segments=segments)
    stiff, soft = (bp.LinearElastic(young=E, poisson=POISSON, density=DENSITY) for E in YOUNG)
    return [
        bp.Body("top", disc.moved(0, 2 + gap), stiff, body_force=body_force),
        bp.Body("bottom", disc, soft, velocity=(2**0.5, 2**0.5), body_force=body_force),
    ]


def collision(segments: int, gap: float = 0.0, passes: int = 1) -> bp.Scene:
    """The cylinders as a contact pair; they touch at the start unless there is a gap (m)."""
    return bp.Scene(cylinders(segments, gap), contacts=[bp.Contact("top", "bottom", passes)])


def cases(segments: int) -> list[Case]:
    """All cases, the reference `NOTHING` first; they differ in one thing each from it or from one another."""
    bodies = cylinders(segments)
    bare, none = bp.Scene(bodies), bp.Stiffness(1.0)
    together, apart = collision(segments), collision(segments, FAR)
    held = replace(bare, constraints=[bp.Support("top", on="rim")])
    loaded = bp.Scene(cylinders(segments, body_force=(0.0, -9.81 * DENSITY)))
    return [
        Case(NOTHING, bare, none),
        Case(AGAIN, bare, none),
        Case(UNSEEN, bare, none, recorded=False),
        Case(APART, apart, none),
        Case(STIFFNESS, together, none),
        Case(STIFFNESS_DAMPED, together, bp.Stiffness(1.0, D=DAMPING)),
        Case(BIPENALTY, together, bp.Bipenalty(1.0, rule="published")),
        Case(BIPENALTY_DAMPED, together, bp.Bipenalty(1.0, D=DAMPING, rule="published")),
        Case(WALL_FAR, _with_wall(bodies, 1 + FAR), none),
        Case(WALL, _with_wall(bodies, 1), none),
        Case(SUPPORT, held, none),
        Case(LOAD, loaded, none),
        Case(TINY, _tiny(), none, steps=50),
    ]


def _with_wall(bodies: list[bp.Body], x: float) -> bp.Scene:
    """The bodies with a rigid wall at x (m), which the bottom one moves towards."""
    wall = bp.HalfPlane("wall", point=(x, 0), normal=(-1, 0))
    return bp.Scene(bodies, contacts=[bp.Contact("bottom", "wall")], obstacles=[wall])


def _tiny() -> bp.Scene:
    """One square element in place of each cylinder: what a step costs whatever the number of nodes."""
    square = bp.mesh.rectangle(1, 1, 1, 1)
    stiff, soft = (bp.LinearElastic(young=E, poisson=POISSON, density=DENSITY) for E in YOUNG)
    return bp.Scene([bp.Body("top", square.moved(0, 2), stiff), bp.Body("bottom", square, soft, velocity=(1, 1))])
