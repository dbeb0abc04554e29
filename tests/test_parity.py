"""Agreement with the slow NumPy oracle, step by step: displacements, row forces, penetration, energies.

Reference: oracle.py, dense matrices and plain loops, nothing shared with the package. Each scene is followed
through at least 300 steps in contact, with p_s of 0.3 to 3: contact that does not chatter, so that round-off
stays round-off. Tolerances are relative to the largest value of the whole history.
"""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import bipenalty as bp
import oracle
import scenes

Floats = NDArray[np.float64]

METHODS: list[bp.Stiffness | bp.Bipenalty] = [
    bp.Stiffness(ps=1.0),
    bp.Stiffness(ps=0.5, D=2e-4),
    bp.Bipenalty(ps=1.0, rule="published"),
    bp.Bipenalty(ps=2.0, D=1e-3, rule="published"),
    bp.Bipenalty(ps=3.0, zeta=1.0, rule="published"),
]
IN_CONTACT = 300

# Measured: displacement 6e-15 to 2e-13, row forces and energies 1e-14 to 2e-12, penetration up to 2e-11.
DISPLACEMENT, OTHERS = 1e-10, 1e-9

ENERGIES = {
    "kinetic_energy": "kinetic",
    "strain_energy": "strain",
    "penalty_energy": "penalty",
    "mass_penalty_energy": "mass_penalty",
    "load_potential": "load_potential",
    "damping_loss": "damping_loss",
}


@dataclass
class Case:
    """A scene with its method, the share of the critical time step and the number of steps to follow."""

    scene: bp.Scene
    method: bp.Stiffness | bp.Bipenalty
    steps: int
    safety: float = 0.5


def half_plane(method: Any) -> Case:
    """A block of plane stress, 0.3 m thick, pressed by its weight onto a tilted half-plane and sliding down it."""
    mesh = bp.mesh.rectangle(1.0, 0.6, 4, 3).rotated(0.3)
    body = bp.Body(
        "block",
        mesh,
        bp.LinearElastic(1000.0, 0.3, 1.0, plane="stress"),
        velocity=(0.0, -0.05),
        body_force=(2.0, -10.0),
        thickness=0.3,
    )
    floor = bp.HalfPlane("floor", point=(0.0, -0.0001), normal=(0.3, 1.0))
    scene = bp.Scene([body], contacts=[bp.Contact("block", "floor")], obstacles=[floor])
    return Case(scene, method, steps=600, safety=0.3)


def valley(method: Any) -> Case:
    """The corner of a tilted block falls into the bottom of an open valley, a reentrant vertex of the obstacle."""
    mesh = bp.mesh.rectangle(1.0, 1.0, 4, 4, element="triangle").rotated(0.9)
    body = bp.Body("block", mesh, scenes.elastic(100, 0.3, 1.0), velocity=(0.0, -0.5), body_force=(0.1, -5.0))
    floor = bp.Polyline("floor", points=[(2, 1.2), (0.6, 0.3), (0.0, -0.003), (-0.9, 0.5), (-2, 1.2)])
    scene = bp.Scene([body], contacts=[bp.Contact("block", "floor")], obstacles=[floor])
    return Case(scene, method, steps=500, safety=0.4)


def notch(method: Any) -> Case:
    """The corner of a tilted block meets the bottom of a notch, a reentrant vertex of the body below; two passes."""
    mesh = bp.mesh.rectangle(2.0, 0.8, 8, 3)
    bend = np.maximum(0.0, 1 - np.abs(mesh.points[:, 0] - 1.0) / 0.25)
    points = mesh.points * np.column_stack([np.ones(len(bend)), 1 - 0.15 * bend])
    notched = bp.Mesh(points, quads=mesh.quads, boundaries={"bottom": mesh.boundaries["bottom"]})
    corner = bp.mesh.rectangle(0.6, 0.6, 3, 3).rotated(0.8).moved(1.0, 0.8 * 0.85 + 0.001)
    bodies = [
        bp.Body("block", notched, scenes.elastic(100, 0.3, 1.0)),
        bp.Body("corner", corner, scenes.elastic(200, 0.3, 1.0), velocity=(0.0, -0.3), body_force=(0.0, -3.0)),
    ]
    contacts = [bp.Contact("corner", "block", passes=2)]
    return Case(bp.Scene(bodies, contacts, [bp.Support("block", "bottom")]), method, steps=500, safety=0.4)


