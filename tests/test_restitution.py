"""The restitution map against closed forms, its published figures, and the energy a row makes of it in a run."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

import bipenalty as bp

PHASES = (np.arange(4000) + 1) / 4000


def by_hand(theta: float, s: float, zeta: float) -> float:
    """One row in plain floats: w' = [(1 - zeta s) w - s^2 g]/(1 + zeta s), g' = g + w' from w = -1, g = -theta."""
    gap, velocity = -theta, -1.0
    for _ in range(10_000):
        velocity = ((1 - zeta * s) * velocity - s * s * gap) / (1 + zeta * s)
        gap += velocity
        if gap >= 0:
            return velocity
    return 0.0


def undamped_published(theta: NDArray[np.float64]) -> NDArray[np.float64]:
    """R dt^2 = 3.6, zeta = 0: open after one step from theta = 1/2.6 on, after two below."""
    return np.where(2.6 * theta >= 1, 3.6 * theta - 1, 2.6 - 5.76 * theta)


@pytest.mark.parametrize("zeta", [0.0, 0.2, 1.0, 1.7])
@pytest.mark.parametrize("s2", [0.01, 0.7, 2.0, 3.6, 4.0])
def test_map_is_the_recursion(s2: float, zeta: float) -> None:
    theta = np.linspace(0.013, 1.0, 37)
    expected = [by_hand(float(t), math.sqrt(s2), zeta) for t in theta]
    np.testing.assert_allclose(bp.restitution(theta, math.sqrt(s2), zeta), expected, atol=1e-12)


def test_published_choice_throws_back_faster_than_it_was_hit() -> None:
    """R = 0.9 * 4/dt^2, zeta = 0: sup|e| = 2.6, at both ends of the phase; mean of e^2 = 2.636, in closed form."""
    e = bp.restitution(PHASES, math.sqrt(3.6), 0.0)
    np.testing.assert_allclose(e, undamped_published(PHASES), atol=1e-12)
    chart = bp.restitution_map([3.6], [0.0, 1.0], phases=4000)
    assert chart.largest[0, 0] == pytest.approx(2.6, abs=1e-12)
    third = (2.6**3 - (2.6 - 5.76 / 2.6) ** 3) / (3 * 5.76) + (2.6**3 - (3.6 / 2.6 - 1) ** 3) / (3 * 3.6)
    assert third == pytest.approx(2.6, abs=0.05)
    assert chart.mean_square[0, 0] == pytest.approx(third, abs=1e-3)
    # with zeta = 1: sup|e| = 1.55, at theta = 1, still more than 1
    s = math.sqrt(3.6)
    assert chart.largest[1, 0] == pytest.approx((s**2 - 1 + s) / (1 + s), abs=1e-12)
    assert chart.largest[1, 0] == pytest.approx(1.55, abs=0.005)


def test_undamped_below_half_the_limit_is_between_1_and_1_25() -> None:
    """R <= 2/dt^2, zeta = 0: sup|e| is 1.00 to 1.25, 1.00 for s -> 0 and at s^2 = 1 and 2, 1.25 at s^2 = 1.5."""
    s2 = np.linspace(0.01, 2.0, 200)
    largest = bp.restitution_map(s2, [0.0], phases=2000).largest[0]
    assert largest.min() >= 1.0 - 1e-12
    assert largest.max() == pytest.approx(1.25, abs=2e-3)
    assert s2[largest.argmax()] == pytest.approx(1.5, abs=0.02)
    assert bp.restitution_map([1e-4, 1.0, 2.0], [0.0], phases=1000).largest[0] == pytest.approx([1.0] * 3, abs=1e-4)


