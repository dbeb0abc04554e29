"""Two dissimilar cylinders collide: eight penalty methods over seven decades of the stiffness penalty factor p_s.

A published comparison of penalty methods for explicit contact-impact, repeated. A disc of 1000 N/m^2 is at rest; one
of 100 N/m^2 hits it from below at 2 m/s, diagonally up and to the right. Plane strain, no friction, SI units.

    python examples/penalty_sweep.py              (make sweep)  all of it, into out/
    python examples/penalty_sweep.py --quick      coarse discs and one p_s a decade, in a few seconds
    python examples/penalty_sweep.py --passes 1   contact searched from one side only

Writes penalty_sweep.csv, penalty_sweep.nc, deformation.png, penetration.png and force.png. Ctrl-C ends the sweep and
writes what there is.
"""

import argparse
import csv
import functools
from pathlib import Path

import numpy as np
import xarray as xr

import bipenalty as bp
from bipenalty import plot

T_END = 0.18  # s
DAMPINGS = (None, 0.01, 0.001, 0.0001)  # D = alpha_d / alpha_s, s
NUMBERS = ("max_penetration", "max_displacement", "peak_force", "impulse", "energy_ratio")
COLUMNS = ("method", "ps", "D", *NUMBERS, "failed", "reason", "seconds")
CLAIMS = {  # titles of the figures; `check` holds them to it
    "deformation": "The soft cylinder flattens, slides to the right along the stiff one and parts from it",
    "penetration": "At large $p_s$ stiffness goes unstable, bipenalty makes energy; damped, bipenalty never fails",
    "force": "The force converges as $p_s$ grows, then drowns in noise; a little damping keeps it clean",
}


def collision(segments: int, passes: int) -> bp.Scene:
    """The two cylinders, about to touch."""
    disc = bp.mesh.disc(radius=1.0, segments=segments)
    stiff, soft = (bp.LinearElastic(young, poisson=0.2, density=0.1) for young in (1000, 100))  # N/m^2, -, kg/m^3
    top = bp.Body("top", disc.moved(0, 2), stiff)
    bottom = bp.Body("bottom", disc, soft, velocity=(2**0.5, 2**0.5))  # m/s
    return bp.Scene([top, bottom], contacts=[bp.Contact("top", "bottom", passes)])


def by_method(sweep: xr.Dataset) -> dict[str, xr.Dataset]:
    """The runs of each method, in the order of p_s."""
    labels = sweep["method"].values
    return {str(m): sweep.isel(run=np.flatnonzero(labels == m)).sortby("ps") for m in dict.fromkeys(labels)}


def write_table(sweep: xr.Dataset, path: Path) -> None:
    """One line for each run that has ended, finished or failed, with every digit."""
    ended = sweep.isel(run=np.flatnonzero(sweep["finished"] | sweep["failed"]))
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(COLUMNS)
        table.writerows(zip(*(ended[name].values.tolist() for name in COLUMNS), strict=True))


def draw(sweep: xr.Dataset, run: bp.Result, out: Path, titles: dict[str, str]) -> None:
    """The three figures."""
    figures = {
        "deformation": plot.deformation(run, title=titles.get("deformation")),
        "penetration": plot.penetration(sweep, title=titles.get("penetration")),
        "force": plot.force(sweep, t_end=0.1, limits=(-1, 7), title=titles.get("force")),
    }
    for name, figure in figures.items():
        figure.savefig(out / f"{name}.png", dpi=150)


def report(sweep: xr.Dataset) -> None:
    """For each method the p_s where it is good, from where it makes energy, and from where runs fail and why."""
    print("\np_s with    penetration < 1 mm, energy to 1 %,   energy made   failed run")
    print("method                      force < 5 N/m           > 1 % from      from")
    for method, runs in by_method(sweep).items():
        ps, energy, failed = (runs[name].values for name in ("ps", "energy_ratio", "failed"))
        good = runs["finished"].values & (runs["max_penetration"].values < 1e-3)
        good &= (abs(energy - 1) < 0.01) & (runs["peak_force"].values < 5)  # the force of a clean run peaks at 3.9
        first = int(np.argmax(good))
        last = first + int(np.argmin([*good[first:], False])) - 1
        window = f"{ps[first]:.3g} to {ps[last]:.3g}" if good.any() else "none"
        made = f"{ps[np.argmax(energy > 1.01)]:.3g}" if (energy > 1.01).any() else "none"
        fails = f"{ps[np.argmax(failed)]:.3g}" if failed.any() else "none"
        why = str(runs["outcome"].values[np.argmax(failed)]) if failed.any() else ""
        print(f"{method:24} {window:>18} {made:>17} {fails:>12}  {why}".rstrip())


