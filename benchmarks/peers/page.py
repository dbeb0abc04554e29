"""The page docs/peers.md: three sentences, the tables, and how they were measured."""

from collections.abc import Sequence

import numpy as np
from report import table

from peers.interface import Case
from peers.judge import ENERGY, FINER, FORCE, MOMENTUM, OVERFLOW, STEPS, WIDTH, Reference
from peers.report import Row, collisions, wrongs

#: Load average beyond which the machine was not the benchmark's own.
BUSY = 0.5


def shown(rows: Sequence[Row]) -> str:
    """What it shows: which programs were right, and how their time loops compare with the first row's."""
    ran = [(row, row.verdict) for row in rows if row.verdict]
    right = [row.title for row, seen in ran if seen.right]
    wrong = [f"{row.title} ({seen.words})" for row, seen in ran if not seen.right]
    first = ran[0][0] if ran else None
    times = [f"{row.name} {over(row, first):.3g}" for row, _ in ran if row.better and first and row is not first]
    slower = f"; time loops over that of {first.name}: {listed(times)}" if first and times else ""
    return f"**What it shows.** Right on this collision: {listed(right)}; not right: {listed(wrong)}{slower}."


def over(row: Row, other: Row) -> float:
    """Ratio of the times, taken round by round, in which the machine was the same for both; the median."""
    return float(np.median([a / b for a, b in zip(row.seconds, other.seconds, strict=False)]))


def concluded(rows: Sequence[Row]) -> str:
    """What to conclude: who stands a wrong penalty, and what the others are for."""
    safe = [row.title for row in rows if row.wrong and all(seen.right for seen in row.wrong.values())]
    better = [f"{row.name} ({row.better})" for row in rows if row.better]
    other = (
        f"; for anything else take another, which can do what this package cannot: {listed(better)}" if better else ""
    )
    return (
        f"**What to conclude.** For frictionless, elastic collisions in the plane whose penalty nobody wants to tune, take "
        f"what is right with every penalty tried: {listed(safe)}{other}."
    )


def listed(items: Sequence[str]) -> str:
    """Items in a row; "none" without any."""
    return ", ".join(items) if items else "none"


def notes(
    case: Case, wanted: Reference, agreement: dict[str, float], rows: Sequence[Row], about: dict[str, str]
) -> str:
    """How it was measured, at length."""
    differ = ", ".join(f"{name} by {100 * error:.2g} %" for name, error in agreement.items())
    lines = [
        f"Penalty: a contact node is pushed out with p_s E_max = {case.alpha_s:g} N/m per metre of overlap in all programs; "
        "the parameter-free method chooses its own, and where the penalty is wrong is given p_s with the critical rule.",
        "Time loop: wall time, one thread, runs of all programs in turn; median (least to most, number of runs n), ratios round by round. "
        "The package and the script record forces at every step, the package energies at every tenth. Of CalculiX it is the "
        "whole process, printing nothing on the way, less one of a single step.",
        "CalculiX: a slice of bricks, as its plane elements do not move in explicit dynamics; it has twice the nodes that "
        "are counted. Its force is what the top cylinder gains in momentum between prints (every second step); it prints "
        "seven digits.",
        f"Force error: relative L2 after a moving average over {1e3 * max(WIDTH, STEPS * case.dt):.2g} ms, against the "
        f"parameter-free method at dt/{FINER} on the same mesh, from which differ: {differ}. Its impulse is "
        f"{wanted.summed[-1]:.4f} N s/m summed over the contact nodes, and {wanted.resultant[-1]:.4f} as resultant, with "
        "which CalculiX is compared.",
        "Momentum error: change of the total momentum over what there was. Energy: kinetic and strain energy, end over "
        "start, or when the run ended.",
        f"Outcomes are words for the figures: wrong is energy off by {100 * ENERGY:g} %, momentum by {100 * MOMENTUM:g} %, "
        f"force by {100 * FORCE:g} %; an energy ratio beyond {OVERFLOW:.0e}, or none, is an overflow. A message is an "
        "error, a warning or a reason given by the program itself.",
        f"Runs with a wrong penalty: once each, for at most {case.limit:g} s.",
    ]
    few = [f"{row.name} {len(row.seconds)}" for row in rows if 0 < len(row.seconds) < max(len(r.seconds) for r in rows)]
    if few:
        lines.append(f"Timed less often, because they take long: {listed(few)}.")
    load = about.get("load average", "unknown")
    if load != "unknown" and float(load) > BUSY:
        lines.append(
            f"Other programs ran on the machine (load average {load} before the first run): wall times are longer than on "
            "a quiet one; the least of each, and the ratios, which are taken round by round, say more than the medians."
        )
    return "\n".join(f"- {line}" for line in lines)


def page(
    rows: Sequence[Row],
    case: Case,
    nodes: int,
    wanted: Reference,
    agreement: dict[str, float],
    about: dict[str, str],
) -> str:
    """The whole page."""
    measured = (
        f"**How measured.** The two cylinders of the study, one mesh for all ({nodes} nodes), dt = {case.dt:.3g} s, "
        f"{case.t_end:g} s, the same penalty, one thread, every run judged by the same function against one converged run."
    )
    missing = [f"- {row.name}: {row.install}" for row in rows if row.version is None]
    parts = [
        "# The same collision in other programs",
        "Written by `python benchmarks/peers/run.py` (`make peers`).",
        *(shown(rows), measured, concluded(rows)),
        "## Two cylinders collide",
        collisions(rows, nodes),
        *(["Not installed here; to have them measured:", "\n".join(missing)] if missing else []),
        "## A wrong penalty",
        wrongs(rows),
        "## Notes on the measurement",
        notes(case, wanted, agreement, rows, about),
        "## Machine",
        table(["", ""], [[key, value] for key, value in about.items()]),
    ]
    return "\n\n".join(parts) + "\n"
