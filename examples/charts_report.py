"""The report of the charts: tables, sentences and verdicts, and what is asserted. SI units."""

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from bipenalty import study
from bipenalty.plot.work_precision_figure import LEVELS

OURS, PUBLISHED, SOURCE_DT, LAGRANGE = "parameter-free", "published", "0.5 element", "CD-Lagrange"
NEAR, GAIN, ACCURACY = 1.1, 2.2, 0.02  # ratio of costs that counts as on the front; gain asked for; impulse error
HINDSIGHT, ADVANCE = 1.4, 1.15  # ratio of costs by force that is held to, p_s of the others by hindsight or beforehand
CHOSEN = (3.16, 10.0, 31.6)  # p_s that one would choose beforehand
USUAL = "0.98 assembled"
PENALTIES = (
    OURS,
    "critical",
    PUBLISHED,
    "published, D = 1e-4 s",
    "stiffness",
    "element stiffness",
    "nodal mass stiffness",
)
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
    return next((level for level in LEVELS if np.isfinite(gain(data, level, error, "node_steps"))), float("nan"))


def distance(data: xr.Dataset, error: str, kind: str, which: str = "") -> float:
    """Cost of the parameter-free method over that of the best of all runs, mean over its range (or least, largest)."""
    found = study.distance_to_front(data, error, kind)[f"{which}cost_ratio"]
    return float(found.sel({"method": OURS}))


def against_lagrange(data: xr.Dataset) -> dict[str, tuple[float, float]]:
    """Force error of the parameter-free method over that of CD-Lagrange at each time step: median and worst mesh."""
    ours, theirs = (of(data, name)["force"].values[0, 0] for name in (OURS, LAGRANGE))
    ratio = dict(zip(map(str, data["dt"].values), (ours / theirs).T, strict=True))
    return {dt: (float(np.nanmedian(each)), float(np.nanmax(each))) for dt, each in ratio.items()}


def per_step(data: xr.Dataset) -> float:
    """Time of a step of the parameter-free method over that of CD-Lagrange, median."""
    ours, theirs = ((of(data, name)["seconds"] / of(data, name)["steps"]).values[0, 0] for name in (OURS, LAGRANGE))
    return float(np.nanmedian(ours / theirs))


def penalties(data: xr.Dataset) -> xr.Dataset:
    """The runs of the penalty methods: without multipliers and without predictor and corrector."""
    return data.isel(method=[str(method) in PENALTIES for method in data["method"].values])


def in_advance(data: xr.Dataset, ps: float) -> xr.Dataset:
    """The runs there are when one p_s is chosen for all scenes, meshes and time steps before any is known."""
    factors = data["ps"].values
    rows = [0 if np.isnan(row).all() else int(np.abs(np.log(row / ps)).argmin()) for row in factors]
    return (
        data.isel(parameter=xr.DataArray(rows, dims="method"))
        .expand_dims(parameter=[0])
        .transpose(*data["outcome"].dims, ...)
    )


def verdicts(charts: Mapping[str, xr.Dataset]) -> list[str]:
    """What was asked of the parameter-free method, case by case, and what was found; a table in Markdown."""
    advance = [f"p_s = {ps:.3g} for all" for ps in CHOSEN]
    lines = [
        "| case | best of all, force | best of penalties, force | impulse | "
        + " | ".join(advance)
        + " | gain, force | gain, 2 % of impulse | failed |",
        "|---|" + "---|" * (6 + len(CHOSEN)),
    ]
    for name, data in charts.items():
        near = [distance(part, "force", "node_steps") for part in (data, penalties(data))]
        near += [distance(penalties(data), "impulse", "node_steps")]
        near += [distance(in_advance(penalties(data), ps), "force", "node_steps") for ps in CHOSEN]
        cells = [name, *(f"{ratio:.2f} {word(ratio <= NEAR)}" for ratio in near)]
        for error, level in (("force", attained(data, "force")), ("impulse", ACCURACY)):
            time, count = (gain(data, level, error, kind) for kind in ("seconds", "node_steps"))
            at = f" at {100 * level:g} %" if error == "force" else ""
            cells.append(f"{count:.1f} ({time:.1f}){at} {word(count >= GAIN)}")
        outcomes = of(data, OURS)["outcome"].values
        ran = outcomes != "not run"
        cells.append(f"{int((outcomes[ran] != 'finished').sum())} of {int(ran.sum())}")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def word(holds: bool) -> str:
    """As the benchmarks have it."""
    return "PASS" if holds else "short"