def test_critical_damping_gives_nothing_back() -> None:
    """zeta s = 1: exactly 0 for every phase and s^2 < 2; at s^2 = 2 the gap is zero after a step, above it crosses."""
    s2 = np.linspace(0.004, 1.996, 250)
    s = np.sqrt(s2)
    assert np.all(bp.restitution(PHASES[::40, None], s, 1 / s) == 0.0)
    chart = bp.restitution_map(s2[::25], 1 / s[::25], phases=50)
    assert np.all(np.diagonal(chart.largest) == 0.0)
    above = np.sqrt(np.linspace(2.01, 3.99, 40))
    np.testing.assert_allclose(bp.restitution(PHASES[::40, None], above, 1 / above), above**2 / 2 * PHASES[::40, None],
                               atol=1e-12)  # fmt: skip


def test_map_is_the_largest_and_the_mean_square_of_the_restitution() -> None:
    s2, zeta = [0.5, 1.3, 3.0], [0.0, 0.6]
    chart = bp.restitution_map(s2, zeta, phases=100)
    assert chart.largest.shape == chart.mean_square.shape == (2, 3)
    theta = (np.arange(100) + 1) / 100
    for i, z in enumerate(zeta):
        for j, r in enumerate(s2):
            e = bp.restitution(theta, math.sqrt(r), z)
            assert chart.largest[i, j] == np.abs(e).max()
            assert chart.mean_square[i, j] == pytest.approx(np.mean(e**2), rel=1e-12)
    assert np.array_equal(chart.s2, s2)
    assert np.array_equal(chart.zeta, zeta)


@pytest.mark.parametrize("zeta", [0.0, 0.3])
@pytest.mark.parametrize("phase", [0.05, 0.3, 0.6, 1.0])
def test_row_makes_the_energy_the_map_says(phase: float, zeta: float) -> None:
    """One corner of mass m on a stiff row: the bodies' energy changes by m v^2 (e^2 - 1)/2, which is what is reported.

    The floor is soft enough for nothing else of the square to feel it: the square keeps m v^2 3/2 in its other corners.
    """
    dt, soft, s2 = 1e-3, 1e-6, 3.6
    square = bp.Body("square", bp.mesh.rectangle(1.0, 1.0, 1, 1).rotated(math.pi / 4), bp.LinearElastic(soft, 0.0, 4.0),
                     velocity=(0, -1.0))  # fmt: skip
    floor = bp.HalfPlane("floor", point=(0, -(1 - phase) * dt), normal=(0, 1))
    method = bp.Bipenalty(1e6 / dt**2 / soft, rule="published", R=s2 / dt**2, zeta=zeta)
    model = bp.Model(bp.Scene([square], [bp.Contact("square", "floor")], obstacles=[floor]), method, dt=dt)
    result = model.run(12 * dt, energy_every=1)
    assert result.active_rows[-1] == 0
    gained = float((result.kinetic_energy + result.strain_energy)[-1] - result.kinetic_energy[0])
    e = float(bp.restitution(phase, math.sqrt(s2), zeta))
    assert gained == pytest.approx(0.5 * (e**2 - 1), abs=1e-4)
    assert result.energy_ratio == pytest.approx(1 + gained / 2.0, abs=1e-4)
    assert result.energy_made == pytest.approx(max(0.0, gained / 2.0), abs=1e-4)
    assert (result.outcome == "energy made by contact") == (gained / 2.0 > 0.05)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [((0.0, 1.0, 1.0), "theta"), ((1.1, 1.0, 1.0), "theta"), ((math.nan, 1.0, 1.0), "theta"), ((0.5, 0.0, 1.0), "s"),
     ((0.5, 2.01, 1.0), "s"), ((0.5, 1.0, -0.1), "zeta"), ((0.5, 1.0, math.inf), "zeta")],
)  # fmt: skip
def test_restitution_refuses(arguments: tuple[float, float, float], named: str) -> None:
    with pytest.raises(bp.InputError, match=rf"restitution: {named} = .*, must be"):
        bp.restitution(*arguments)
    with pytest.raises(bp.InputError, match="phases"):
        bp.restitution_map([1.0], [1.0], phases=0)
