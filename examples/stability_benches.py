"""The two benches of the stability study: a bar thrown at a wall, and two cylinders that collide. SI units.

Each runs a list of methods at one time step and says what every run got wrong.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr

import bipenalty as bp
from bipenalty import force_error
from bipenalty.methods import Method

PHASES = 5  # phases of entry of the bar: where within a step contact begins


def runs(scene: bp.Scene, methods: Sequence[Method], t_end: float, dt: float, limit: float | None = None) -> xr.Dataset:
    """A sweep at a time step that may be past the limit; Ctrl-C ends the study."""
    options = {"allow_unstable": True, "displacement_limit": limit, "histories": True, "show_progress": False}
    sweep = bp.sweep(scene, methods, t_end, dt=dt, **options)
    if sweep.attrs["interrupted"]:
        raise SystemExit("interrupted: nothing was written")
    return sweep


def judged(sweep: xr.Dataset, reference: force_error.Impulse, width: float, speed: float) -> xr.Dataset:
    """What each run of a sweep got wrong; penetration over that of one step at the speed of approach (m/s)."""
    wrong = force_error.of_sweep(sweep, reference, width).drop_vars(("method", "ps"))
    wrong["energy_ratio"] = sweep["energy_ratio"]
    depth = sweep["max_penetration"] / (speed * sweep.attrs["dt"])
    wrong["penetration"] = depth.assign_attrs(units="1", long_name="deepest penetration over v_n dt")
    wrong["stopped"] = sweep["failed"].assign_attrs(units="1", long_name="stopped before its end: diverged")
    wrong["outcome"] = sweep["outcome"]
    return wrong.drop_vars(("method", "ps", "D", "R", "zeta", "time"), errors="ignore")


class Bar:
    """A bar of 10 m, E = 900 N/m^2, rho = 1 kg/m^3 (c = 30 m/s), thrown at 10 m/s at a rigid wall 5 m away.

    Doyen, Ern, Piperno (2011), SIAM J. Sci. Comput. 33, 223-249, first benchmark. Exact: rho c v = 300 N/m for
    2L/c = 2/3 s. One row of quads with nu = 0 moves as a bar; its height is 1 m, so E A = 900 N.
    """

    kind, mark, factor = "bar", "β", "too soft  ←  β = $α_s h/(EA)$ (–)  →  stiff"
    reference = "the exact one, after a moving average over one element transit, the worst of five phases of entry"

    def __init__(self, elements: int, courant: float = 0.9) -> None:
        usual = courant == 0.9
        self.name, self.symbol = ("bar", "beta") if usual else (f"bar, Courant {courant:g}", f"beta, S = {courant:g}")
        self.mesh = bp.mesh.rectangle(10.0, 1.0, elements, 1)
        self.transit = 10.0 / elements / 30.0  # of a wave through one element, s
        self.step = courant * self.transit
        self.limits = bp.Model(self.scene(5.0)).critical_step()

    def scene(self, gap: float) -> bp.Scene:
        """The bar at a gap (m) from the wall."""
        bar = bp.Body("bar", self.mesh, bp.LinearElastic(young=900, poisson=0, density=1), velocity=(-10, 0))
        wall = bp.HalfPlane("wall", point=(-gap, 0), normal=(1, 0))
        return bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])

    def ps(self, factor: float) -> float:
        """p_s for a beta: alpha_s of the section is shared by its two nodes."""
        return factor / (2 * 30.0 * self.transit)

    def run(self, methods: Sequence[Method], dt: float | None = None) -> xr.Dataset:
        """The worst of five phases of entry, each judged after an average over one element transit."""
        dt = self.step if dt is None else dt
        phases = []
        for gap in 5.0 + np.arange(PHASES) * 10.0 * dt / PHASES:
            sweep = runs(self.scene(gap), methods, 2.0, dt)
            start = gap / 10.0
            exact = lambda t, start=start: 300.0 * np.clip(t - start, 0.0, 2 / 3)  # noqa: E731
            phases.append(judged(sweep, exact, self.transit, 10.0))
        return worst(xr.concat(phases, "phase"))


class Cylinders:
    """Two discs of radius 1 m, rho = 0.1 kg/m^3, nu = 0.2: 100 N/m^2 thrown at 1000 N/m^2 at 2 m/s and 45 degrees.

    The force is compared with that of the parameter-free method at 1/16 of the time step on the same mesh. How far
    that is converged, and how far it agrees with another method (stiffness penalty, p_s = 100, D = 1e-5 s, at 1/64 of
    the time step), `reference` says.
    """

    kind, mark, factor = "cylinders", "$p_s$", "too soft  ←  $p_s$ (–)  →  stiff"
    width, t_end, speed = 5e-4, 0.18, 2**0.5  # s, s, m/s

    def __init__(self, segments: int, passes: int) -> None:
        names = {1: ("cylinders", "p_s"), 2: ("cylinders, two passes", "p_s, two passes")}
        self.name, self.symbol = names[passes]
        disc = bp.mesh.disc(radius=1.0, segments=segments)
        stiff, soft = (bp.LinearElastic(young, poisson=0.2, density=0.1) for young in (1000, 100))
        top = bp.Body("top", disc.moved(0, 2), stiff)
        bottom = bp.Body("bottom", disc, soft, velocity=(2**0.5, 2**0.5))
        self.scene = bp.Scene([top, bottom], contacts=[bp.Contact("top", "bottom", passes)])
        model = bp.Model(self.scene)
        self.step, self.limits = model.dt, model.critical_step()  # half the elements' limit
        fine = ((bp.Bipenalty(), 16), (bp.Bipenalty(), 8), (bp.Stiffness(100.0, D=1e-5), 64))
        sweeps = [runs(self.scene, [method], self.t_end, self.step / share) for method, share in fine]
        self.impulse = force_error.impulse_of(sweeps[0]["contact_force"].values[0], sweeps[0].attrs["dt"])
        coarser, other = (float(self.judged(sweep)["force_error"][0]) for sweep in sweeps[1:])
        self.reference = (
            f"the parameter-free method at dt/16, after a moving average over 0.5 ms; at dt/8 it differs by "
            f"{coarser:.1e}, the damped stiffness penalty at dt/64 by {other:.1e}"
        )

    def judged(self, sweep: xr.Dataset) -> xr.Dataset:
        """What each run of a sweep got wrong."""
        return judged(sweep, self.impulse, self.width, self.speed)

    def ps(self, factor: float) -> float:
        """The factor is p_s."""
        return factor

    def run(self, methods: Sequence[Method], dt: float | None = None) -> xr.Dataset:
        """Each run judged; a displacement beyond 1 m has failed."""
        return self.judged(runs(self.scene, methods, self.t_end, self.step if dt is None else dt, limit=1.0))


Bench = Bar | Cylinders


def worst(phases: xr.Dataset) -> xr.Dataset:
    """The worst over the dimension `phase` of all that was measured; NaN where a run diverged."""
    found = phases.drop_vars("outcome").max("phase", skipna=False, keep_attrs=True)
    far = abs(phases["energy_ratio"] - 1).fillna(np.inf).argmax("phase")
    found["energy_ratio"] = phases["energy_ratio"].isel(phase=far)
    impulse = abs(phases["impulse_error"]).fillna(np.inf).argmax("phase")
    found["impulse_error"] = phases["impulse_error"].isel(phase=impulse)
    bad = (phases["outcome"] != "finished").argmax("phase")
    found["outcome"] = phases["outcome"].isel(phase=bad)
    return found
