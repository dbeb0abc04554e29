"""The cluster example, run as a user runs it, twice: the second time finds everything in the store."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

import bipenalty as bp

SCRIPT = Path(__file__).resolve().parents[1] / "examples" / "cluster_sweep.py"


def run(folder: Path) -> str:
    """What the example prints; it asserts its numbers itself."""
    command = [sys.executable, "-W", "error", str(SCRIPT)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_cluster_example(tmp_path: Path) -> None:
    first, second = run(tmp_path), run(tmp_path)
    assert first.startswith("78 runs, 13 tasks computed now")
    assert second.startswith("78 runs, 0 tasks computed now")
    depth = re.search(r"p_s = 1 +penetration at most (\S+) mm", first)
    assert depth is not None
    assert first.splitlines()[1:] == second.splitlines()[1:]
    scene, worst = runpy.run_path(str(SCRIPT))["collision"](), 0.0
    for s2 in (0.25, 1.75):
        worst = max(worst, bp.Model(scene, bp.Bipenalty(1.0, s2=s2)).run(0.18).max_penetration)
    assert 1e3 * worst <= float(depth[1]) + 5e-4
