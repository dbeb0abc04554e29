"""The result of one run: labelled arrays with units, and where to write them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from bipenalty import io


class Result:
    """What a run has observed; variables of the dataset are attributes too.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(1, 1, 4, 4), bp.LinearElastic(900, 0, 1), velocity=(1, 0))
    >>> result = bp.Model(bp.Scene([bar])).run(0.1)
    >>> result.kinetic_energy.attrs["units"]
    'J/m'
    """

    def __init__(self, dataset: xr.Dataset) -> None:
        self.dataset = dataset

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name == "dataset":
            raise AttributeError(name)
        if name in self.dataset.variables:
            return self.dataset[name]
        if name in self.dataset.attrs:
            return self.dataset.attrs[name]
        known = ", ".join(map(str, [*self.dataset.data_vars, *self.dataset.attrs]))
        raise AttributeError(f"result has no {name!r}; it has {known}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *map(str, self.dataset.variables), *self.dataset.attrs})

    def __repr__(self) -> str:
        a = self.dataset.attrs
        return f"<Result {a['method']}, ps = {a['ps']:g}: {a['outcome']} after {a['steps']} steps>"

    def to_netcdf(self, path: str | Path) -> Path:
        """Write the dataset as netCDF; a file that is there already is replaced once the new one is whole."""
        return io.write_netcdf(self.dataset, path)

    def to_paraview(self, folder: str | Path, name: str = "run") -> Path:
        """Write the snapshots as VTU files with a PVD collection; returns the collection's path."""
        return io.write_paraview(self.dataset, folder, name)
