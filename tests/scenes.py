"""Small scenes that the tests share: cylinders, blocks and bars. SI units."""

from typing import Any, Literal

import bipenalty as bp

Element = Literal["quad", "triangle"]


def elastic(young: float, poisson: float = 0.2, density: float = 0.1, plane: str = "strain") -> bp.LinearElastic:
    """The material of the colliding cylinders, with some constants changed."""
    return bp.LinearElastic(young, poisson, density, plane)


def cylinders(passes: int = 1) -> bp.Scene:
    """The source's colliding cylinders: a stiff one at rest on top, a soft one coming up at 2 m/s and 45 degrees."""
    disc = bp.mesh.disc(radius=1.0, segments=116)
    top = bp.Body("top", disc.moved(0, 2), elastic(1000))
    bottom = bp.Body("bottom", disc, elastic(100), velocity=(2**0.5, 2**0.5))
    return bp.Scene([top, bottom], contacts=[bp.Contact("top", "bottom", passes=passes)])


def small_cylinders(element: Element = "quad", passes: int = 1, gap: float = 0.001, **bottom: Any) -> bp.Scene:
    """A stiff disc of 16 segments beside the middle of a soft, larger one of 20 that comes up to it.

    No symmetry and no matching nodes; 90 nodes; in contact for about 0.15 s.
    """
    upper = bp.mesh.disc(segments=16, element=element).rotated(0.1).moved(0.2, 2.185 + gap)
    lower = bp.mesh.disc(radius=1.2, segments=20, element=element)
    bottom = {"velocity": (2**0.5, 2**0.5)} | bottom
    bodies = [bp.Body("top", upper, elastic(1000)), bp.Body("bottom", lower, elastic(100), **bottom)]
    return bp.Scene(bodies, contacts=[bp.Contact("top", "bottom", passes=passes)])


def mirrored(mesh: bp.Mesh) -> bp.Mesh:
    """The mesh with x -> -x, its elements turned so that they stay anticlockwise; nodes keep their numbers."""
    return bp.Mesh(mesh.points * [-1, 1], mesh.triangles[:, ::-1], mesh.quads[:, ::-1], name=mesh.name)


def renumbered(mesh: bp.Mesh, order: Any, elements: Any) -> bp.Mesh:
    """The mesh with node `order[i]` in place i and its elements in the order `elements` (quads or triangles)."""
    place = order.argsort()
    triangles, quads = (place[kind][elements] if len(kind) else kind for kind in (mesh.triangles, mesh.quads))
    return bp.Mesh(mesh.points[order], triangles, quads, name=mesh.name)


# The thrown bar of Doyen, Ern, Piperno (2011): length, Young's modulus, density, speed and gap at the start.
LENGTH, YOUNG, DENSITY, SPEED, GAP = 10.0, 900.0, 1.0, 10.0, 5.001


def bar_mesh(elements: int, element: Element = "quad") -> bp.Mesh:
    """A bar of unit height and the thrown bar's length, one row of elements."""
    return bp.mesh.rectangle(LENGTH, 1.0, elements, 1, element=element)


def bar_and_wall(elements: int, element: Element = "quad") -> bp.Scene:
    """The bar thrown to the left at a rigid wall, `GAP` away from it."""
    bar = bp.Body("bar", bar_mesh(elements, element), elastic(YOUNG, 0.0, DENSITY), velocity=(-SPEED, 0))
    wall = bp.HalfPlane("wall", point=(-GAP, 0), normal=(1, 0))
    return bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])


def two_bars(elements: int, element: Element = "quad", young: tuple[float, float] = (YOUNG, YOUNG)) -> bp.Scene:
    """A bar at rest on the left, hit by another from the right, 0.011 m away; lengths and areas are equal.

    Triangles are guided along x at all nodes: they have no mirror symmetry, and the corners would slip past each other.
    """
    mesh = bar_mesh(elements, element)
    left = bp.Body("left", mesh, elastic(young[0], 0.0, DENSITY))
    right = bp.Body("right", mesh.moved(LENGTH + 0.011, 0), elastic(young[1], 0.0, DENSITY), velocity=(-SPEED, 0))
    guides = [bp.Support(name, range(mesh.n_nodes), x=False) for name in ("left", "right")]
    return bp.Scene([left, right], [bp.Contact("right", "left")], guides if element == "triangle" else ())
