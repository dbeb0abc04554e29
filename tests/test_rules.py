"""The rules for the three penalties, measured on one contact row, against their definitions.

Scene: a square stands on one corner above a floor or another body and falls rigidly, so that in the first step in
contact no elastic force acts and the row alone decides. With g < 0, gap rate -v before the step, effective mass m and
P = A_m + dt/2 A_d, the row force of that step is

    lambda = m/(m + P) (A_s |g| - A_d (G v)) = m/(m + P) (A_s |g| + A_d v)

Two phases of entry give the shares of g and v; two densities tell P from A_s. Nothing else of the package is used.
"""

import math
from typing import Any

import numpy as np
import pytest

import bipenalty as bp

DT, SPEED = 1e-3, 1.0
SOFT = 1e-6  # N/m^2: the rest of the square does not hold its corner
STIFF = 1e6 / DT**2 / SOFT  # p_s of a row with 1e6 times the mass of the corner, 1 kg
CORNER = bp.mesh.rectangle(1.0, 1.0, 1, 1).rotated(math.pi / 4)  # node 0 is the lowest, mass density/4


def on_floor(method: Any, phase: float = 0.5, density: float = 4.0, young: float = 1.0, **options: Any) -> bp.Model:
    """The square over a rigid floor that its corner is first seen to have passed by `phase` v dt."""
    material = bp.LinearElastic(young, 0.0, density)
    square = bp.Body("square", options.pop("mesh", CORNER), material, velocity=(0, -SPEED), **options)
    floor = bp.HalfPlane("floor", point=(0, -(1 - phase) * SPEED * DT), normal=(0, 1))
    return bp.Model(bp.Scene([square], [bp.Contact("square", "floor")], obstacles=[floor]), method, dt=DT)


def on_body(method: Any, xi: float, densities: tuple[float, float], held: bool = False, **lower: Any) -> bp.Model:
    """The square over the middle segment of the top of a slab three units wide, at xi of that segment (to the left)."""
    slab = bp.mesh.rectangle(3.0, 0.5, 3, 1, element=lower.pop("element", "quad")).moved(-2 + xi, -0.5 - 0.5 * DT)
    young, poisson = lower.pop("young", 1.0), lower.pop("poisson", 0.0)
    square = bp.Body("square", CORNER, bp.LinearElastic(1.0, 0.0, densities[0]), velocity=(0, -SPEED))
    below = bp.Body("slab", slab, bp.LinearElastic(young, poisson, densities[1]), **lower)
    supports = [bp.Support("slab", "top")] if held else []
    return bp.Model(bp.Scene([square, below], [bp.Contact("square", "slab")], supports), method, dt=DT)


def first_row(model: bp.Model) -> tuple[float, float]:
    """Gap (m) and force (N/m) of the only row in the first step in contact."""
    for _ in range(10):
        model.step()
        if model._run.rows:
            ((gap, force),) = model._run.rows
            return gap, force
    raise AssertionError("no contact within ten steps")


def shares(method: Any, density: float, young: float = 1.0) -> tuple[float, float]:
    """lambda = a |g| + b v: a (N/m per m) and b (N s/m per m), from two phases of entry."""
    seen = [first_row(on_floor(method, phase, density, young)) for phase in (0.25, 0.75)]
    np.testing.assert_allclose([-gap for gap, _ in seen], [0.25 * SPEED * DT, 0.75 * SPEED * DT], rtol=1e-9)
    a, b = np.linalg.solve([[-gap, SPEED] for gap, _ in seen], [force for _, force in seen])
    return float(a), float(b)


def measured(method: Any, young: float = 1.0) -> tuple[float, float, float]:
    """alpha_s, alpha_m, alpha_d of a method that does not look at the mass of the row."""
    density = 4.0  # of the order of the penalty, else the difference between the two masses is round-off
    for _ in range(3):
        pair = [shares(method, d, young) for d in (density, 4 * density)]
        masses = np.array([density, 4 * density]) / 4
        # 1/a = 1/alpha_s + (P/alpha_s)/m
        inverse, ratio = np.linalg.solve([[1.0, 1 / m] for m in masses], [1 / a for a, _ in pair])
        density = 4 * max(abs(ratio / inverse), 1e-6)
    alpha_s, P = 1 / inverse, ratio / inverse
    alpha_d = alpha_s * pair[0][1] / pair[0][0]
    return alpha_s, P - DT / 2 * alpha_d, alpha_d


# ---- formulas of the rules


