"""Speed beside the machine's ceilings, as Markdown tables: kernel, whole sweep, numbers of lanes."""

from collections.abc import Sequence

import numpy as np
from measure import Array, ratio, spread
from report import table, with_error

from speed.kernel import Cell
from speed.sweep import Sweep
from speed.widths import WIDTHS, Widths


def ns(seconds: Array) -> str:
    """Median in ns.

    Example
    -------
    >>> ns(np.array([1e-9, 2e-9, 4e-9]))
    '2.00'
    """
    return f"{1e9 * float(np.median(seconds)):.2f}"


def size(count: float) -> str:
    """Bytes with a unit that fits.

    Example
    -------
    >>> size(2.5e6), size(900.0)
    ('2.5 MB', '0.9 kB')
    """
    return f"{count / 1e3:.3g} kB" if count < 1e6 else f"{count / 1e6:.3g} MB"


def kernel(cells: Sequence[Cell]) -> str:
    """The bare kernel beside what arithmetic and memory allow."""
    rows = []
    for cell in cells:
        arithmetic = cell.counts.multiply_adds * cell.multiply_add
        rows.append(
            [
                f"{cell.counts.nodes} nodes, lanes: {cell.lanes}",
                size(cell.counts.working_set(cell.lanes)),
                ns(cell.seconds),
                ns(arithmetic),
                ns(cell.streaming),
                with_error(ratio(arithmetic, cell.seconds)),
                with_error(ratio(cell.seconds, cell.streaming)),
            ]
        )
    head = [
        "bare kernel",
        "working set",
        "ns per node-step and lane",
        "multiply-adds alone, ns",
        "memory alone, ns",
        "share of the multiply-adds",
        "over memory alone",
    ]
    rate = spread(1e-9 / cells[0].multiply_add)
    counted = "; ".join(
        f"{c.nodes} nodes: {c.blocks / c.nodes:.2f} blocks a row, {c.multiply_adds:.1f} multiply-adds per node-step "
        f"and lane, {c.read:.0f} bytes per node-step and {c.moved} a lane, {c.resident(1):.0f} bytes a node with one lane, "
        f"{c.resident(16) / 16:.0f} per node and lane with 16"
        for c in {cell.counts: None for cell in cells}
    )
    return (
        f"## Kernel and machine\n\n{table(head, rows)}\n\nOne core does {rate.median:.1f} ± {rate.error:.1f} 10^9 "
        f"multiply-adds a second from registers. Counted: {counted}. Memory alone: matrix at the bandwidth of a sum, "
        f"state at that of a = b + s c, each probed over the working set; a ratio below 1 says that the kernel streams "
        f"faster than the probe. Wall time, the fastest of places in memory."
    )


def sweep(found: Sweep) -> str:
    """The whole sweep beside the bare kernel and the script."""
    one = found.threads[1] / found.node_steps
    rows = [
        [f"bare kernel, lanes: {lanes}", "", ns(seconds), with_error(ratio(one, seconds))]
        for lanes, seconds in found.kernel.items()
    ]
    for threads, seconds in found.threads.items():
        each = seconds / found.node_steps
        name = f"sweep, threads: {threads}"
        rows.append([name, f"{spread(seconds).median:.2f}", ns(each), with_error(ratio(one, each))])
    rows.append(["script, one core", "", ns(found.script), with_error(ratio(one, found.script))])
    had = ", ".join(f"{100 * float(np.median(s)):.0f} % of {n} core{'s' * (n > 1)}" for n, s in found.share.items())
    head = ["", "seconds", "ns per node-step and run", "sweep on one thread over it"]
    return (
        f"## The whole sweep\n\n{table(head, rows)}\n\n{found.runs} runs of {found.steps} steps, {found.nodes} nodes, "
        f"searched from both sides, histories of every step: {found.node_steps:.3g} node-steps, early ends left out. "
        f"Seconds of the whole call, during which it had {had}. The script does one stable run, searches "
        f"from one side and takes the faster of its searches."
    )


def widths(methods: Sequence[Widths], sizes: Sequence[Widths]) -> str:
    """Which number of lanes is fastest."""
    head = ["method, mesh", *(f"{lanes} lanes" if lanes > 1 else "1 lane" for lanes in WIDTHS), "best", "16 over best"]

    def row(name: str, found: Widths) -> list[str]:
        times = [ns(found.seconds[lanes]) for lanes in WIDTHS]
        over = ratio(found.seconds[16], found.seconds[found.best])
        return [name, *times, str(found.best), with_error(over)]

    rows = [row(f"{found.name}, {found.nodes} nodes", found) for found in [*methods, *sizes]]
    return (
        f"## Number of lanes, in ns per node-step and run\n\n{table(head, rows)}\n\nOne thread, contact from both "
        f"sides under way in every lane, p_s from 0.8 to 1.25, peaks only."
    )
