"""Results in memory: full arrays of the grid, filled block by block."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from bipenalty.sweeps.dataset import Coordinates, label_rest
from bipenalty.sweeps.layout import Layout
from bipenalty.sweeps.work import Arrays

_TYPES = {"number": float, "history": float, "flag": bool, "word": object}


class MemoryStore:
    """Arrays of the whole grid; `keeps_partial`: what an interrupted task has got to counts too."""

    keeps_partial = True

    def __init__(
        self, layout: Layout, coordinates: Coordinates, attrs: Mapping[str, Any], path: None = None, timed: bool = True
    ) -> None:
        self.layout, self.coordinates, self.attrs = layout, coordinates, dict(attrs)
        self.variables = layout.variables(timed)

    @functools.cached_property
    def arrays(self) -> Arrays:
        """The arrays, made when they are first needed: until then Ctrl-C has nothing to wait for."""
        found: Arrays = {}
        for variable in self.variables:
            shape = (*self.layout.shape, self.layout.samples) if variable.kind == "history" else self.layout.shape
            found[variable.name] = np.full(shape, variable.fill, dtype=_TYPES[variable.kind])
        return found

    @contextlib.contextmanager
    def opened(self) -> Iterator[None]:
        """Nothing to open."""
        yield

    def done(self) -> set[int]:
        """No task is there beforehand."""
        return set()

    def put(self, task: int, arrays: Arrays) -> None:
        """Take in a task's arrays."""
        region, shape = self.layout.region(task), self.layout.region_shape(task)
        for name, values in self.arrays.items():
            values[region] = np.reshape(arrays[name], (*shape, *np.shape(arrays[name])[1:]))

    def finish(self, lost: Mapping[int, str], rest: str) -> xr.Dataset:
        """The dataset; runs that were not computed are labelled "lost" or `rest`."""
        data: dict[str, Any] = {}
        for variable in self.variables:
            time = (self.layout.time_dim,) if variable.kind == "history" else ()
            data[variable.name] = ((*self.layout.dims, *time), self.arrays[variable.name], variable.attrs)
        return label_rest(xr.Dataset(data, dict(self.coordinates), self.attrs), self.layout, lost, rest)
