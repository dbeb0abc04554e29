"""Which penalty method holds where: force error and energy over p_s, over R dt^2 and zeta, and over the time step.

Two benches, each against the force it should give: a bar thrown at a rigid wall (exact) and two colliding cylinders
(converged on the same mesh). What a bench is and how it is judged says `stability_benches.py`, what is asserted
`stability_report.py`.

    python examples/stability.py            (make stability)  all of it, into out/
    python examples/stability.py --quick    coarse meshes and few parameters, in a few seconds

Writes stability.nc, stability_ps.png, stability_R_zeta.png, stability_dt.png and restitution.png.
"""

import argparse
import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from stability_benches import Bar, Bench, Cylinders
from stability_report import OURS, check, report

import bipenalty as bp
from bipenalty.methods import Method
from bipenalty.plot.restitution_figure import restitution, restitution_and_runs
from bipenalty.plot.stability_figure import stability
from bipenalty.row_restitution import RestitutionMap

METHODS: dict[str, Callable[[float], Method]] = {
    "stiffness": bp.Stiffness,
    "element stiffness (0.1)": lambda ps: bp.ElementStiffness(0.1),
    "nodal mass stiffness (0.1)": lambda ps: bp.NodalMassStiffness(0.1),
    "bipenalty, published": lambda ps: bp.Bipenalty(ps, rule="published"),
    "published, D = 1e-4 s": lambda ps: bp.Bipenalty(ps, rule="published", D=1e-4),
    "published, ζ = 1": lambda ps: bp.Bipenalty(ps, rule="published", zeta=1.0),
    "critical, no cap": lambda ps: bp.Bipenalty(ps, kappa=math.inf),
    "critical": bp.Bipenalty,
    "parameter-free": lambda ps: bp.Bipenalty(),
}
LARGE, USUAL = 1e3, {"bar": 1.0, "cylinders": 10.0}  # p_s or beta of the other two charts
CLAIMS = {
    "ps": "Every other method breaks or is too soft; critical holds from $p_s$ = 1 on, parameter-free always",
    "R_zeta": "Whole runs hold only where one row gives little back: critical (●) inside, published (✖) far out",
    "dt": "Critical and parameter-free stay accurate up to the limit of the mesh; stiffness gives way before",
    "restitution": "The published choice throws back up to 2.6 times as fast as it was hit; the critical rule, nothing",
}


def judged(bench: Bench, methods: Sequence[Method], dt: float | None = None) -> xr.Dataset:
    """Each method judged on a bench; one that occurs often runs once."""
    different = list(dict.fromkeys(methods))
    return bench.run(different, dt).isel(run=[different.index(method) for method in methods])


def unfolded(found: xr.Dataset, grid: dict[str, Sequence[object]]) -> xr.Dataset:
    """Runs in the order of a grid, on its dimensions."""
    sizes = [len(values) for values in grid.values()]
    data = {name: (list(grid), part.values.reshape(sizes), part.attrs) for name, part in found.items()}
    return xr.Dataset(data, {name: list(values) for name, values in grid.items()})


def over_factor(benches: Sequence[Bench], factors: Sequence[float]) -> xr.Dataset:
    """All methods over p_s of the cylinders and beta of the bar, at the time step of the bench."""
    parts = []
    for bench in benches:
        methods = [make(bench.ps(factor)) for make in METHODS.values() for factor in factors]
        part = unfolded(judged(bench, methods), {"method": list(METHODS), "factor": factors})
        parts.append(part.assign(x_label=bench.factor).expand_dims(scene=[bench.name]))
    chart = xr.concat(parts, "scene")
    chart["factor"].attrs = {"units": "1", "long_name": "p_s of the cylinders, beta = alpha_s h/(E A) of the bar"}
    return chart


def over_r_zeta(benches: Sequence[Bench], s2: Sequence[float], zeta: Sequence[float]) -> xr.Dataset:
    """The published method with R = s2/dt^2 and a damping ratio, at a large stiffness penalty."""
    parts = []
    for bench in benches:
        ps, dt = bench.ps(LARGE), bench.step
        methods = [bp.Bipenalty(ps, rule="published", R=s / dt**2, zeta=z) for z in zeta for s in s2]
        part = unfolded(judged(bench, methods), {"zeta": zeta, "s2": s2})
        part = part.assign(x_label=f"$R\\,dt^2 = s^2$ (–), {bench.mark} = {LARGE:g}")
        parts.append(part.expand_dims(scene=[bench.name]))
    chart = xr.concat(parts, "scene")
    chart["s2"].attrs = {"units": "1", "long_name": "s^2 = R dt^2"}
    chart["zeta"].attrs = {"units": "1", "long_name": "damping ratio of the penalty mode"}
    return chart