@pytest.mark.parametrize("s2", [None, 0.3, 1.0, 1.9])
@pytest.mark.parametrize("ps", [0.5, 3e4, 1e8])
def test_critical_rule(ps: float, s2: float | None) -> None:
    """alpha_s = ps E, alpha_m = alpha_s dt^2/s^2, alpha_d = 2 alpha_m/dt; s^2 = 1 unless given."""
    young = 7.0
    alpha_s, alpha_m, alpha_d = measured(bp.Bipenalty(ps, kappa=math.inf, s2=s2), young)
    expected = ps * young * DT**2 / (1.5 if s2 is None else s2)
    assert alpha_s == pytest.approx(ps * young, rel=1e-6)
    assert alpha_m == pytest.approx(expected, rel=1e-6)
    assert alpha_d == pytest.approx(2 * expected / DT, rel=1e-6)


@pytest.mark.parametrize(
    ("options", "ratio", "damping"),
    [
        ({}, 3.6, 0.0),
        ({"R_safety": 0.5}, 2.0, 0.0),
        ({"R": 1.7 / DT**2}, 1.7, 0.0),
        ({"D": 0.02}, 3.6, 0.02),
        ({"R": 1.7 / DT**2, "zeta": 0.8}, 1.7, 2 * 0.8 / math.sqrt(1.7 / DT**2)),
    ],
)
def test_published_rule(options: dict[str, float], ratio: float, damping: float) -> None:
    """alpha_m = alpha_s/R with R = 0.9 * 4/dt^2 unless given; alpha_d = D alpha_s or 2 zeta sqrt(alpha_s alpha_m)."""
    alpha_s, alpha_m, alpha_d = measured(bp.Bipenalty(1e5, rule="published", **options))
    assert alpha_s == pytest.approx(1e5, rel=1e-6)
    assert alpha_m == pytest.approx(1e5 * DT**2 / ratio, rel=1e-6)
    assert alpha_d == pytest.approx(1e5 * damping, rel=1e-6, abs=1e-6 * alpha_m / DT)


@pytest.mark.parametrize("kappa", [None, 0.7, 100.0])
@pytest.mark.parametrize("density", [0.4, 40.0])
def test_cap_of_the_parameter_free_method(density: float, kappa: float | None) -> None:
    """alpha_s = kappa m/dt^2 on a rigid floor, kappa = 5 unless given; P = 2 alpha_m = 2 kappa m / s2, s2 = 1.5."""
    cap, mass = 5.0 if kappa is None else kappa, density / 4
    inertia = 2 * cap / 1.5
    a, b = shares(bp.Bipenalty(kappa=kappa), density)
    assert a == pytest.approx(cap * mass / DT**2 / (1 + inertia), rel=1e-9)
    assert b == pytest.approx(inertia * mass / DT / (1 + inertia), rel=1e-9)


def test_cap_holds_only_what_is_above_it() -> None:
    """min(ps E, kappa m/dt^2): below the cap nothing changes, above it ps does not matter."""
    cap = 5.0 * 1.0 / DT**2  # m = 1 kg
    for below in (0.2 * cap, 0.999 * cap):
        assert shares(bp.Bipenalty(below), 4.0) == shares(bp.Bipenalty(below, kappa=math.inf), 4.0)
    auto = shares(bp.Bipenalty(), 4.0)
    for above in (1.001 * cap, 1e3 * cap, 1e300):
        assert shares(bp.Bipenalty(above), 4.0) == auto
    assert shares(bp.Bipenalty(1.001 * cap, kappa=math.inf), 4.0) != auto


@pytest.mark.parametrize(("xi", "held"), [(0.25, False), (0.5, False), (0.9, False), (0.25, True)])
@pytest.mark.parametrize("densities", [(4.0, 1.0), (0.4, 80.0)])
def test_effective_mass_of_a_row_between_two_bodies(xi: float, held: bool, densities: tuple[float, float]) -> None:
    """m_e = 1/(1/m_s + (1-xi)^2/m_1 + xi^2/m_2), without the nodes that a support holds."""
    secondary = densities[0] / 4
    primary = 2 * densities[1] * 0.5 / 4  # two elements of 1 by 0.5 share each of the two nodes
    inverse = 1 / secondary + (0.0 if held else ((1 - xi) ** 2 + xi**2) / primary)
    gap, force = first_row(on_body(bp.Bipenalty(kappa=3.0, rule="published"), xi, densities, held))
    assert gap == pytest.approx(-0.5 * SPEED * DT, rel=1e-9)
    # published: alpha_m = alpha_s dt^2/3.6, so P = alpha_m = (3/3.6) m_e
    assert force / -gap == pytest.approx(3.0 / inverse / DT**2 / (1 + 3.0 / 3.6), rel=1e-9)


