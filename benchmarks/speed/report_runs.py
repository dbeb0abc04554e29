"""Speed of single runs as Markdown tables: steps of one run, one large model, the start."""

from collections.abc import Sequence

import timed_scenes as scenes
from measure import ratio, spread
from report import table, with_error

from speed.large import Size, exponents
from speed.report import ns, size
from speed.single import BARE, PEAKS, Single
from speed.start import Start


def single(found: Single) -> str:
    """Steps of one run beside the bare kernel."""
    base = found.seconds[BARE]
    rows = [[name, ns(seconds), with_error(ratio(seconds, base))] for name, seconds in found.seconds.items()]
    stiff = [
        with_error(ratio(found.seconds[scenes.BIPENALTY + kind], found.seconds[scenes.STIFFNESS + kind]))
        for kind in ("", PEAKS)
    ]
    return (
        f"## One run\n\n{table(['one lane, one thread', 'ns per node-step', f'over {BARE}'], rows)}\n\n{found.nodes} "
        f"nodes, {found.steps} steps of contact, wall time; a model keeps histories of every step and energies of "
        f"every tenth. Bipenalty over stiffness: {stiff[0]}; with peaks only {stiff[1]}."
    )


def large(sizes: Sequence[Size]) -> str:
    """One model, growing."""
    rows = []
    for one in sizes:
        two = one.threads.get(2)
        rows.append(
            [
                f"{one.counts.nodes} nodes",
                size(one.counts.working_set(1)),
                str(one.level),
                ns(one.threads[1]),
                ns(two) if two is not None else "",
                with_error(ratio(one.threads[1], two)) if two is not None else "",
                ns(one.streaming),
                f"{(one.counts.read + one.counts.moved) / float(spread(one.streaming).median) / 1e9:.1f}",
                with_error(ratio(one.streaming, one.threads[1])),
            ]
        )
    head = [
        "plate",
        "working set",
        "level of memory",
        "one thread, ns per node-step",
        "two threads",
        "gain",
        "memory alone, one core",
        "probed, GB/s",
        "share of the bandwidth",
    ]
    growth = "; ".join(f"level {level}: {with_error(spread(e))}" for level, e in exponents(list(sizes)).items())
    most = sizes[-1].counts
    return (
        f"## One large model\n\n{table(head, rows)}\n\nOne lane, free flight, nothing recorded. A step moves "
        f"{most.read + most.moved:.0f} bytes a node and goes through {most.resident(1):.0f} ({sizes[-1].counts.nodes} "
        f"nodes). Level 0 is the core's own cache; beyond it the probed bandwidth falls by more than a third from one "
        f"level to the next, which on a shared machine need not be where the processor's caches end. Two threads are beside the "
        f"bandwidth of one core. Exponent of the growth of a step with the nodes: {growth or 'not measured'}."
    )


def start(found: Start) -> str:
    """The start of a run and its parts."""
    rows = [
        [name, f"{1e3 * spread(seconds).median:.3f}", with_error(ratio(seconds, found.stepping))]
        for name, seconds in [*found.parts.items(), ("all of the start", found.whole), ("the steps", found.stepping)]
    ]
    head = ["part", "ms", "over the steps"]
    return (
        f"## The start\n\n{table(head, rows)}\n\n{found.nodes} nodes, {found.steps} steps with contact, histories "
        f"of every step, energies of every tenth."
    )