def check(charts: Mapping[str, xr.Dataset]) -> None:
    """What holds whatever the machine: errors and counts, not seconds."""
    for name, data in charts.items():
        ours = of(data, OURS)["outcome"].values
        assert np.isin(ours, ("finished", "not run")).all(), f"{name}: parameter-free, {sorted(set(ours.ravel()))}"
        others = data.isel(method=[m != OURS for m in data["method"].values])["outcome"].values
        assert (others == "spectral instability").any(), f"{name}: nothing failed where much should"
        level = attained(data, "force")
        found = gain(data, level, "force", "node_steps")
        assert found >= GAIN, f"{name}: {found:.2f} times cheaper than the published set-up at {level:g} of the force"
        ratio = distance(penalties(data), "force", "node_steps")
        assert ratio <= HINDSIGHT, f"{name}: {ratio:.2f} times the cost of the best penalty"
        for ps in CHOSEN:
            ratio = distance(in_advance(penalties(data), ps), "force", "node_steps")
            assert ratio <= ADVANCE, f"{name}: {ratio:.2f} times the cost of the best with p_s = {ps:.3g}"
        if LAGRANGE in data["method"].values:
            wrong = against_lagrange(data)[SOURCE_DT][0]
            assert wrong <= NEAR, (
                f"{name}: force error {wrong:.2f} times that of CD-Lagrange at half the elements' limit"
            )


def report(charts: Mapping[str, xr.Dataset], in_dt: Mapping[str, xr.Dataset], figures: Mapping[str, str]) -> str:
    """The whole of docs/charts.md."""
    parts = [_head(charts), *(_case(name, data, figures[name]) for name, data in charts.items()), _rates(charts, in_dt)]
    return "\n".join(line for part in parts for line in part)


def _head(charts: Mapping[str, xr.Dataset]) -> Iterator[str]:
    some = next(iter(charts.values()))
    runs = sum(int((data["outcome"].values != "not run").sum()) for data in charts.values())
    yield from (
        "# Speed against accuracy",
        "",
        "Written by `make charts`. Each line is one method along the best of its own runs: meshes, time steps and, where it has",
    )
    yield "one, p_s, chosen by hindsight. The dashed line is the published set-up: dt at half the limit of the elements, best p_s."
    yield from ("", "![Force error against time](figures/work_precision.png)", "")
    spread = np.nanmedian(np.concatenate([data["spread"].values.ravel() for data in charts.values()]))
    rounds = np.nanmax(some["repeats"].values)
    yield f"{runs} settings. Time is that of the processor on one thread in steps only, median of {rounds:.0f} interleaved rounds;"
    yield f"half the range between the quartiles is {100 * spread:.0f} % of it in the median. Node-steps are its twin without noise."
    yield f"Making a model comes on top, once a mesh: {_setup(charts, -1)} of the time of a run on the finest mesh at 0.98 of the"
    yield f"limit of the assembled matrix, to find which is part of it; {_setup(charts, 0)} with the limit of the elements."
    yield from ("", "## What was asked, and what came out", "")
    yield "Cost of the parameter-free method over that of the best at equal error, in node-steps, mean over its range (asked: 1.1),"
    yield "first of all methods, then of the penalties; then with one p_s chosen beforehand for the others; then cost of the"
    yield "published set-up over its own, node-steps (time) (asked: 2.2); then how many of its runs failed."
    yield from ("", *verdicts(charts), "")
    yield "**What holds.** It never fails. For the force it costs 2.2 times fewer node-steps than the published set-up or better,"
    yield "everywhere, and with a p_s chosen beforehand no penalty is more than 15 % cheaper, most are dearer by far."
    yield ""
    yield "**What falls short.** Against penalties with the p_s of least error for each mesh and time step, known by hindsight, it costs"
    yield "up to 1.3 times as much for the force, and 1.1 to 2.6 times as much for the impulse; there the gain over the published"
    yield "set-up is 1 to 2.4 (bouncing bar: 11). On bars its impulse is late by one transit h/c of an element, 1/(2N) of"
    yield "the whole with N elements; a spring of beta = alpha_s h/(EA) is late by h/(c beta). The published rule bears beta = 2 at"
    yield "0.98 of the mesh's limit, where it has half the error, and fails from beta = 2.8 to 4 on. That p_s changes with every mesh."
    yield f"Closing takes velocity, so it loses energy, {_energy(charts)} at its worst; undamped penalties that do not fail keep it better."
    yield "Of all methods the predictor-corrector at its best p_s and the multipliers are cheaper still on bars and on the Hertz disc."
    yield "In two dimensions soft penalties (p_s of 0.3 to 3) do better by impulse on some meshes; why was not traced."
    if LAGRANGE in some["method"].values:
        yield from (
            "",
            "Force error over that of CD-Lagrange on the same mesh at the same time step, median of the meshes (worst), asked: 1.1; and",
        )
        steps = [str(dt) for dt in some["dt"].values]
        yield from (
            "time per step over its own.",
            "",
            f"| case | {' | '.join(steps)} | time per step |",
            "|---|" + "---|" * (len(steps) + 1),
        )
        for name, data in charts.items():
            cells = [
                f"{median:.2f} ({most:.2f}) {word(median <= NEAR)}" for median, most in against_lagrange(data).values()
            ]
            yield f"| {name} | {' | '.join(cells)} | {per_step(data):.2f} |"
        yield from (
            "",
            "At half the limit of the elements the two are equal. Close to the limit of the mesh CD-Lagrange is better on bars and",
        )
        yield "on the Hertz disc (why was not traced); on cylinders and stack there is little between them. A step costs the same: the"
        yield "rows are few. In the first table the first column counts all methods, the others only penalties."
    else:
        yield from ("", "CD-Lagrange is not in this version: the comparison with it is made once it is.")
    yield ""


