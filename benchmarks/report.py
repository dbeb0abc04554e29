"""The measurements as Markdown tables."""

from collections.abc import Sequence

import timed_scenes as scenes
from claims import Claim
from measure import Array, Spread, Steps, ratio, spread
from plan import Plan
from versus_script import EQUAL, Duel

#: Rows of the table of single steps, and of the table of what a scene costs.
SINGLE = (scenes.NOTHING, scenes.APART, scenes.STIFFNESS, scenes.BIPENALTY)
PARTS = (
    scenes.NOTHING,
    scenes.AGAIN,
    scenes.UNSEEN,
    scenes.APART,
    scenes.STIFFNESS,
    scenes.STIFFNESS_DAMPED,
    scenes.BIPENALTY,
    scenes.BIPENALTY_DAMPED,
    scenes.WALL_FAR,
    scenes.WALL,
    scenes.SUPPORT,
    scenes.LOAD,
)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table, first column left, the others right.

    Example
    -------
    >>> print(table(["a", "b"], [["x", "1"]]))
    | a | b |
    |---|--:|
    | x | 1 |
    """
    rule = "|---" + "|--:" * (len(head) - 1) + "|"
    return "\n".join([f"| {' | '.join(head)} |", rule, *(f"| {' | '.join(row)} |" for row in rows)])


def with_error(value: Spread) -> str:
    """Median and its error, with as many digits as a ratio of that size needs.

    Example
    -------
    >>> with_error(spread([1.0, 1.0]))
    '1.000 ± 0.000'
    """
    digits = 4 if value.median < 0.1 else 3 if value.median < 2 else 2
    return f"{value.median:.{digits}f} ± {value.error:.{digits}f}"


def machine(about: dict[str, str], plan: Plan) -> str:
    """What it ran on and how."""
    rows = [[key, value] for key, value in about.items()]
    how = (
        f"One thread unless said otherwise. Discs of {plan.segments} segments. Single steps: {plan.rounds} rounds of "
        f"{plan.pieces} times {plan.steps} steps after the first {plan.before}, each scene the fastest of "
        f"{plan.places} models that differ in their place in memory. Against the script: {plan.script_rounds} rounds. Bare kernel: "
        f"{plan.kernel_rounds}; one run: {plan.single_rounds}, its start: {plan.start_rounds}; sweep: "
        f"{plan.sweep_rounds}; numbers of lanes: {plan.width_rounds}; one large model: {plan.large_rounds}."
    )
    return f"## Machine\n\n{table(['', ''], rows)}\n\n{how}"


def single_steps(steps: Steps, nodes: int) -> str:
    """Cost of a step by node."""
    rows = []
    for name in SINGLE:
        ns = spread(steps.seconds[name] * 1e9 / nodes)
        quartiles = f"{ns.lower:.2f} to {ns.upper:.2f}"
        rows.append([name, f"{steps.rows[name]:.1f}", f"{ns.smallest:.2f}", f"{ns.median:.2f}", quartiles])
    head = ["scene", "active rows", "least, ns", "median, ns", "quartiles, ns"]
    return (
        f"## A step, in ns per node-step ({nodes} nodes)\n\n{table(head, rows)}\n\n"
        f"Processor time of the thread, which had {100 * steps.share:.0f} % of a core while it was timed."
    )


def against_script(duels: Sequence[Duel]) -> str:
    """Package and script on the same arrays."""
    rows, unequal = [], []
    for duel in duels:
        for search, loop in duel.loop.items():
            call, difference = duel.call[search], duel.difference[search]
            name = f"{duel.scene}, {duel.steps} steps, {search}"
            same = "no contact" if difference != difference else f"{difference:.0e}"
            rows.append(
                [
                    name,
                    milliseconds(loop[:, 0]),
                    milliseconds(loop[:, 1]),
                    with_error(ratio(loop[:, 1], loop[:, 0])),
                    with_error(ratio(call[:, 1], call[:, 0])),
                    same,
                ]
            )
            unequal += [name] if difference > EQUAL else []
    head = [
        "scene, search of the script",
        "package, ms",
        "script, ms",
        "ratio of the loops",
        "of the whole calls",
        "difference of forces",
    ]
    verdict = f"NOT COMPARABLE: {'; '.join(unequal)}." if unequal else "The results are equal."
    return (
        f"## Against the SciPy script\n\n{table(head, rows)}\n\nWall time, least / median, stiffness penalty p_s = 1 "
        f"in both, dt = {duels[0].dt:.3g} s. The package records energies too, the script does not. Largest difference "
        f"of the force histories over the peak force; equal up to {EQUAL:g}. {verdict}"
    )


def milliseconds(seconds: Array) -> str:
    """Least and median."""
    return f"{1e3 * seconds.min():.1f} / {1e3 * spread(seconds).median:.1f}"


def parts(steps: Steps, nodes: int) -> str:
    """Cost follows the scene."""
    rows, reference = [], steps.seconds[scenes.NOTHING]
    for name in PARTS:
        ns, relative = spread(steps.seconds[name] * 1e9 / nodes), ratio(steps.seconds[name], reference)
        quartiles = f"{relative.lower:.3f} to {relative.upper:.3f}"
        rows.append([name, f"{steps.rows[name]:.1f}", f"{ns.median:.2f}", with_error(relative), quartiles])
    tiny = spread(steps.seconds[scenes.TINY] * 1e9).median
    noise = ratio(steps.seconds[scenes.AGAIN], reference)
    head = ["scene", "active rows", "ns per node-step", f"over {scenes.NOTHING}", "quartiles"]
    return (
        f"## Cost follows the scene\n\n{table(head, rows)}\n\n"
        f"A whole step of two bodies of one element each takes {tiny:.0f} ns. The same scene measured twice differs by "
        f"{100 * abs(noise.median - 1):.1f} ± {100 * noise.error:.1f} %: no smaller difference means anything."
    )


def expectations(claims: Sequence[Claim], judged: bool) -> str:
    """Each with its verdict."""

    def verdict(claim: Claim) -> str:
        return claim.verdict if judged else "not judged"

    rows = [[c.text, f"expected {c.expected}", with_error(c.measured), verdict(c)] for c in claims]
    return (
        f"## Expectations\n\n{table(['ratio', '', 'measured', ''], rows)}\n\n"
        'Where the ratio is an upper bound of what is claimed, one beyond the bound proves nothing: "not shown". '
        'Where it is a share of what the machine can do, one beyond 1 says that the probe is wrong: "no ceiling".'
    )


def whole(about: dict[str, str], plan: Plan, sections: Sequence[str]) -> str:
    """The report."""
    note = (
        "Each ratio is taken round by round; median of the rounds ± half-width of its 95 % interval "
        "(1.57 IQR/sqrt(n), McGill, Tukey and Larsen 1978)."
    )
    return "\n\n".join(["# Benchmarks", note, machine(about, plan), *sections]) + "\n"
