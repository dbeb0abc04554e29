"""The core's batch of runs, and the limits of a model whose bodies are scaled: all that a sweep asks of the core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from bipenalty import _core

if TYPE_CHECKING:
    from bipenalty.sweeps.plans import Plan

#: Energies are sampled every so many steps: peaks of displacement and the energy ratio rest on them.
ENERGY_EVERY = 10

#: Whether the core takes velocity, offset, young and density a run.
PER_RUN = hasattr(_core.Model, "scaled_critical_dt")


def start(
    model: _core.Model,
    runs: Sequence[Plan],
    velocity: Any,
    displacement: Any,
    *,
    allow_unstable: bool,
    displacement_limit: float | None,
    every: int,
) -> Any:
    """A batch of runs at t = 0; `every` = 0 keeps peaks only.

    Raises
    ------
    InputError : one of the runs is out of the core's bounds.
    """
    core: Any = _core
    limits = {"allow_unstable": allow_unstable, "displacement_limit": displacement_limit}
    if PER_RUN:
        record = {"every": every, "energy_every": ENERGY_EVERY, "lanes": 0, "isa": "auto"}
        return core.Batch(model, list(runs), velocity, displacement, **limits, **record)
    if any(run.velocity or run.offset or run.young or run.density for run in runs):
        raise NotImplementedError("this core has no velocity, offset, young or density of a single run")
    plain = [(run.method, run.dt, run.steps) for run in runs]
    record = {"every": every, "energy_every": ENERGY_EVERY}
    return core.Batch(model, plain, velocity=velocity, displacement=displacement, **limits, **record)


def scaled_limit(model: _core.Model, rule: str, young: Sequence[float], density: Sequence[float]) -> float:
    """Critical time step (s) by a rule, "element" or "assembled", with each body's constants scaled by a factor."""
    core: Any = model
    if not PER_RUN:
        raise NotImplementedError("this core has no limits of scaled bodies; give dt in seconds")
    limit = core.scaled_critical_dt if rule == "element" else core.scaled_assembled_critical_dt
    return float(limit(list(young), list(density)))