def test_effective_mass_of_a_node_held_in_one_axis() -> None:
    """A corner that may not move along x against an oblique floor: m_e = m / n_y^2."""
    square = bp.Body("square", CORNER, bp.LinearElastic(1.0, 0.0, 4.0), velocity=(0, -SPEED))
    floor = bp.HalfPlane("floor", point=(0, -0.5 * SPEED * DT), normal=(0.6, 0.8))
    held = bp.Support("square", np.arange(4), y=False)
    scene = bp.Scene([square], [bp.Contact("square", "floor")], [held], [floor])
    gap, force = first_row(bp.Model(scene, bp.Bipenalty(kappa=3.0, rule="published"), dt=DT))
    assert gap == pytest.approx(-0.8 * 0.5 * SPEED * DT, rel=1e-9)
    assert force / -gap == pytest.approx(3.0 / 0.8**2 / DT**2 / (1 + 3.0 / 3.6), rel=1e-9)


@pytest.mark.parametrize("scale", [0.1, 2.0])
@pytest.mark.parametrize(("element", "volume"), [("quad", 0.5), ("triangle", 0.25)])
def test_element_stiffness_of_the_primary_segment(scale: float, element: str, volume: float) -> None:
    """alpha_s = f_s K A^2/V of the element behind the segment (Hallquist, Goudreau, Benson 1985), not the node."""
    young, poisson, thickness = 30.0, 0.3, 0.2
    model = on_body(bp.ElementStiffness(scale), 0.3, (4.0, 1e4), element=element, young=young, poisson=poisson,
                    thickness=thickness)  # fmt: skip
    gap, force = first_row(model)
    bulk = young / (3 * (1 - 2 * poisson))
    assert force / -gap == pytest.approx(scale * bulk * thickness**2 / (volume * thickness), rel=1e-9)


def test_element_stiffness_at_a_rigid_obstacle() -> None:
    """The mean of the two edges that meet at the node; a block of 2 by 1, so edges of 2 and 1 before an area of 2."""
    mesh = bp.mesh.rectangle(2.0, 1.0, 1, 1).rotated(math.pi / 4)
    gap, force = first_row(on_floor(bp.ElementStiffness(0.1), mesh=mesh, young=3.0))
    assert force / -gap == pytest.approx(0.1 * (3.0 / 3) * 0.5 * (4 / 2 + 1 / 2), rel=1e-9)


@pytest.mark.parametrize("scale", [0.1, 1.0])
@pytest.mark.parametrize(("densities", "smallest"), [((4.0, 80.0), 1.0), ((400.0, 80.0), 20.0)])
def test_nodal_mass_stiffness(scale: float, densities: tuple[float, float], smallest: float) -> None:
    """alpha_s = 0.5 SOFSCL m*/dt^2, m* the smallest nodal mass of the row, be it the node's or the segment's."""
    gap, force = first_row(on_body(bp.NodalMassStiffness(scale), 0.3, densities))
    assert force / -gap == pytest.approx(0.5 * scale * smallest / DT**2, rel=1e-9)


def test_stiffness_takes_the_stiffer_body() -> None:
    """alpha_s = ps E_max of the pair; D adds alpha_d = D alpha_s, centred: lambda = m/(m + dt/2 alpha_d) (...)."""
    gap, force = first_row(on_body(bp.Stiffness(3.0), 0.3, (4.0, 80.0), young=50.0))
    assert force / -gap == pytest.approx(150.0, rel=1e-9)
    alpha_s, alpha_m, alpha_d = measured(bp.Stiffness(1e5, D=0.02))
    assert (alpha_s, alpha_d) == (pytest.approx(1e5, rel=1e-6), pytest.approx(2e3, rel=1e-6))
    assert abs(alpha_m) < 1e-6 * DT * alpha_d


# ---- what one step of the critical rule does


@pytest.mark.parametrize("heavy", [0.3, 10.0, 1e8])
@pytest.mark.parametrize("s2", [0.5, 1.0, 1.9])
@pytest.mark.parametrize("phase", [0.05, 0.5, 1.0])
def test_entering_velocity_is_gone_after_one_step(phase: float, s2: float, heavy: float) -> None:
    """v+ = v m/(m + P) + (s^2/2) P/(m + P) g/dt: for P >> m the way back of s^2/2 |g| a step and nothing else."""
    alpha_m = heavy / 2  # P = 2 alpha_m, m = 1
    model = on_floor(bp.Bipenalty(alpha_m * s2 / DT**2, kappa=math.inf, s2=s2), phase)
    gap, _ = first_row(model)
    share = heavy / (1 + heavy)
    expected = -SPEED * (1 - share) - s2 / 2 * share * gap / DT
    assert model.velocity[0, 1] == pytest.approx(expected, abs=1e-12 + 1e-15 * heavy)


