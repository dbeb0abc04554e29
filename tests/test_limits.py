"""Limits of the time step and of p_s: predicted against exact formulas, dense eigenvalues and observed blow-up.

Pressed bars: two equal bars (or one and a rigid wall), one row of quads with nu = 0 and no motion along y, squeezed
between supports by their initial displacement, so that the contact rows stay closed until an instability throws them
open. Exact largest frequency with beta = alpha_s h/(E A) of the closed row between two equal bars (lumped linear
elements, derived):

    omega^2 = (2 c^2/h^2)(1 + sqrt(1 + 4 beta^2)),    beta_crit = sqrt(1 - S^2)/S^2 at the Courant number S = c dt/h

and twice that beta against a rigid wall.
"""

import math
from typing import Any

import numpy as np
import pytest

import bipenalty as bp
import oracle
import scenes

ELEMENTS, LENGTH, HEIGHT, YOUNG, DENSITY = 20, 1.0, 1.0, 900.0, 1.0
H, C = LENGTH / ELEMENTS, math.sqrt(YOUNG / DENSITY)
SQUEEZE = 1e-3  # compressive strain of the pressed bars
STEPS = 600

each_side = pytest.mark.parametrize("wall", [False, True], ids=["two bars", "rigid wall"])
each_courant = pytest.mark.parametrize("courant", [0.5, 0.9])


def ps_of(beta: float) -> float:
    """p_s whose two rows, one an edge node, share alpha_s = beta E A/h of the section."""
    return beta * HEIGHT / (2 * H)


def omega(beta: float, wall: bool) -> float:
    """Exact largest frequency of the pressed bars, rad/s."""
    b = beta / 2 if wall else beta
    return math.sqrt(2 * C**2 / H**2 * (1 + math.sqrt(1 + 4 * b**2)))


def critical_beta(courant: float, wall: bool) -> float:
    """Largest beta that is stable at a Courant number."""
    return (2 if wall else 1) * math.sqrt(1 - courant**2) / courant**2


def pressed(beta: float, dt: float, wall: bool, method: Any = None) -> bp.Model:
    """Bars in equilibrium under pressure, but for a velocity noise of 1e-7 m/s.

    The start v_{-1/2} = v_0 - dt/2 a_0 leaves the contact force out of a_0; v_0 makes up for it, so that v_{-1/2} is
    the noise alone.
    """
    mesh, material = bp.mesh.rectangle(LENGTH, HEIGHT, ELEMENTS, 1), bp.LinearElastic(YOUNG, 0.0, DENSITY)
    x = mesh.points[:, 0]
    overlap = SQUEEZE * HEIGHT / 2 / ps_of(beta)  # so that alpha_s overlap is the node's share of E A strain
    kick = dt / 2 * 2 * YOUNG * SQUEEZE / (DENSITY * H)
    noise = 1e-7 * np.random.default_rng(1).standard_normal(len(x))

    def bar(name: str, at: float, u: Any, end: float, push: float) -> bp.Body:
        v = np.stack([noise + push * (np.abs(x - end) < 1e-9), np.zeros_like(x)], axis=1)
        u = np.stack([u, np.zeros_like(x)], axis=1)
        return bp.Body(name, mesh.moved(at, 0), material, velocity=v, displacement=u)

    method = bp.Stiffness(ps_of(beta)) if method is None else method
    along = np.arange(len(x))  # corners that slide off each other's ends would open the rows
    supports = [bp.Support("right", along, x=False), bp.Support("right", "right")]
    if wall:
        body = bar("right", 0.0, -overlap - SQUEEZE * x, 0.0, -kick)
        rest = ([body], [bp.Contact("right", "wall", overlap_tolerance=1.0)], supports,
                [bp.HalfPlane("wall", (0, 0), (1, 0))])  # fmt: skip
    else:
        bodies = [bar("left", 0.0, -SQUEEZE * x, LENGTH, kick),
                  bar("right", LENGTH, -SQUEEZE * LENGTH - overlap - SQUEEZE * x, 0.0, -kick)]  # fmt: skip
        supports += [bp.Support("left", along, x=False), bp.Support("left", "left")]
        rest = (bodies, [bp.Contact("right", "left", overlap_tolerance=1.0)], supports, [])
    return bp.Model(bp.Scene(*rest), method, dt=dt)


def stays(beta: float, dt: float, wall: bool) -> bool:
    """True when the pressed rows are still closed after STEPS steps; if not, the run must have said why."""
    result = pressed(beta, dt, wall).run(STEPS * dt)
    closed = bool((result.active_rows == 2).all())
    assert closed == (result.outcome == "finished"), result.reason
    if not closed:
        assert result.outcome == "spectral instability"
        assert "contact row at node" in result.reason
        assert result.energy_made > 0.05
    else:
        assert abs(result.energy_ratio - 1) < 1e-3
    return closed