def island(method: Any) -> Case:
    """A block of triangles and quads falls on a closed, rigid pentagon that is wider than the block."""
    points = np.array([(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)], dtype=float)
    mesh = bp.Mesh(points, triangles=np.array([[1, 2, 5], [1, 5, 4]]), quads=np.array([[0, 1, 4, 3]]))
    body = bp.Body("block", mesh, scenes.elastic(50, 0.3, 0.5), velocity=(0.1, -0.2), body_force=(0.0, -1.0))
    stone = bp.Polyline("stone", [(-0.5, -0.01), (0.0, -1.0), (2.0, -1.0), (2.5, -0.01), (1.0, -0.1)], closed=True)
    scene = bp.Scene([body], contacts=[bp.Contact("block", "stone")], obstacles=[stone])
    return Case(scene, method, steps=500, safety=0.25)


def supports(method: Any) -> Case:
    """A disc is pressed into the end of a block that is clamped below and guided aside, its top held in places."""
    mesh = bp.mesh.rectangle(2.0, 0.5, 8, 2)
    bodies = [
        bp.Body("block", mesh, scenes.elastic(200, 0.3, 1.0)),
        bp.Body(
            "disc",
            bp.mesh.disc(0.5, 16, "triangle").rotated(0.1).moved(1.6, 1.002),
            scenes.elastic(200, 0.3, 1.0),
            velocity=(0.2, -0.2),
            body_force=(0.5, -5.0),
        ),
    ]
    held = [bp.Support("block", "bottom"), bp.Support("block", "right", y=False)]
    scene = bp.Scene(bodies, [bp.Contact("block", "disc", passes=2)], [*held, bp.Support("block", [18, 24], x=False)])
    return Case(scene, method, steps=600, safety=0.5)


def chain(method: Any) -> Case:
    """Three bodies of different materials and thickness in two contacts, the first deformed at the start."""
    start = np.random.default_rng(1).uniform(-1e-4, 1e-4, (20, 2))
    first = bp.mesh.rectangle(1.0, 0.8, 4, 3)
    middle = bp.mesh.disc(0.4, 12, "triangle").moved(1.402, 0.45)
    last = bp.mesh.rectangle(1.0, 0.75, 2, 3).rotated(0.05)
    wobble = np.random.default_rng(2).normal((-0.2, 0.0), 0.01, (12, 2))
    bodies = [
        bp.Body("a", first, scenes.elastic(100, 0.3, 1.0), velocity=(0.2, 0.0), displacement=start, thickness=0.5),
        bp.Body("b", middle, scenes.elastic(50, -0.2, 0.5, plane="stress"), thickness=1.5),
        bp.Body("c", last.moved(1.827, 0.0), scenes.elastic(200, 0.45, 2.0), velocity=wobble),
    ]
    contacts = [bp.Contact("b", "a", passes=2), bp.Contact("b", "c")]
    return Case(bp.Scene(bodies, contacts), method, steps=600, safety=0.3)


def cylinders(method: Any, element: scenes.Element, passes: int) -> Case:
    """The colliding cylinders, coarse."""
    steps, safety = (430, 0.25) if element == "quad" else (430, 0.45)
    return Case(scenes.small_cylinders(element, passes), method, steps, safety)


SCENES = [half_plane, valley, notch, island, supports, chain]