def check_setup(model: bp.Model) -> None:
    """The published time step and penalty ratio."""
    assert abs(model.dt / 9.46e-5 - 1) < 0.02, f"the time step is {model.dt:.3e} s, not the published 9.46e-5 s"
    assert abs(model.R / 4.02e8 - 1) < 0.02, f"the penalty ratio is {model.R:.3e} 1/s^2, not the published 4.02e8"


def check(sweep: xr.Dataset, run: bp.Result, passes: int) -> None:
    """The numbers of the study, and what the titles of the figures claim."""
    assert run.contact_force[-1] == 0, f"at {T_END} s the cylinders still touch"
    methods = by_method(sweep)
    plain, mass, damped = (methods[m] for m in ("stiffness", "bipenalty", "bipenalty (D = 0.0001)"))
    ps = plain["ps"].values
    depth, impulse = (np.array([r[n].values for r in methods.values()]) for n in ("max_penetration", "impulse"))
    spread = np.ptp(depth, axis=0) / depth.mean(axis=0)
    assert (spread[ps < 0.11] < 0.06).all(), f"up to p_s = 0.1 the methods differ by {spread[ps < 0.11].max():.1%}"
    at_one = impulse[:, np.isclose(ps, 1)]
    assert (abs(at_one / 0.404 - 1) < 0.01).all(), f"the impulses at p_s = 1 are {at_one.T} N s/m, not 0.404"
    for runs in (plain, mass):
        best = ps[np.nanargmin(runs["max_penetration"].where(runs["finished"]))]
        assert 1 <= best < 10.1, f"undamped, p_s = {best:.3g} penetrates least, not one of 1 to 10"
    assert plain["failed"].values[ps > 99].all(), "the stiffness method gets through p_s = 100 or more"
    unstable = plain["outcome"].values[plain["failed"]] == "spectral instability"
    assert unstable.all(), "the stiffness method fails for another reason than its time step"
    assert (mass["energy_ratio"].values[ps > 999] > 1.5).all(), "bipenalty without damping keeps its energy"
    assert mass["failed"].any() or passes == 1, "bipenalty without damping gets through"
    safe = [runs["finished"].all() for name, runs in methods.items() if name.startswith("bipenalty (D")]
    assert all(safe), "bipenalty with damping fails"
    peaks = [float(runs["peak_force"].values[np.isclose(ps, 10)][0]) for runs in (plain, mass, damped)]
    assert peaks[0] > peaks[1] > 1.5 * peaks[2], f"the peak forces at p_s = 10 do not fall as in the titles: {peaks}"
    assert abs(peaks[2] - 3.9) < 0.1, f"the damped force at p_s = 10 peaks at {peaks[2]:.3g}, not at 3.9 N/m"


def main() -> None:
    """Sweep, write, draw, report, check."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder to write to (out)")
    parser.add_argument("--passes", type=int, choices=(1, 2), default=2, help="contact passes (2)")
    parser.add_argument("--quick", action="store_true", help="coarse discs and one p_s a decade")
    chosen = parser.parse_args()
    grid = np.logspace(-2, 5, 8 if chosen.quick else 29)  # holds every power of ten
    published = functools.partial(bp.Bipenalty, rule="published")
    methods = [kind(ps, D=D) for kind in (bp.Stiffness, published) for D in DAMPINGS for ps in grid]

    scene = collision(40 if chosen.quick else 116, chosen.passes)
    model = bp.Model(scene, bp.Bipenalty(ps=1.0, rule="published"))
    print(f"dt = {model.dt:.3e} s, R = {model.R:.3e} 1/s^2, {len(methods)} runs of {T_END / model.dt:.0f} steps")
    if not chosen.quick:
        check_setup(model)
    run = model.run(T_END, snapshots=np.linspace(0, T_END, 6))
    sweep = bp.sweep(scene, methods, T_END, displacement_limit=1.0, histories=True)

    full = not chosen.quick and not sweep.attrs["interrupted"]
    out = chosen.out
    out.mkdir(parents=True, exist_ok=True)
    write_table(sweep, out / "penalty_sweep.csv")
    bp.io.write_netcdf(sweep, out / "penalty_sweep.nc")
    draw(sweep, run, out, CLAIMS if full else {})
    if sweep.attrs["interrupted"]:
        raise SystemExit(f"interrupted: {out} holds what there is, the table only the runs that had ended")
    report(sweep)
    print(f"\nwritten to {out}: penalty_sweep.csv and .nc, deformation.png, penetration.png, force.png")
    if full:
        check(sweep, run, chosen.passes)


if __name__ == "__main__":
    main()
