"""Examples as a user runs them: in a process and a folder of their own, warnings as errors."""

import os
import subprocess
import sys
from pathlib import Path


def run(name: str, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run an example script in a folder; figures without a screen, text in UTF-8."""
    script = Path(__file__).resolve().parents[1] / "examples" / name
    settings = {"MPLBACKEND": "Agg", "MPLCONFIGDIR": str(folder / "matplotlib"), "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(
        [sys.executable, "-W", "error", str(script), *arguments],
        cwd=folder,
        env={**os.environ, **settings},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