def cases() -> Iterator[Any]:
    """Every method with both element types and one or two passes, and every other scene with three methods."""
    for method, element, passes in itertools.product(METHODS, ("quad", "triangle"), (1, 2)):
        yield pytest.param(cylinders, (method, element, passes), id=f"{method.label}-{element}-{passes} pass")
    for make, method in itertools.product(SCENES, (METHODS[1], METHODS[2], METHODS[4])):
        yield pytest.param(make, (method,), id=f"{make.__name__}-{method.label}")


def lowered(case: Case, dt: float) -> tuple[list[oracle.Body], list[oracle.Contact]]:
    """The scene as the oracle takes it, with penalties from their definitions."""
    bodies: list[oracle.Body] = []
    number: dict[str, int] = {}
    for body in case.scene.bodies:
        number[body.name] = len(bodies)
        m = body.material
        bodies.append(
            oracle.Body(
                body.mesh.points,
                body.mesh.triangles,
                body.mesh.quads,
                m.young,
                m.poisson,
                m.density,
                m.plane,
                body.thickness,
                body.velocity,
                body.displacement,
                body.body_force,
            )
        )
    for support in case.scene.constraints:
        body = case.scene.bodies[number[support.body]]
        nodes = body.mesh.nodes_of(support.on) if isinstance(support.on, str) else support.on
        axes = [axis for axis, held in enumerate((support.x, support.y)) if held]
        there = bodies[number[support.body]]
        there.fixed = [*there.fixed, *itertools.product(map(int, nodes), axes)]
    rigid: dict[str, Any] = {}
    for item in case.scene.obstacles:
        if isinstance(item, bp.HalfPlane):
            rigid[item.name] = oracle.HalfPlane(item.point, item.normal)
        else:
            rigid[item.name] = oracle.Polyline(item.points, item.closed)
    contacts = []
    for contact in case.scene.contacts:
        secondary, primary = number[contact.secondary], number.get(contact.primary)
        other = rigid[contact.primary] if primary is None else primary
        stiffest = max(bodies[b].young for b in (secondary, primary) if b is not None)
        contacts.append(oracle.Contact(secondary, other, *penalties(case.method, stiffest, dt), contact.passes))
    return bodies, contacts


def penalties(method: bp.Stiffness | bp.Bipenalty, young: float, dt: float) -> tuple[float, float, float]:
    """alpha_s = p_s E_max; alpha_m = alpha_s / R; alpha_d = D alpha_s = 2 zeta sqrt(alpha_s alpha_m)."""
    stiffness, mass = method.ps * young, 0.0
    if isinstance(method, bp.Bipenalty):
        share = 0.9 if method.R_safety is None else method.R_safety
        mass = stiffness / (share * 4 / dt**2 if method.R is None else method.R)
    damping = (method.D or 0.0) * stiffness
    if isinstance(method, bp.Bipenalty) and method.zeta is not None:
        damping = 2 * method.zeta * np.sqrt(stiffness * mass)
    return stiffness, mass, damping


def followed(case: Case) -> tuple[Floats, list[Floats]]:
    """Displacements before the first and after every step, (steps + 1, N, 2), and the row forces, sorted."""
    model = bp.Model(case.scene, case.method, safety=case.safety)
    displacements, forces = [model.displacement.copy()], []
    for _ in range(case.steps):
        model.step()
        displacements.append(model.displacement.copy())
        forces.append(np.sort([force for _, force in model._run.rows]))
    return np.array(displacements), forces


def distance(ours: Any, reference: Any, scale: float | None = None) -> float:
    """Largest difference over the largest value of the reference, or over `scale`."""
    a, b = np.asarray(ours, dtype=float), np.asarray(reference, dtype=float)
    assert a.shape == b.shape
    return float(np.abs(a - b).max() / (max(np.abs(b).max(), 1e-300) if scale is None else scale))


