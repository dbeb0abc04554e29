"""CalculiX: *DYNAMIC, EXPLICIT with its node-to-surface penalty contact, on one layer of bricks."""

import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from versus_script import prepared

import bipenalty as bp
from peers.calculix_files import Table, deck, tables
from peers.interface import Array, Case, Outcome, scene, unfinished
from peers.scipy_peer import changes

OFTEN, SELDOM, NEVER = 2, 50, 10**8  # steps between prints; every second one alone makes 300 MB


@dataclass(frozen=True)
class CalculiX:
    """The solver ccx.

    Parameters
    ----------
    command : its name, or its path.
    """

    command: str = "ccx"
    name: str = "CalculiX"
    install: str = "package calculix-ccx of Debian or Ubuntu, calculix of conda; --ccx names another command"
    better: str = "3-D, shells, friction, plasticity, large strains, heat, statics, frequencies"
    rounds: int = 3

    def available(self) -> str | None:
        """Version that the solver prints."""
        path = shutil.which(self.command)
        if path is None:
            return None
        told = subprocess.run([path, "-v"], capture_output=True, text=True, timeout=60, check=False).stdout
        found = re.search(r"Version\s+(\S+)", told)
        return found.group(1) if found else None

    def run(self, mesh: bp.Mesh, case: Case) -> Outcome:
        """One run, less what a run of one step takes: reading, numbering and writing are not the time loop."""
        start, _, _, _ = self._call(mesh, replace(case, t_end=case.dt), NEVER)
        every = NEVER if not case.recorded else OFTEN if case.ps == 1 else SELDOM
        seconds, ended, said, printed = self._call(mesh, case, every)
        return judged_by_prints(mesh, case, printed, every, max(seconds - start, 0.0), ended, said)

    def _call(self, mesh: bp.Mesh, case: Case, every: int) -> tuple[float, str, str, list[Table]]:
        """Seconds, how it ended, its words, and its tables."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "discs.inp").write_text(deck(mesh, case, every), encoding="utf-8")
            one = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
            # Line by line, so that the words of a run that is cut off are not lost.
            lines_first = ["stdbuf", "-oL"] if shutil.which("stdbuf") else []
            command, ended = [*lines_first, shutil.which(self.command) or self.command, "discs"], "finished"
            clock = time.perf_counter()
            try:
                ran = subprocess.run(command, cwd=folder, env=one, capture_output=True, timeout=case.limit, check=False)
                text = (ran.stdout + ran.stderr).decode(errors="replace")
                ended = "finished" if "Job finished" in text else "stopped"
            except subprocess.TimeoutExpired as cut:
                ended, text = "time limit", (cut.stdout or b"").decode(errors="replace")
            seconds, file = time.perf_counter() - clock, folder / "discs.dat"
            said = "; ".join(sorted(set(re.findall(r"\*(?:ERROR|WARNING)[^\n]*", text))))
            if not file.exists():
                return seconds, ended, said, []
            with file.open(encoding="utf-8", errors="replace") as lines:
                return seconds, ended, said, list(tables(lines))


def judged_by_prints(
    mesh: bp.Mesh, case: Case, printed: Sequence[Table], every: int, seconds: float, ended: str, said: str
) -> Outcome:
    """What the printed displacements and velocities say; the resultant force is what the top cylinder gained."""
    both = scene(mesh)
    problem, half = prepared(both), mesh.n_nodes
    whole = [table for table in printed if len(table.nodes) == both.n_nodes]
    u, v = ([t for t in whole if t.what == what] for what in ("displacements", "velocities"))
    count = min(len(u), len(v))
    if count == 0:
        return unfinished(ended, said, seconds)
    with np.errstate(all="ignore"):
        mass, times = problem["mass"], np.array([0.0, *(t.time for t in v[:count])])
        momentum = np.array([np.zeros(2), *(mass[:half] @ t.values[:half, :2] for t in v[:count])])
        impulse = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(momentum, axis=0), axis=1))])
        x = np.concatenate([body.mesh.points for body in both.bodies])
        loops = both.bodies[0].mesh.loops[0], both.bodies[1].mesh.loops[0] + half
        moved = (x + t.values[:, :2] for t in u[:count])
        depth = max(deepest(points[loops[0]], points[loops[1]]) for points in moved)
    last, velocity = u[count - 1].values[:, :2], v[count - 1].values[:, :2]
    steps = steps_taken(times[1:], every, case)
    kept = changes(problem, both.velocity, last, last, velocity)
    return Outcome(seconds, steps, times, impulse, False, depth, *kept, ended, said)


def steps_taken(times: Array, every: int, case: Case) -> int:
    """From the times of the prints (s), one in `every` steps and one at the end; CalculiX does not count them itself.

    Example
    -------
    >>> steps_taken(np.array([0.2, 0.4, 0.6, 0.7]), every=2, case=Case(1.0, dt=0.1, t_end=0.7))
    7
    """
    if len(times) < 2:
        return case.steps
    steps = np.diff(times[:-1]) / every if len(times) > 2 else np.diff(times) / every
    return (len(times) - 1) * every + max(1, round(float((times[-1] - times[-2]) / steps[-1])))


def deepest(nodes: Array, loop: Array) -> float:
    """How deep (m) the deepest of the nodes (n, 2) is in the body whose counter-clockwise rim is `loop` (m, 2); >= 0.

    Example
    -------
    >>> square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> deepest(np.array([[0.5, 0.75], [2.0, 2.0]]), square)
    0.25
    """
    start, along = loop, np.roll(loop, -1, axis=0) - loop
    from_start = nodes[:, None] - start
    length = np.linalg.norm(along, axis=1)
    share = np.clip((from_start * along).sum(axis=2) / length**2, 0, 1)
    distance = np.linalg.norm(from_start - share[..., None] * along, axis=2)
    nearest = distance.argmin(axis=1)
    here = np.arange(len(nodes)), nearest
    inward = along[nearest, 0] * from_start[here][:, 1] - along[nearest, 1] * from_start[here][:, 0]
    return float(np.where(inward > 0, distance[here], 0.0).max())
