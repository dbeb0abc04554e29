"""What the measurements were made on."""

import os
import platform
import subprocess
from pathlib import Path

import numpy as np
import scipy

import bipenalty as bp
from bipenalty import _core


def description() -> dict[str, str]:
    """Machine and software, in the order of the report.

    Example
    -------
    >>> "processor" in description()
    True
    """
    return {
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "instruction set of the kernel": _core.instruction_set,
        "system": f"{platform.system()} {platform.release()}, {platform.machine()}",
        "load average": load(),
        "bipenalty": bp.__version__,
        "Python": f"{platform.python_version()} ({platform.python_implementation()})",
        "NumPy": np.__version__,
        "SciPy": scipy.__version__,
    }


def processor() -> str:
    """Its name as the system gives it."""
    try:
        if platform.system() == "Darwin":
            command = ["sysctl", "-n", "machdep.cpu.brand_string"]
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration, subprocess.CalledProcessError):
        return platform.processor() or "unknown"


def load() -> str:
    """Programs that wanted a core over the last minute, before the benchmark began."""
    try:
        return f"{os.getloadavg()[0]:.2f}"
    except OSError:
        return "unknown"