def _energy(charts: Mapping[str, xr.Dataset]) -> str:
    """What the parameter-free method makes or loses of it on the coarsest and on the finest meshes."""
    ours = [abs(of(data, OURS)["energy"]).max(("method", "parameter", "dt")).values for data in charts.values()]
    coarse, fine = (max(float(each[at]) for each in ours) for at in (0, -1))
    return f"{100 * coarse:.2g} % on the coarsest meshes and {100 * fine:.2g} % on the finest"


def _setup(charts: Mapping[str, xr.Dataset], dt: int) -> str:
    """Time of making a model on the finest mesh over that of the run at the largest time step."""
    whole = [float(of(data, OURS)["seconds"].values[0, 0, -1, -1]) for data in charts.values()]
    parts = [data["setup_seconds"].values[-1, dt] / run for data, run in zip(charts.values(), whole, strict=True)]
    return f"{100 * min(parts):.0f} to {100 * max(parts):.0f} %"


def _case(name: str, data: xr.Dataset, figure: str) -> Iterator[str]:
    yield from (f"## {name[0].upper() + name[1:]}", "", f"![Errors against time: {name}]({figure})", "")
    width = 1e3 * data.attrs["width"]
    yield f"Answer: {data.attrs['answer']}. Forces and impulses after a moving average over {width:.3g} ms,"
    yield "a wave's way through one element of the coarsest mesh. Below: ms (node-steps) for an accuracy, and the mean ratio of"
    yield "node-steps to the best by force."
    yield from ("", *_table(data), "")
    ours = abs(of(data, OURS)[["force", "impulse", "energy"]]).max()
    for error in ("force", "impulse"):
        yield f"- {study.best_for(data, ACCURACY, error)}."
    worst = ", ".join(f"{what} {100 * float(ours[what]):.2g} %" for what in ("force", "impulse", "energy"))
    yield f"- Parameter-free at its worst, over all meshes and time steps: {worst}; {_failures(data)}."
    yield ""


def _failures(data: xr.Dataset) -> str:
    """Which methods failed how often."""
    words = []
    for method in map(str, data["method"].values):
        outcomes = of(data, method)["outcome"].values
        ran = outcomes != "not run"
        if bad := int((outcomes[ran] != "finished").sum()):
            words.append(f"{method} {bad} of {int(ran.sum())}")
    return "failed: " + ", ".join(words) if words else "nothing failed"


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
    tables = {name: study.rates(data) for name, data in charts.items()}
    first = next(iter(tables.values()))
    yield from (
        "## Rates",
        "",
        f"Orders of the parameter-free method in the element size, dt = {USUAL} limit; ± standard error of the fit.",
        "",
    )
    yield f"| measure | expected | {' | '.join(tables)} |"
    yield "|---|--:|" + "--:|" * len(tables)
    for measure in map(str, first["measure"].values):
        at = {"method": OURS, "dt": USUAL, "measure": measure}
        cells = [_rate(table.sel(at)) for table in tables.values()]
        yield f"| {measure.replace('_', ' ')} | {float(first['expected'].sel(measure=measure)):g} | {' | '.join(cells)} |"
    yield from ("", *(f"- {m}: {first['why'].sel(measure=m).values}." for m in map(str, first["measure"].values)), "")
    yield "Energy is signed and crosses zero, so its fit means little; meshes of discs meet the contact now with a node, now with an"
    yield "edge, and fits waver by as much. In the time step on one mesh, against an eighth of the smallest step:"
    other = next(iter(in_dt.values()))
    yield from ("", f"| measure | expected | {' | '.join(in_dt)} |", "|---|--:|" + "--:|" * len(in_dt))
    for measure in map(str, other["measure"].values):
        cells = [_rate(table.sel(measure=measure)) for table in in_dt.values()]
        yield f"| {measure} | {float(other['expected'].sel(measure=measure)):g} | {' | '.join(cells)} |"
    yield from ("", *(f"- {m}: {other['why'].sel(measure=m).values}." for m in map(str, other["measure"].values)), "")


def _rate(one: xr.Dataset) -> str:
    rate, wobble = float(one["rate"]), float(one["wobble"])
    return "–" if np.isnan(rate) else f"{rate:.2f}" + ("" if np.isnan(wobble) else f" ± {wobble:.2f}")