@pytest.mark.parametrize(("make", "arguments"), list(cases()))
def test_every_step_is_that_of_the_oracle(make: Any, arguments: tuple[Any, ...]) -> None:
    """Displacement, row forces, active rows, penetration, resultants, energies and peaks of a whole run."""
    case = make(*arguments)
    model = bp.Model(case.scene, case.method, safety=case.safety)
    expected = oracle.simulate(*lowered(case, model.dt), model.dt, case.steps)
    assert model.critical_dt == pytest.approx(2 / expected["omega_element"], rel=1e-12)
    past = {name: history[: case.steps] for name, history in expected.items() if name not in ("mass", "omega_element")}
    assert np.count_nonzero(past["active"]) >= IN_CONTACT

    displacements, forces = followed(case)
    assert distance(displacements, expected["u"]) < DISPLACEMENT
    largest = np.abs(past["contact_force"]).max()
    for ours, reference in zip(forces, past["lambdas"], strict=True):
        assert len(ours) == len(reference)
        np.testing.assert_allclose(ours, np.sort(list(reference.values())), rtol=0, atol=OTHERS * largest)

    half = case.steps // 2
    result = model.run(case.steps * model.dt, energy_every=1, snapshots=[0.0, half * model.dt])
    assert result.steps == case.steps
    np.testing.assert_array_equal(result.active_rows, past["active"])
    for name in ("contact_force", "penetration", "force_on"):
        assert distance(result.dataset[name], past[name]) < OTHERS, name
    scale = max(np.abs(past[reference]).max() for reference in ENERGIES.values())
    for name, reference in ENERGIES.items():
        assert distance(result.dataset[name], past[reference], scale) < OTHERS, name
    of_node = np.repeat(np.arange(len(case.scene.bodies)), [b.mesh.n_nodes for b in case.scene.bodies])
    for i, momentum in enumerate(np.moveaxis(result.momentum.values, 1, 0)):
        reference = np.einsum("n,tnx->tx", expected["mass"] * (of_node == i), past["v"])
        assert distance(momentum, reference) < OTHERS
    assert distance(result.largest_displacement, np.linalg.norm(past["u"], axis=2).max(axis=1)) < DISPLACEMENT
    assert distance(result.displacement, past["u"][[0, half]]) < DISPLACEMENT
    assert distance(result.velocity, past["v"][[0, half]]) < OTHERS
    assert result.max_penetration == pytest.approx(past["penetration"].max(), rel=OTHERS)
    assert result.peak_force == pytest.approx(past["contact_force"].max(), rel=OTHERS)
    assert result.impulse == pytest.approx(model.dt * past["contact_force"].sum(), rel=OTHERS)


@pytest.mark.parametrize(
    "method", [bp.Bipenalty(1.0, R=2e5, rule="published"), bp.Bipenalty(1.0, R_safety=0.3, zeta=0.5, rule="published")]
)
def test_penalty_ratio(method: bp.Bipenalty) -> None:
    """A ratio given in 1/s^2, or as another share of 4/dt^2, with a damping ratio."""
    case = chain(method)
    model = bp.Model(case.scene, method, safety=case.safety)
    expected = oracle.simulate(*lowered(case, model.dt), model.dt, case.steps)
    assert np.count_nonzero(expected["active"]) >= IN_CONTACT
    assert distance(followed(case)[0], expected["u"]) < DISPLACEMENT


def test_strain_energy_with_displaced_supports() -> None:
    """A block let go out of a uniform strain, held where it has been moved to: u'K u / 2 counts those nodes too."""
    mesh = bp.mesh.rectangle(1.0, 1.0, 4, 4)
    stretch = mesh.points * [0.01, 0.0] + [0.02, 0.0]
    body = bp.Body("block", mesh, scenes.elastic(100, 0.3, 1.0), displacement=stretch, body_force=(0.0, -1.0))
    case = Case(bp.Scene([body], constraints=[bp.Support("block", "right")]), bp.Stiffness(), steps=100)
    model = bp.Model(case.scene, case.method)
    expected = oracle.simulate(*lowered(case, model.dt), model.dt, case.steps)
    result = model.run(case.steps * model.dt, energy_every=1)
    assert distance(model.displacement, expected["u"][-1]) < DISPLACEMENT
    assert distance(result.strain_energy, expected["strain"][:-1]) < OTHERS