# ---- closed rows of two bars, exactly


@each_side
@pytest.mark.parametrize("beta", [0.05, 0.538, 3.46, 100.0])
def test_active_rows_against_the_exact_formula(beta: float, wall: bool) -> None:
    """critical_step().rows is 2/omega and the limit of the mesh is h/c, both from below and within 0.5 %."""
    dt = 0.1 * 2 / omega(beta, wall)
    model = pressed(beta, dt, wall)
    model.step()
    limits = model.critical_step()
    assert 0.995 < limits.rows / (2 / omega(beta, wall)) <= 1
    assert limits.element == pytest.approx(H / C, rel=1e-9)
    assert 0.995 <= limits.assembled / (H / C) <= 1
    assert limits.growth == pytest.approx(limits.rows / dt, rel=1e-12)
    assert limits.governs == ("active rows" if beta > 0.5 else "mesh")  # 0.05 costs less than the bounds allow for


@each_side
@each_courant
def test_both_sides_of_the_critical_penalty(courant: float, wall: bool) -> None:
    """Closed rows stay closed at 0.98 of the exact beta_crit and are thrown open at 1.02 of it, within 600 steps."""
    beta, dt = critical_beta(courant, wall), courant * H / C
    assert stays(0.98 * beta, dt, wall)
    assert not stays(1.02 * beta, dt, wall)


@each_side
@each_courant
def test_predicted_against_observed_penalty(courant: float, wall: bool) -> None:
    """p_s at which critical_step().rows falls to dt, against the p_s of blow-up found by bisection: within 2 %."""
    dt = courant * H / C

    def predicted_stable(beta: float) -> bool:
        model = pressed(beta, dt, wall)
        model.step()
        return model.critical_step().rows >= dt

    found = []
    for stable in (predicted_stable, lambda beta: stays(beta, dt, wall)):
        low, high = 0.5 * critical_beta(courant, wall), 1.5 * critical_beta(courant, wall)
        assert stable(low)
        assert not stable(high)
        while high > 1.003 * low:
            middle = math.sqrt(low * high)
            low, high = (middle, high) if stable(middle) else (low, middle)
        found.append(math.sqrt(low * high))
    assert found[0] == pytest.approx(found[1], rel=0.02)
    assert found[1] == pytest.approx(critical_beta(courant, wall), rel=0.02)


@each_side
@each_courant
def test_critical_ps_is_a_lower_bound(courant: float, wall: bool) -> None:
    """critical_ps() of closed rows: the sum bound (1 - S^2)/S^2, sqrt(1 - S^2) of the exact limit, never above it."""
    dt = courant * H / C
    model = pressed(1.0, dt, wall)
    before = model.critical_ps()
    model.step()
    assert model.critical_ps() == pytest.approx(before, rel=1e-9)  # rows share no node here: the worst is any of them
    share = model.critical_ps() / ps_of(critical_beta(courant, wall))
    assert 0.95 * math.sqrt(1 - courant**2) < share <= math.sqrt(1 - courant**2)
    assert stays(share * critical_beta(courant, wall), dt, wall)


@each_side
def test_dt_may_grow_by_growth(wall: bool) -> None:
    """What growth promises at half the Courant number: 0.98 of it holds, 1.02 of it does not."""
    beta, dt = critical_beta(0.8, wall), 0.4 * H / C
    model = pressed(beta, dt, wall)
    model.step()
    growth = model.critical_step().growth
    assert growth == pytest.approx(2.0, rel=0.003)
    assert stays(beta, 0.98 * growth * dt, wall)
    assert not stays(beta, 1.02 * growth * dt, wall)


@each_side
def test_bipenalty_rows_are_bounded_by_the_ratio(wall: bool) -> None:
    """For beta -> inf the closed rows have omega^2 = max(omega_0^2, R), R above the mesh's own or below it."""
    dt = 0.5 * H / C
    for ratio, limit in ((9 * C**2 / H**2, 2 / 3 * H / C), (0.5 * C**2 / H**2, H / C)):
        model = pressed(1e6, dt, wall, bp.Bipenalty(ps_of(1e6), rule="published", R=ratio))
        model.step()
        assert model.critical_step().rows == pytest.approx(limit, rel=0.006)


