"""What memory a sweep takes, stated beforehand, and what the machine has to spare."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from bipenalty import checks
from bipenalty.scene import Scene

#: Bytes of a run's peaks, flags, outcome and reason in the dataset.
PEAKS = 400
#: Bytes of a kept sample of the two histories in the dataset.
SAMPLE = 16
#: Bytes a node that a lane takes (displacements, velocities and buffers of its rows), and lanes of a thread.
NODE, LANES = 128, 16
#: Bytes that a run takes a kept step (contact) until it is in the dataset; buffers grow by doubling.
KEPT = 96
#: A task at work takes no more than this if its runs can be fewer.
TASK = 256 << 20


def sweep_memory(
    scene: Scene,
    runs: int,
    steps: int,
    *,
    histories: bool | int = False,
    chunk: int | None = None,
    in_flight: int = 0,
    stored: bool = False,
) -> int:
    """Memory that a sweep takes, bytes: the arrays of the dataset and one task at work, beside Python and its libraries.

    On an executor it is that of the driver, which has no task at work but the results of those in flight, and what
    this function says of one task holds for each worker.

    Parameters
    ----------
    scene : what is run.
    runs, steps : how many runs of how many steps, >= 1.
    histories : as for `sweep`.
    chunk : runs of a task at work at a time; as `sweep` would choose unless given.
    in_flight : tasks in flight on an executor; 0 for none.
    stored : whether results go into a Zarr store, so that they do not count.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> import bipenalty as bp
    >>> scene = bp.Scene([bp.Body("bar", bp.mesh.rectangle(1, 1, 4, 4), bp.LinearElastic(900, 0, 1))])
    >>> 1e6 < bp.sweep_memory(scene, runs=10_000, steps=2_000) < 100e6  # more for more processors
    True
    """
    every = stride(histories)
    count, length = checks.whole("sweep_memory", "runs", runs, 1), checks.whole("sweep_memory", "steps", steps, 1)
    size = default_chunk(scene.n_nodes, count, length, every) if chunk is None else checks.whole(
        "sweep_memory", "chunk", chunk, 1)  # fmt: skip
    kept, size = PEAKS + SAMPLE * samples(length, every), min(size, count)
    flying = checks.whole("sweep_memory", "in_flight", in_flight, 0) * size * kept
    lanes = min(size, LANES * (os.cpu_count() or 1))
    working = flying or lanes * NODE * scene.n_nodes + size * run_memory(length, every)
    return working + (0 if stored else count * kept)


def stride(histories: bool | int) -> int:
    """0 for peaks only, else every how many steps histories are kept."""
    if isinstance(histories, bool):
        return int(histories)
    return checks.whole("sweep", "histories", histories, 0)


def samples(steps: int, every: int) -> int:
    """How many samples are kept of so many steps."""
    return -(-steps // every) if every else 0


def run_memory(steps: int, every: int) -> int:
    """Bytes of a run until it is in the dataset, beside the lane it is in."""
    return PEAKS + (KEPT + SAMPLE) * samples(steps, every)


def default_chunk(nodes: int, runs: int, steps: int, every: int, *, tasks: int = 1, threads: int = 1) -> int:
    """Runs of a task: one or more for each lane of its threads, in at least so many tasks, memory allowing.

    Where several tasks are wanted, to be sent or stored, they hold 256 runs at most: little is lost with one.
    """
    lanes = LANES * threads
    wanted = min(256 if tasks > 1 else 4096, max(lanes, 8 * -(-runs // (8 * tasks))))
    states = max(1, TASK // (NODE * nodes))
    return max(1, min(wanted, max(states, threads), max(threads, TASK // run_memory(steps, every))))


def available_memory() -> int:
    """Bytes that can still be had: of the machine, of the container, of the process, whatever is least."""
    found = [1 << 62]
    with contextlib.suppress(OSError, StopIteration, ValueError):
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        found.append(1024 * int(next(line for line in lines if line.startswith("MemAvailable:")).split()[1]))
    if len(found) == 1:
        # No such file: what the machine has in all, which is more than can be had.
        with contextlib.suppress(AttributeError, OSError, ValueError):
            found.append(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    with contextlib.suppress(OSError, ValueError):
        group = Path("/sys/fs/cgroup")
        limit, used = (int((group / f"memory.{name}").read_text()) for name in ("max", "current"))
        found.append(max(0, limit - used))
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            found.append(limit)
    return min(found)


def check_memory(needed: int) -> None:
    """Raise an InputError when a sweep needs more memory than there is."""
    available = available_memory()
    remedy = "give store= a path ending in .zarr, a larger histories=, or leave histories out to keep peaks only"
    bound = f"at most the {available / 1e9:.3g} GB available"
    checks.within("sweep", "memory", f"{needed / 1e9:.3g} GB", needed <= available, bound, remedy)
