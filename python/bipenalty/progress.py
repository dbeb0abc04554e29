"""Progress of long work: a bar with a rate and an estimate on a terminal, silence elsewhere."""

from __future__ import annotations

import sys
from typing import Any

from tqdm import tqdm


def bar(total: float, unit: str, describe: str, show: bool | None) -> Any:
    """A tqdm bar; `show` None means on a terminal only."""
    visible = sys.stderr.isatty() if show is None else show
    return tqdm(
        total=total,
        unit=unit,
        desc=describe,
        disable=not visible,
        leave=False,
        dynamic_ncols=True,
        unit_scale=total >= 10_000,
        smoothing=0.1,
    )