@each_side
def test_both_sides_of_the_ratio(wall: bool) -> None:
    """Closed rows of a very stiff bipenalty have omega^2 = R: stable at 0.98 of R = 4/dt^2, thrown open at 1.02."""
    dt, beta = 0.5 * H / C, 1e4
    for factor, closed in ((0.98, True), (1.02, False)):
        method = bp.Bipenalty(ps_of(beta), rule="published", R=factor * 4 / dt**2)
        result = pressed(beta, dt, wall, method).run(STEPS * dt)
        assert bool((result.active_rows == 2).all()) == closed
        assert result.outcome == ("finished" if closed else "spectral instability")
        assert closed or "omega dt = 2.02 of the penalty ratio, above 2; lower R to 4/dt^2" in result.reason


# ---- the limits of a mesh


@pytest.mark.parametrize("element", ["quad", "triangle"])
def test_limits_of_a_mesh_against_dense_eigenvalues(element: scenes.Element) -> None:
    """element <= assembled <= exact; assembled 0.5 % below at most (0.99 of omega^2); the oracle shares nothing."""
    scene = scenes.small_cylinders(element)
    exact = 0.0
    for body in scene.bodies:
        m = body.material
        twin = oracle.Body(body.mesh.points, body.mesh.triangles, body.mesh.quads, m.young, m.poisson, m.density)
        k, mass, _ = oracle.assemble([twin])
        exact = max(exact, float(np.linalg.eigvalsh(k / np.sqrt(np.outer(mass, mass)))[-1]))
    limits = bp.Model(scene).critical_step()
    assert 0.9949 < limits.assembled / (2 / math.sqrt(exact)) <= 1
    assert limits.element < limits.assembled
    assert limits.rows == limits.assembled
    assert (limits.governs, limits.growth) == ("mesh", limits.assembled / limits.dt)


def test_time_step_from_a_limit() -> None:
    """dt = safety * limit, 0.5 of the elements' and 0.98 of the assembled matrix's unless given; or seconds."""
    scene = scenes.small_cylinders()
    limits = bp.Model(scene).critical_step()
    assert bp.Model(scene).critical_dt == limits.element
    for options, dt in [
        ({}, 0.5 * limits.element),
        ({"dt": "element"}, 0.5 * limits.element),
        ({"dt": "element", "safety": 1.0}, limits.element),
        ({"dt": "assembled"}, 0.98 * limits.assembled),
        ({"dt": "assembled", "safety": 0.3}, 0.3 * limits.assembled),
        ({"dt": 1e-5}, 1e-5),
        ({"dt": 0.999 * limits.assembled}, 0.999 * limits.assembled),
    ]:
        assert bp.Model(scene, **options).dt == pytest.approx(dt, rel=1e-12)
        assert bp.Model(scene, **options).critical_step().dt == pytest.approx(dt, rel=1e-12)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"dt": "matrix"}, 'model: dt = \'matrix\', must be "element", "assembled"'),
        ({"dt": 0.0}, "model: dt = 0.0, must be > 0"),
        ({"dt": math.nan}, "model: dt = nan, must be > 0"),
        ({"safety": 0.0}, r"model: safety = 0.0, must be in \(0, 1\]"),
        ({"dt": "assembled", "safety": 1.01}, r"model: safety = 1.01, must be in \(0, 1\]"),
        ({"dt": 1.0}, r"run: dt = 1.0+e0 s, must be <= .*allow_unstable"),
    ],
)
def test_time_step_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(bp.InputError, match=message):
        bp.Model(scenes.small_cylinders(), **options)


def test_time_step_past_the_assembled_limit_is_refused_unless_allowed() -> None:
    scene = scenes.small_cylinders()
    limit = bp.Model(scene).critical_step().assembled
    bp.Model(scene, dt=0.999 * limit)
    with pytest.raises(bp.InputError, match="2/omega_max of the mesh"):
        bp.Model(scene, dt=1.001 * limit)
    assert bp.Model(scene, dt=1.001 * limit, allow_unstable=True).critical_step().growth < 1


# ---- p_s of a contact that is yet to come


def step_to(model: bp.Model, rows: int) -> bp.Model:
    """The model in the first step with so many active rows."""
    for _ in range(2000):
        model.step()
        if len(model._run.rows) >= rows:
            return model
    raise AssertionError(f"never {rows} rows at once")


def onset(scene: bp.Scene, low: float, high: float) -> float:
    """p_s at which contact first adds 5 % of the energy, by bisection between low (none) and high."""

    def failed(ps: float) -> bool:
        return bool(bp.Model(scene, bp.Stiffness(ps)).run(0.18, energy_every=100).energy_made > 0.05)

    assert not failed(low)
    assert failed(high)
    while high > 1.02 * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if failed(middle) else (middle, high)
    return math.sqrt(low * high)


