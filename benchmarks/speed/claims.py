"""What is expected of speed, each beside what was measured."""

import timed_scenes as scenes
from claims import Claim
from measure import ratio, spread

from speed import single
from speed.kernel import Cell
from speed.large import Size, exponents
from speed.single import Single
from speed.start import Start
from speed.sweep import Sweep


def of_kernel(cells: list[Cell]) -> list[Claim]:
    """Sixteen lanes within the cache do at least 80 % of the multiply-adds there can be; one lane waits for memory.

    A share beyond 1 says that the probe has not found the ceiling.
    """
    small = min(cell.counts.nodes for cell in cells)
    found = []
    for cell in cells:
        where = f"{cell.counts.nodes} nodes"
        if cell.lanes == 16 and cell.counts.nodes == small:
            share = ratio(cell.counts.multiply_adds * cell.multiply_add, cell.seconds)
            text = f"multiply-adds of the bare kernel over the machine's, 16 lanes, {where}"
            found.append(Claim(text, share, least=0.8, ceiling=1.05))
        if cell.lanes == 1:
            text = f"bare kernel of one lane over streaming its matrix and state, {where}"
            found.append(Claim(text, ratio(cell.seconds, cell.streaming), most=1.3))
    return found


def of_single(measured: Single) -> list[Claim]:
    """Contact costs a fifth of the kernel at most, the mass penalty a tenth of the stiffness method."""
    cost, found = measured.seconds, []
    for kind in ("", single.PEAKS):
        stiff, mass = cost[scenes.STIFFNESS + kind], cost[scenes.BIPENALTY + kind]
        text = f"one run: contact, stiffness{kind}, over the bare kernel"
        found.append(Claim(text, ratio(stiff, cost[single.BARE]), most=1.2))
        found.append(Claim(f"one run: bipenalty over stiffness at equal dt{kind}", ratio(mass, stiff), most=1.1))
    return found


def of_sweep(sweep: Sweep) -> list[Claim]:
    """Contact and its records cost less than half of the kernel; two cores do the work of forty scripts."""
    one = sweep.threads[1] / sweep.node_steps
    best = min(sweep.kernel, key=lambda lanes: spread(sweep.kernel[lanes]).median)
    found = [
        Claim("whole sweep on one thread over the bare 16-lane kernel", ratio(one, sweep.kernel[16]), most=1.4),
        Claim(f"whole sweep over the best bare kernel ({best} lanes)", ratio(one, sweep.kernel[best]), most=1.4),
    ]
    if 2 in sweep.threads:
        two = sweep.threads[2] / sweep.node_steps
        found.append(Claim("script on one core over the sweep on two", ratio(sweep.script, two), least=40))
        found.append(Claim("whole sweep: two threads over one", ratio(one, two), least=1.85))
    return found


def of_large(sizes: list[Size]) -> list[Claim]:
    """Beyond the nearest cache a step goes at the pace of memory; it grows with the nodes, no faster."""
    found = []
    for size in sizes:
        if size.level > 0:
            text = f"one thread's share of the memory bandwidth, {size.counts.nodes} nodes"
            found.append(Claim(text, ratio(size.streaming, size.threads[1]), least=0.8))
    for level, exponent in exponents(sizes).items():
        nodes = [size.counts.nodes for size in sizes if size.level == level]
        text = f"exponent of the growth of a step, {nodes[0]} to {nodes[-1]} nodes"
        found.append(Claim(text, spread(exponent), most=1.05))
    return found


def of_start(start: Start) -> list[Claim]:
    """The start is short against the run."""
    text = f"start of a run over its {start.steps} steps, {start.nodes} nodes"
    return [Claim(text, ratio(start.whole, start.stepping), most=0.1)]