def over_dt(benches: Sequence[Bench], shares: Sequence[float]) -> xr.Dataset:
    """All methods, at the factor that suits them, over the time step as a share of the assembled matrix's limit."""
    parts = []
    for bench in benches:
        factor = USUAL[bench.kind]
        methods = [make(bench.ps(factor)) for make in METHODS.values()]
        steps = [judged(bench, methods, share * bench.limits.assembled) for share in shares]
        part = unfolded(xr.concat(steps, "run"), {"share": shares, "method": list(METHODS)})
        bound = bench.limits.element / bench.limits.assembled
        told = bound < 0.99  # else the two limits are one
        label = f"dt / mesh limit{told * ' (dashed: of elements)'}, {bench.mark} = {factor:g}"
        part = part.assign(x_label=label, marks=bound if told else math.nan)
        parts.append(part.expand_dims(scene=[bench.name]))
    chart = xr.concat(parts, "scene")
    chart["share"].attrs = {"units": "1", "long_name": "time step over the limit of the assembled mesh"}
    chart["marks"].attrs = {"units": "1", "long_name": "limit of the elements over that of the assembled mesh"}
    return chart


def stored(charts: dict[str, xr.Dataset], row: RestitutionMap, benches: Sequence[Bench]) -> xr.Dataset:
    """The charts and the restitution map as one dataset, each variable with the name of its chart before it."""
    own = {name: {key: f"{name}_{key}" for key in (*chart.data_vars, "scene")} for name, chart in charts.items()}
    data = xr.merge([chart.rename(own[name]) for name, chart in charts.items()])
    about = {"units": "1", "long_name": "largest |e| of one row over its phase of entry"}
    data["restitution_largest"] = (("row_zeta", "row_s2"), row.largest, about)
    about = {"units": "1", "long_name": "mean of e^2 of one row over its phase of entry"}
    data["restitution_mean_square"] = (("row_zeta", "row_s2"), row.mean_square, about)
    data = data.assign_coords(row_zeta=row.zeta, row_s2=row.s2)
    return data.assign_attrs({f"reference of the {bench.name}": bench.reference for bench in benches})


def main() -> None:
    """Run the three charts, draw them, report, check."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder to write to (out)")
    parser.add_argument("--quick", action="store_true", help="coarse meshes and few parameters")
    chosen = parser.parse_args()
    quick: bool = chosen.quick
    elements, segments = (40, 40) if quick else (200, 116)

    started = time.perf_counter()

    def say(what: str) -> None:
        print(f"{time.perf_counter() - started:5.0f} s  {what}", flush=True)

    say("converged runs of the cylinders")
    bar, cylinders = Bar(elements), Cylinders(segments, 1)
    benches = (bar, Bar(elements, 0.5), cylinders, Cylinders(segments, 2))
    charts = {}
    say("all methods over the stiffness penalty")
    charts["ps"] = over_factor(benches, np.logspace(-2, 8, 6 if quick else 21))
    say("the published rule over R dt^2 and zeta")
    s2, zeta = np.linspace(0.4, 4, 5 if quick else 19), np.linspace(0, 2, 5 if quick else 17)
    charts["R_zeta"] = over_r_zeta((bar, cylinders), s2, zeta)
    say("all methods over the time step")
    charts["dt"] = over_dt((bar, cylinders), (0.4, 0.98, 1.05) if quick else [*np.linspace(0.2, 0.95, 16), 0.98, 1.05])
    n = 20 if quick else 200
    row = bp.restitution_map(np.linspace(4 / n, 4, n), np.linspace(0, 2, n // 2 + 1), n)

    out: Path = chosen.out
    out.mkdir(parents=True, exist_ok=True)
    bp.io.write_netcdf(stored(charts, row, benches), out / "stability.nc")
    titles = {} if quick else CLAIMS
    figures = {
        "stability_ps": stability(charts["ps"], "factor", scenes=list(USUAL), emphasis=OURS, title=titles.get("ps")),
        "stability_R_zeta": restitution_and_runs(row, charts["R_zeta"], title=titles.get("R_zeta")),
        "stability_dt": stability(charts["dt"], "share", emphasis=OURS, title=titles.get("dt")),
        "restitution": restitution(row, title=titles.get("restitution")),
    }
    for name, figure in figures.items():
        figure.savefig(out / f"{name}.png", dpi=150)
    if quick:
        print("coarse meshes: the bounds below are meant for those of the whole study")
    report(charts, benches)
    say(f"written to {out}: stability.nc, {', '.join(f'{name}.png' for name in figures)}")
    if not quick:
        check(charts, row, benches)


if __name__ == "__main__":
    main()