def test_a_priori_penalty_of_the_cylinders() -> None:
    """critical_ps() before any contact, against the p_s at which runs begin to make energy: at most 10 % above it.

    It is below the limit of every active set that the run goes through, since it takes the two lightest nodes.
    """
    scene = scenes.cylinders()
    predicted, observed = bp.Model(scene).critical_ps(), onset(scene, 5.0, 50.0)
    assert 0.7 * observed < predicted < 1.1 * observed
    model = bp.Model(scene, bp.Stiffness(observed))
    least = math.inf
    for _ in range(1500):
        model.step()
        if model._run.rows and model.steps % 20 == 0:
            least = min(least, model.critical_ps())
    assert predicted < least


@pytest.mark.parametrize(("contacts", "passes"), [(1, 2), (2, 1)], ids=["two passes", "listed twice"])
def test_a_priori_penalty_with_redundant_rows(contacts: int, passes: int) -> None:
    """Blocks with coinciding nodes, every row there twice: critical_ps() before contact must hold for that set too.

    So it must not be above critical_ps() of the rows themselves, and 0.9 of it must not make energy.
    """
    scene = coinciding_blocks(contacts, passes)
    before = bp.Model(scene).critical_ps()
    model = step_to(bp.Model(scene, bp.Stiffness(1e-3)), 10)
    assert before <= model.critical_ps() * 1.001
    assert bp.Model(scene, bp.Stiffness(0.9 * before)).run(0.5).outcome == "finished"


def coinciding_blocks(contacts: int, passes: int) -> bp.Scene:
    """A block on the middle of a wide one, with the same mesh, pressed down by its weight."""
    lower = bp.mesh.rectangle(3, 1, 12, 4).moved(-1, 0)
    upper = bp.mesh.rectangle(1, 1, 4, 4).moved(0, 1 + 1e-5)
    bodies = [bp.Body("upper", upper, scenes.elastic(100), velocity=(0, -0.05), body_force=(0, -2)),
              bp.Body("lower", lower, scenes.elastic(100))]  # fmt: skip
    contact = [bp.Contact("upper", "lower", passes=passes)] * contacts
    return bp.Scene(bodies, contact, [bp.Support("lower", "bottom")])


def test_penalty_at_other_time_steps() -> None:
    """critical_ps(dt) = (4/dt^2 - 4/assembled^2)/(G M^-1 G')/E: 0 past the mesh's limit, infinite without contact."""
    scene = scenes.small_cylinders()
    model = bp.Model(scene)
    limit = model.critical_step().assembled
    assert model.critical_ps() == model.critical_ps(model.dt)
    ratio = model.critical_ps(0.2 * limit) / model.critical_ps(0.6 * limit)
    assert ratio == pytest.approx((1 / 0.2**2 - 1) / (1 / 0.6**2 - 1), rel=1e-9)
    assert model.critical_ps(limit) == pytest.approx(0.0, abs=1e-9)
    assert model.critical_ps(1.1 * limit) == 0
    assert bp.Model(bp.Scene(scene.bodies)).critical_ps() == math.inf
    for wrong in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(bp.InputError, match="critical_ps: dt"):
            model.critical_ps(wrong)


def test_a_body_without_contact_does_not_change_the_penalty() -> None:
    """p_s is alpha_s over the stiffer body of the PAIR: a stiff rock that nothing touches has no part in it."""
    scene = scenes.small_cylinders()
    rock = bp.Body("rock", bp.mesh.rectangle(1, 1, 2, 2).moved(10, 0), bp.LinearElastic(1e7, 0.2, 1e3))
    with_rock = bp.Scene([*scene.bodies, rock], scene.contacts)
    dt = 1e-4
    alone, beside = (bp.Model(s, dt=dt).critical_ps() for s in (scene, with_rock))
    assert beside == pytest.approx(alone, rel=0.01)


@pytest.mark.parametrize("method", [bp.Bipenalty(), bp.Bipenalty(30.0), bp.Bipenalty(30.0, rule="published")],
                         ids=lambda m: m.label)  # fmt: skip
def test_mesh_governs_where_the_rule_follows_dt(method: Any) -> None:
    """A rule that takes R from dt keeps omega^2 <= max(omega_0^2, 4/dt^2) at every dt: rows never cost time step."""
    model = step_to(bp.Model(scenes.small_cylinders(), method), 2)
    limits = model.critical_step()
    assert limits.governs == "mesh"
    assert limits.growth == pytest.approx(limits.assembled / limits.dt, rel=1e-3)
