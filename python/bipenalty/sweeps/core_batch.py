"""The core's batch of runs, and the limits of a model whose bodies are scaled: all that a sweep asks of the core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from bipenalty import _core

if TYPE_CHECKING:
    from bipenalty.sweeps.plans import Plan


def start(
    model: _core.Model,
    runs: Sequence[Plan],
    velocity: Any,
    displacement: Any,
    *,
    allow_unstable: bool,
    displacement_limit: float | None,
    every: int,
    lanes: int = 0,
    isa: str = "auto",
) -> _core.Batch:
    """A batch of runs that are to begin; `every` = 0 keeps peaks only. A run out of its bounds ends as "refused"."""
    return _core.Batch(
        model,
        list(runs),
        velocity,
        displacement,
        allow_unstable=allow_unstable,
        displacement_limit=displacement_limit,
        every=every,
        lanes=lanes,
        isa=isa,
    )


def scaled_limit(model: _core.Model, rule: str, young: Sequence[float], density: Sequence[float]) -> float:
    """Critical time step (s) by a rule, "element" or "assembled", with each body's constants scaled by a factor."""
    return model.scaled_critical_dt(list(young), list(density), rule == "assembled")
