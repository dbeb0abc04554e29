"""What must not matter and what must not change: momentum, numbering, order, place, mirror, and how a run is cut.

Scene: two coarse cylinders, or three blocks and discs, without symmetry. Two runs that differ by round-off alone are
compared through some hundred steps in contact; p_s is low enough that contact does not chatter.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import bipenalty as bp
import scenes

Floats = NDArray[np.float64]

METHODS: list[Any] = [
    bp.Stiffness(0.5, D=2e-4),
    bp.Bipenalty(1.0, rule="published"),
    bp.Bipenalty(3.0, zeta=1.0, rule="published"),
]
STEPS, SAFETY = 400, 0.25

#: relative to the largest displacement or force; measured: up to 8e-13
ROUND_OFF = 1e-11

each_method = pytest.mark.parametrize("method", METHODS, ids=lambda method: method.label)
each_pass = pytest.mark.parametrize("passes", [1, 2])


def run(scene: bp.Scene, method: Any, steps: int = STEPS, **options: Any) -> tuple[Floats, Any]:
    """Final displacement (N, 2) and the result of a run."""
    model = bp.Model(scene, method, safety=SAFETY)
    result = model.run(steps * model.dt, **options)
    assert (result.active_rows > 0).mean() > 0.5
    return model.displacement.copy(), result


def same(ours: Any, reference: Any) -> None:
    """Assert that nothing but round-off lies between two arrays."""
    a, b = np.asarray(ours), np.asarray(reference)
    assert a.shape == b.shape
    np.testing.assert_allclose(a, b, rtol=0, atol=ROUND_OFF * np.abs(b).max())


def changed(scene: bp.Scene, change: Callable[[bp.Body], bp.Body]) -> bp.Scene:
    """The scene with every body changed."""
    return bp.Scene([change(body) for body in scene.bodies], scene.contacts, scene.constraints, scene.obstacles)


@each_method
@each_pass
@pytest.mark.parametrize("element", ["quad", "triangle"])
def test_momentum_of_free_bodies(method: Any, passes: int, element: scenes.Element) -> None:
    """sum m v of all bodies, sampled every step, is constant to 1e-12 while much of it goes from one to the other."""
    _, result = run(scenes.small_cylinders(element, passes), method, energy_every=1)
    momentum = result.momentum
    total = momentum.sum("body").values
    passed = np.abs(momentum - momentum[0]).max().item()
    assert passed > 0.1 * np.abs(total[0]).max()
    assert np.abs(total - total[0]).max() < 1e-12 * np.abs(total[0]).max()


def test_momentum_by_steps() -> None:
    """The same from the velocities of `Model.step` and the masses of the bodies' elements."""
    scene = scenes.small_cylinders()
    model = bp.Model(scene, METHODS[1], safety=SAFETY)
    mass = model._core.mass
    first = mass @ model.velocity
    for _ in range(STEPS):
        model.step()
        assert np.abs(mass @ model.velocity - first).max() < 1e-12 * np.abs(first).max()


def test_momentum_is_the_impulse_of_the_obstacle() -> None:
    """Against a rigid wall the body's momentum changes by the impulse of the contact force, step by step."""
    model = bp.Model(scenes.bar_and_wall(20), bp.Bipenalty(ps=0.5, rule="published"))
    result = model.run(2.0, energy_every=1)
    momentum = result.momentum.values[:, 0, 0]
    force = result.force_on.values[:, 0, 0]
    np.testing.assert_allclose(np.diff(momentum), model.dt * (force[1:] + force[:-1]) / 2, atol=1e-12 * 100)
    assert np.ptp(momentum) > 199


