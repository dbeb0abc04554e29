"""Speed against accuracy: what each method costs for what it gives, on seven scenes with known answers.

Five benchmarks with exact answers and two scenes with converged ones, on five to six meshes, at three time steps, with
seven p_s for the methods that need one. What is claimed of it says `charts_report.py`.

    python examples/charts.py            (make charts)  all of it, a few minutes
    python examples/charts.py --quick    two cases, coarse, in a few seconds

Writes work_precision.png, one work_precision_<case>.png and one .nc a case into out/, and the report to docs/charts.md.
"""

import argparse
import time
from pathlib import Path

import charts_report
import xarray as xr

import bipenalty as bp
from bipenalty import plot, study

QUICK = ("thrown bar", "cylinders")
CLAIM = (
    "For the same force, parameter-free costs {:.1f} to {:.1f} times less than the published set-up at its best $p_s$"
)


def file_name(name: str) -> str:
    """Of the files of a case."""
    return "work_precision_" + name.lower().replace(" ", "_")


def computed(quick: bool, repeats: int) -> dict[str, xr.Dataset]:
    """The dataset of each case."""
    charts = {}
    started = time.perf_counter()
    for case in study.cases():
        if quick and case.name not in QUICK:
            continue
        print(f"{time.perf_counter() - started:5.0f} s  {case.name}", flush=True)
        meshes = case.refinements[:2] if quick else case.refinements
        factors = (1.0, 100.0) if quick else study.FACTORS
        charts[case.name] = study.work_precision(case, None, meshes, None, factors, repeats)
    print(f"{time.perf_counter() - started:5.0f} s  done", flush=True)
    return charts


def in_dt(quick: bool) -> dict[str, xr.Dataset]:
    """Rates in the time step on the middle mesh of each case, of the parameter-free method."""
    chosen = [case for case in study.cases() if not quick or case.name in QUICK]
    return {case.name: study.rates_in_dt(case, refinement=case.refinements[0 if quick else 2]) for case in chosen}


def draw(charts: dict[str, xr.Dataset], out: Path, claim: bool) -> None:
    """The overview and one figure a case."""
    gains = [
        charts_report.gain(data, charts_report.attained(data, "force"), "force", "seconds") for data in charts.values()
    ]
    title = CLAIM.format(min(gains), max(gains)) if claim else None
    plot.work_precision_overview(charts, title=title).savefig(out / "work_precision.png", dpi=150)
    for name, data in charts.items():
        last = "half_width" if data["half_width"].notnull().any() else "energy"
        figure = plot.work_precision(
            data, ("force", "impulse", "displacement", last), title=f"{name}: error against cost"
        )
        figure.savefig(out / f"{file_name(name)}.png", dpi=150)


def main() -> None:
    """Compute, draw, report, check."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=Path("out"), help="folder to write to (out)")
    parser.add_argument("--report", type=Path, default=Path("docs/charts.md"), help="the report (docs/charts.md)")
    parser.add_argument("--repeats", type=int, default=3, help="rounds that runs are timed in (3)")
    parser.add_argument("--quick", action="store_true", help="two cases, coarse meshes, few parameters")
    parser.add_argument("--redraw", action="store_true", help="from the .nc files of an earlier run")
    chosen = parser.parse_args()
    out: Path = chosen.out
    out.mkdir(parents=True, exist_ok=True)
    if chosen.redraw:
        charts = {case.name: bp.io.read_netcdf(out / f"{file_name(case.name)}.nc") for case in study.cases()}
    else:
        charts = computed(chosen.quick, 1 if chosen.quick else chosen.repeats)
        for name, data in charts.items():
            bp.io.write_netcdf(data, out / f"{file_name(name)}.nc")
    draw(charts, out, claim=not chosen.quick)
    chosen.report.parent.mkdir(parents=True, exist_ok=True)
    files = {name: f"figures/{file_name(name)}.png" for name in charts}
    chosen.report.write_text(charts_report.report(charts, in_dt(chosen.quick), files), encoding="utf-8")
    print(f"written to {out} and {chosen.report}")
    for line in charts_report.verdicts(charts):
        print(line)
    if not chosen.quick:
        charts_report.check(charts)


if __name__ == "__main__":
    main()