@pytest.mark.parametrize("s2", [0.5, 1.0, 1.9])
@pytest.mark.parametrize("phase", [0.05, 0.6, 1.0])
def test_gap_decays_without_crossing_zero(phase: float, s2: float) -> None:
    """g -> (1 - s^2/2) g a step, for as long as the rest of the square does not push: g stays below zero."""
    model = on_floor(bp.Bipenalty(STIFF, kappa=math.inf, s2=s2), phase, young=SOFT)
    gaps = [first_row(model)[0]]
    while gaps[-1] < -1e-5 * SPEED * DT:
        model.step()
        gaps += [gap for gap, _ in model._run.rows]
        assert model.steps < 60
    np.testing.assert_allclose(gaps[1:], (1 - s2 / 2) * np.array(gaps[:-1]), rtol=1e-3)
    assert max(gaps) < 0
    assert len(gaps) > 3


# ---- restitution of one stiff row


@pytest.mark.parametrize("phase", [0.07, 0.37, 0.5, 0.83, 1.0])
@pytest.mark.parametrize(("s2", "zeta"), [(3.6, 0.0), (3.6, 1.0), (2.0, 0.0), (1.0, 0.5), (0.25, 0.0), (4.0, 0.1)])
def test_restitution_of_one_stiff_row(s2: float, zeta: float, phase: float) -> None:
    """A corner on a row of some 1e6 times its mass leaves with the velocity that the map gives."""
    model = on_floor(bp.Bipenalty(STIFF, rule="published", R=s2 / DT**2, zeta=zeta), phase, young=SOFT)
    first_row(model)
    while model._run.rows:
        model.step()
        assert model.steps < 40
    assert model.velocity[0, 1] == pytest.approx(float(bp.restitution(phase, math.sqrt(s2), zeta)), abs=3e-5)


@pytest.mark.parametrize("s2", [0.5, 1.0, 1.9])
def test_critical_row_does_not_throw_back(s2: float) -> None:
    """Restitution 0: as long as nothing pushes, the row is still closed after 200 steps and the corner at rest."""
    model = on_floor(bp.Bipenalty(STIFF, kappa=math.inf, s2=s2), 0.6, young=SOFT)
    first_row(model)
    model.step(200)
    assert abs(model.velocity[0, 1]) < 1e-6 * SPEED


# ---- bounds of the parameters


@pytest.mark.parametrize(
    ("options", "named"),
    [
        *(({"s2": value}, "s2") for value in (0.0, 2.0, -1.0, 4.0, math.nan, math.inf)),
        *(({"kappa": value}, "kappa") for value in (0.0, -1.0, math.nan, -math.inf)),
        ({"kappa": math.inf}, "kappa"),
        ({"rule": "published"}, "(ps|kappa)"),
        ({"ps": "auto", "rule": "published", "kappa": math.inf}, "kappa"),
        *(({"ps": 1.0, name: 1.0}, name) for name in ("R", "R_safety", "D", "zeta")),
        ({"ps": 1.0, "rule": "published", "s2": 1.0}, "s2"),
        ({"ps": 1.0, "rule": "published", "D": 0.1, "zeta": 0.1}, "D and zeta"),
        ({"ps": 1.0, "rule": "published", "R": 1e6, "R_safety": 0.9}, "R"),
        ({"ps": 1.0, "rule": "Critical"}, "rule"),
        ({"ps": "much"}, "ps"),
        *(({"ps": value}, "ps") for value in (-1.0, math.nan, math.inf)),
        *(({"ps": 1.0, "rule": "published", "R": value}, "R") for value in (0.0, -1.0, math.inf, math.nan)),
        *(({"ps": 1.0, "rule": "published", "R_safety": value}, "R_safety") for value in (0.0, -1.0, math.nan)),
        *(({"ps": 1.0, "rule": "published", "D": value}, "D") for value in (-1.0, math.inf)),
        *(({"ps": 1.0, "rule": "published", "zeta": value}, "zeta") for value in (-1.0, math.nan)),
    ],
    ids=str,
)
def test_bipenalty_refuses(options: dict[str, Any], named: str) -> None:
    """Out of bounds, or a parameter of the other rule: the message names it and says what to do."""
    with pytest.raises(bp.InputError, match=rf"^Bipenalty: {named}\b.*, must be .+; .+"):
        bp.Bipenalty(**options)


@pytest.mark.parametrize("kind", [bp.ElementStiffness, bp.NodalMassStiffness])
@pytest.mark.parametrize("scale", [0.0, -0.1, math.nan, math.inf])
def test_rules_in_use_refuse(kind: Any, scale: float) -> None:
    with pytest.raises(bp.InputError, match=rf"^{kind.__name__}: scale\b.*, must be > 0"):
        kind(scale)


def test_what_lies_within_the_bounds_is_taken() -> None:
    for options in ({}, {"kappa": 1e-3}, {"kappa": 1e300}, {"ps": 0.0}, {"s2": 1e-6}, {"s2": 1.999999},
                    {"ps": 1.0, "kappa": math.inf}, {"ps": "auto", "rule": "published", "kappa": 5.0}):  # fmt: skip
        bp.Bipenalty(**options)  # type: ignore[arg-type]