@each_method
@each_pass
def test_renumbering(method: Any, passes: int) -> None:
    """Nodes and elements in another order: every node moves as before."""
    scene = scenes.small_cylinders("quad", passes)
    random = np.random.default_rng(3)
    orders = {body.name: random.permutation(body.mesh.n_nodes) for body in scene.bodies}

    def change(body: bp.Body) -> bp.Body:
        elements = random.permutation(body.mesh.n_elements)
        order = orders[body.name]
        return replace(body, mesh=scenes.renumbered(body.mesh, order, elements), velocity=body.velocity[order])

    u, result = run(scene, method)
    v, other = run(changed(scene, change), method)
    n = scene.bodies[0].mesh.n_nodes
    same(v, np.concatenate([u[:n][orders["top"]], u[n:][orders["bottom"]]]))
    same(other.contact_force, result.contact_force)
    np.testing.assert_array_equal(other.active_rows, result.active_rows)


@each_method
@each_pass
def test_order_of_bodies(method: Any, passes: int) -> None:
    """The bodies of the scene the other way round; the contact says as before which is secondary."""
    scene = scenes.small_cylinders("triangle", passes)
    u, result = run(scene, method)
    v, other = run(bp.Scene(scene.bodies[::-1], scene.contacts), method)
    n = scene.bodies[0].mesh.n_nodes
    same(v, np.roll(u, -n, axis=0))
    same(other.force_on, result.force_on)
    same(other.penetration, result.penetration)


@each_method
def test_two_passes_know_no_first_body(method: Any) -> None:
    """With two passes, secondary and primary may change places; the force on the first-named one changes sign."""
    scene = scenes.small_cylinders("quad", passes=2)
    u, result = run(scene, method)
    v, other = run(bp.Scene(scene.bodies, [bp.Contact("bottom", "top", passes=2)]), method)
    same(v, u)
    same(other.force_on, -result.force_on)


@each_method
@each_pass
@pytest.mark.parametrize("element", ["quad", "triangle"])
def test_mirror(method: Any, passes: int, element: scenes.Element) -> None:
    """x -> -x for meshes and velocities: the result is mirrored."""
    scene = scenes.small_cylinders(element, passes)
    flip = np.array([-1.0, 1.0])
    mirrored = changed(scene, lambda b: replace(b, mesh=scenes.mirrored(b.mesh), velocity=b.velocity * flip))
    u, result = run(scene, method)
    v, other = run(mirrored, method)
    same(v * flip, u)
    same(other.force_on * flip, result.force_on)
    same(other.contact_force, result.contact_force)


@each_method
@each_pass
def test_quarter_turn(method: Any, passes: int) -> None:
    """The whole scene turned by a right angle, with which the axes change places."""
    scene = scenes.small_cylinders("quad", passes)
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    turned = changed(scene, lambda b: replace(b, mesh=b.mesh.rotated(np.pi / 2), velocity=b.velocity @ turn))
    u, result = run(scene, method)
    v, other = run(turned, method)
    same(v, u @ turn)
    same(other.contact_force, result.contact_force)


@each_method
@each_pass
def test_translation(method: Any, passes: int) -> None:
    """The whole scene moved by more than its size."""
    scene = scenes.small_cylinders("quad", passes)
    u, result = run(scene, method)
    v, other = run(changed(scene, lambda b: replace(b, mesh=b.mesh.moved(5.0, -3.0))), method)
    same(v, u)
    same(other.contact_force, result.contact_force)


def test_translation_with_obstacles() -> None:
    """The same with a half-plane and a polyline, which move along."""

    def scene(dx: float, dy: float) -> bp.Scene:
        disc = bp.mesh.disc(0.5, 16).rotated(0.1).moved(dx, dy + 0.51)
        body = bp.Body("disc", disc, scenes.elastic(100, 0.3, 1.0), velocity=(0.5, -0.5), body_force=(0.0, -5.0))
        floor = bp.HalfPlane("floor", (dx, dy), (0.0, 1.0))
        step = bp.Polyline("step", [(dx + 0.51, dy + 1.0), (dx + 0.52, dy)])
        return bp.Scene([body], [bp.Contact("disc", "floor"), bp.Contact("disc", "step")], obstacles=[floor, step])

    u, result = run(scene(0.0, 0.0), METHODS[1])
    v, other = run(scene(-3.0, 2.0), METHODS[1])
    assert (np.abs(result.force_on).max(("time", "axis")) > 0).all()
    same(v, u)
    same(other.force_on, result.force_on)


