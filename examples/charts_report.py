"""The report of the charts: tables, sentences and verdicts, and what is asserted. SI units."""

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from bipenalty import study
from bipenalty.study.errors import MEASURES

OURS, PUBLISHED, SOURCE_DT, LAGRANGE = "parameter-free", "published", "0.5 element", "CD-Lagrange"
NEAR, GAIN, ACCURACY = 1.1, 2.2, 0.02  # ratio of costs that counts as on the front; gain asked for; impulse error
FINISHES = "every run of it finished"
TABLED = (0.05, 0.02, 0.01)  # errors of the tables


def of(data: xr.Dataset, method: str) -> xr.Dataset:
    """The runs of a method, its dimension kept."""
    return data.isel(method=[list(map(str, data["method"].values)).index(method)])


def source(data: xr.Dataset) -> xr.Dataset:
    """The published set-up: dt at half the elements' limit, p_s the best by hindsight."""
    return of(data, PUBLISHED).sel(dt=[SOURCE_DT])


def cost(data: xr.Dataset, accuracy: float, error: str, kind: str) -> float:
    """Of an accuracy, with the only method there is."""
    return float(study.cost_at(data, accuracy, error, kind)[0])


def gain(data: xr.Dataset, accuracy: float, error: str, kind: str) -> float:
    """Cost of the published set-up over that of the parameter-free method at an accuracy; NaN if one never has it."""
    return cost(source(data), accuracy, error, kind) / cost(of(data, OURS), accuracy, error, kind)


def attained(data: xr.Dataset, error: str) -> float:
    """Smallest of the usual accuracies that both the published set-up and ours attain."""
    wide = (0.01, 0.02, 0.05, 0.1, 0.2)
    return next((level for level in wide if np.isfinite(gain(data, level, error, "node_steps"))), float("nan"))


def distance(data: xr.Dataset, error: str, kind: str, which: str = "") -> float:
    """Cost of the parameter-free method over that of the best of all runs, mean over its range (or least, largest)."""
    found = study.distance_to_front(data, error, kind)[f"{which}cost_ratio"]
    return float(found.sel({"method": OURS}))


def against_lagrange(data: xr.Dataset) -> tuple[float, float]:
    """Force error and time per step of the parameter-free method over those of CD-Lagrange; worst and median."""
    ours, theirs = (of(data, name) for name in (OURS, LAGRANGE))
    wrong = (ours["force"].values / theirs["force"].values).ravel()
    each = ((ours["seconds"] / ours["steps"]).values / (theirs["seconds"] / theirs["steps"]).values).ravel()
    return float(np.nanmax(wrong)), float(np.nanmedian(each))


def verdicts(charts: Mapping[str, xr.Dataset]) -> list[str]:
    """What was asked of the parameter-free method, case by case, and what was found; a table in Markdown."""
    head = (
        "| case | on the front by force, time (node-steps) | by impulse | gain at 2 % impulse error | gain by force |"
    )
    lines = [head + " runs that failed |", "|---|---|---|---|---|---|"]
    for name, data in charts.items():
        cells = [name]
        for error in ("force", "impulse"):
            time, count = (distance(data, error, kind) for kind in ("seconds", "node_steps"))
            cells.append(f"{time:.2f} ({count:.2f}) {word(count <= NEAR)}")
        time, count = (gain(data, ACCURACY, "impulse", kind) for kind in ("seconds", "node_steps"))
        cells.append(f"{time:.1f} ({count:.1f}) {word(count >= GAIN)}")
        level = attained(data, "force")
        time, count = (gain(data, level, "force", kind) for kind in ("seconds", "node_steps"))
        cells.append(f"{time:.1f} ({count:.1f}) at {100 * level:g} % {word(count >= GAIN)}")
        outcomes = of(data, OURS)["outcome"].values
        bad = int((~np.isin(outcomes, ("finished", "not run"))).sum())
        cells.append(f"{bad} of {int((outcomes != 'not run').sum())}")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def word(holds: bool) -> str:
    """As the benchmarks have it."""
    return "PASS" if holds else "short"


def check(charts: Mapping[str, xr.Dataset]) -> None:
    """What holds on this machine and on any other: counts and errors, not seconds."""
    for name, data in charts.items():
        ours = of(data, OURS)["outcome"].values
        assert np.isin(ours, ("finished", "not run")).all(), f"{name}: parameter-free, {sorted(set(ours.ravel()))}"
        if LAGRANGE in data["method"].values:
            wrong, _ = against_lagrange(data)
            assert wrong <= NEAR, f"{name}: force error {wrong:.2f} times that of CD-Lagrange"


def report(charts: Mapping[str, xr.Dataset], in_dt: Mapping[str, xr.Dataset], figures: Mapping[str, str]) -> str:
    """The whole of docs/charts.md."""
    return "\n".join([*_head(charts), *(line for name in charts for line in _case(name, charts[name], figures[name])),
                      *_rates(charts, in_dt)]) + "\n"  # fmt: skip


def _head(charts: Mapping[str, xr.Dataset]) -> Iterator[str]:
    yield "# Speed against accuracy"
    yield ""
    yield from verdicts(charts)
    yield ""


def _case(name: str, data: xr.Dataset, figure: str) -> Iterator[str]:
    yield f"## {name}"
    yield ""
    yield f"![Errors against time]({figure})"
    yield ""
    yield from _table(data)
    yield ""
    for error in ("force", "impulse"):
        yield f"- {study.best_for(data, ACCURACY, error)}."
    yield ""


def _table(data: xr.Dataset) -> Iterator[str]:
    columns = [(error, level) for error in ("force", "impulse") for level in TABLED]
    yield "| method | " + " | ".join(f"{error} to {100 * level:g} %" for error, level in columns) + " | to the front |"
    yield "|---|" + "--:|" * (len(columns) + 1)
    ratio = study.distance_to_front(data, "force", "node_steps")["cost_ratio"]
    for method in map(str, data["method"].values):
        part = of(data, method)
        cells = [_both(part, level, error) for error, level in columns]
        yield f"| {method} | " + " | ".join(cells) + f" | {float(ratio.sel({'method': method})):.2f} |"
    yield "| source's set-up | " + " | ".join(_both(source(data), level, error) for error, level in columns) + " | |"


def _both(part: xr.Dataset, level: float, error: str) -> str:
    time, count = (cost(part, level, error, kind) for kind in ("seconds", "node_steps"))
    return f"{1e3 * time:.3g} ({count:.2g})" if np.isfinite(time) else "–"


def _rates(charts: Mapping[str, xr.Dataset], in_dt: Mapping[str, xr.Dataset]) -> Iterator[str]:
    yield "## Rates"
    yield ""
    for name, data in charts.items():
        table = study.rates(data)
        for measure in MEASURES:
            yield f"{name} {measure} {table['rate'].sel({'method': OURS, 'dt': '0.98 assembled', 'measure': measure}).values}"
    for name, table in in_dt.items():
        yield f"{name} {table['rate'].values}"
