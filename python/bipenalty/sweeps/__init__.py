"""Sweeps: many runs of one scene, on one machine or many, in memory or into a store that can be resumed."""

from bipenalty.sweeps.grid import grid
from bipenalty.sweeps.memory import sweep_memory
from bipenalty.sweeps.sweep import sweep

__all__ = ["grid", "sweep", "sweep_memory"]