@each_method
def test_rigid_motion_gives_no_force(method: Any) -> None:
    """Bodies that have been moved, not deformed, are where the moved meshes are."""
    scene = scenes.small_cylinders()
    shift = np.array([0.5, -0.25])  # exact in binary
    u, result = run(scene, method)
    v, other = run(changed(scene, lambda b: replace(b, displacement=shift)), method)
    same(v - shift, u)
    same(other.contact_force, result.contact_force)


def test_run_in_a_sweep_is_the_run_alone() -> None:
    """Exactly: every number of the history and of the summary, whatever runs beside it."""
    scene = scenes.small_cylinders()
    methods = [
        *METHODS,
        bp.Stiffness(2.0),
        bp.Bipenalty(1e3, rule="published"),
        bp.Bipenalty(1.0, R=1e5, rule="published"),
    ]
    t_end = 0.1
    together = bp.sweep(scene, methods, t_end, threads=2, histories=True)
    for i, method in enumerate(methods):
        alone = bp.Model(scene, method).run(t_end)
        there = together.isel(run=i)
        np.testing.assert_array_equal(there.contact_force, alone.contact_force)
        np.testing.assert_array_equal(there.penetration, alone.penetration)
        for name in ("max_penetration", "max_displacement", "peak_force", "impulse", "energy_ratio", "steps"):
            assert there[name].item() == alone.dataset.attrs[name], name
        assert (there.method.item(), there.outcome.item()) == (alone.method, alone.outcome)
    one = bp.sweep(scene, methods[1:2], t_end, threads=1, histories=True)
    np.testing.assert_array_equal(one.contact_force[0], together.contact_force[1])


def test_sweep_without_histories() -> None:
    """The summary is the same, and no history is there."""
    scene = scenes.small_cylinders()
    full = bp.sweep(scene, METHODS, 0.1, histories=True)
    peaks = bp.sweep(scene, METHODS, 0.1)
    assert "contact_force" not in peaks
    assert "time" not in peaks.dims
    for name in ("max_penetration", "max_displacement", "peak_force", "impulse", "energy_ratio"):
        np.testing.assert_array_equal(peaks[name], full[name])


@each_method
def test_step_is_run(method: Any) -> None:
    """step(n), n steps one by one, run, and run cut in two give exactly the same state and history."""
    scene = scenes.small_cylinders()
    models = [bp.Model(scene, method) for _ in range(4)]
    n, t_end = 300, 300 * models[0].dt
    models[0].step(n)
    for _ in range(n):
        models[1].step()
    models[2].run(t_end)
    models[3].run(t_end / 3)
    models[3].run(t_end)
    results = [model.result() for model in models]
    assert [result.steps for result in results] == 4 * [n]
    for model, result in zip(models[1:], results[1:], strict=True):
        assert model.time == models[0].time
        np.testing.assert_array_equal(model.displacement, models[0].displacement)
        np.testing.assert_array_equal(model.velocity, models[0].velocity)
        for name in ("contact_force", "penetration", "active_rows", "force_on"):
            np.testing.assert_array_equal(result.dataset[name], results[0].dataset[name])
    assert (results[0].active_rows > 0).sum() > 100


def test_recording_changes_nothing() -> None:
    """Neither snapshots nor energies nor sparse histories touch the computation."""
    scene, method = scenes.small_cylinders(), METHODS[1]
    u, plain = run(scene, method)
    v, sparse = run(scene, method, every=6, energy_every=1, snapshots=[0.0, 0.05])
    np.testing.assert_array_equal(u, v)
    np.testing.assert_array_equal(sparse.contact_force[:-1], plain.contact_force[::6])
    assert (sparse.peak_force, sparse.impulse) == (plain.peak_force, plain.impulse)
