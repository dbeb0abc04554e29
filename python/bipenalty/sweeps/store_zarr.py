"""Results in a Zarr store: one chunk a task in every array, and a mark once all of them are on the disk."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from bipenalty.errors import InputError
from bipenalty.sweeps.dataset import Coordinates, label_rest
from bipenalty.sweeps.files import check_call, chunk_in, replace, sync
from bipenalty.sweeps.layout import Layout
from bipenalty.sweeps.lock import locked
from bipenalty.sweeps.work import Arrays


def require_zarr() -> Any:
    """The zarr package.

    Raises
    ------
    InputError : it is not installed, or too old.
    """
    try:
        import zarr
        import zarr.dtype
    except ImportError:
        raise InputError(
            'store: the package "zarr" is missing, must be 3.1 or newer for a .zarr store; '
            "install bipenalty[sweep], or give a path ending in .nc"
        ) from None
    return zarr


class ZarrStore:
    """A folder of format 3: arrays of the grid's shape in blocks of a task; group `tasks` marks what is done."""

    keeps_partial = False

    def __init__(self, layout: Layout, coordinates: Coordinates, attrs: Mapping[str, Any], path: Path) -> None:
        self.path, self.layout, self.coordinates, self.attrs = path, layout, coordinates, dict(attrs)
        self.variables = layout.variables(timed=False)
        self.zarr = require_zarr()
        self.group: Any = None

    @staticmethod
    def chunk_of(path: Path) -> int | None:
        """Runs of a task of the store that is there, if one is."""
        about = path / "zarr.json"
        return chunk_in(json.loads(about.read_text(encoding="utf-8"))["attributes"]) if about.is_file() else None

    @contextlib.contextmanager
    def opened(self) -> Iterator[None]:
        """Locked, created if need be, and rid of what a killed driver left half written."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with locked(self.path):
            partial = self._beside("part")
            shutil.rmtree(partial, ignore_errors=True)
            if not self.path.exists():
                self._create(partial)
                os.rename(partial, self.path)
            self.group = self._open()
            self._sweep_up()
            yield

    def _beside(self, what: str) -> Path:
        return self.path.with_name(f".{self.path.name}.{what}")

    def _open(self) -> Any:
        try:
            group = self.zarr.open_group(self.path, mode="r+")
        except (OSError, ValueError):
            check_call(self.path, {}, self.attrs)
            raise
        check_call(self.path, dict(group.attrs), self.attrs)
        return group

    def _create(self, path: Path) -> None:
        # Names with a space cannot be listed: they are read as data, not as coordinates.
        others = [name for name in self.coordinates if name not in self.layout.dims and " " not in name]
        listed = {"coordinates": " ".join(others)} if others else {}
        group = self.zarr.create_group(path, attributes=self.attrs | listed)
        for name, (dims, values, attrs) in self.coordinates.items():
            array = self._array(group, name, dims, values.shape, values.shape, values.dtype.kind, "", attrs)
            array[...] = values
        for v in self.variables:
            last = v.kind == "history"
            dims = (*self.layout.dims, self.layout.time_dim) if last else self.layout.dims
            shape, block = ((*s, self.layout.samples) if last else s for s in (self.layout.shape, self.layout.block))
            kind = {"word": "O", "flag": "b"}.get(v.kind, "f")
            self._array(group, v.name, dims, shape, block, kind, v.fill, v.attrs)
        ones = (1,) * len(self.layout.shape)
        group.create_group("tasks").create_array(
            "done", shape=self.layout.blocks, chunks=ones, dtype="u1", fill_value=0, compressors=None
        )
        with warnings.catch_warnings():
            # Not part of the format yet, but what xarray reads first and asks for where it is missing.
            warnings.simplefilter("ignore")
            self.zarr.consolidate_metadata(path)

    def _array(
        self, group: Any, name: str, dims: Any, shape: Any, chunks: Any, kind: str, fill: Any, attrs: Any
    ) -> Any:
        text = self.zarr.dtype.VariableLengthUTF8()
        dtype, empty = {"O": (text, fill), "b": ("bool", False), "i": ("i8", 0)}.get(kind, ("f8", np.nan))
        more = {"fill_value": empty, "dimension_names": dims, "attributes": attrs}
        return group.create_array(name, shape=shape, chunks=chunks, dtype=dtype, **more)

    def _sweep_up(self) -> None:
        """Remove the files that zarr was writing when a driver was killed."""
        for partial in self.path.rglob("*.partial"):
            partial.unlink()

    def done(self) -> set[int]:
        """Tasks that are marked."""
        return {int(task) for task in np.flatnonzero(self.group["tasks/done"][...])}

    def put(self, task: int, arrays: Arrays) -> None:
        """Write a task's arrays, see them onto the disk, then mark it."""
        region, shape = self.layout.region(task), self.layout.region_shape(task)
        place = [str(i) for i in self.layout.place(task)]
        for v in self.variables:
            values = np.reshape(arrays[v.name], (*shape, *np.shape(arrays[v.name])[1:]))
            history = v.kind == "history"
            self.group[v.name][(*region, slice(None)) if history else region] = values
            sync(self.path.joinpath(v.name, "c", *place, *(["0"] if history else [])))
        # An array of single bytes, not compressed: the mark is a file of one byte that appears at once.
        mark = self.path.joinpath("tasks", "done", "c", *place)
        mark.parent.mkdir(parents=True, exist_ok=True)
        replace(mark, b"\x01", self._beside("mark"))

    def finish(self, lost: Mapping[int, str], rest: str) -> xr.Dataset:
        """The dataset, read from the store where it is used; outcome, reason and failed are in memory."""
        data = xr.open_zarr(self.path, chunks=None)
        # Coordinates are the call's own; the rest is read where it is used.
        data = data[[v.name for v in self.variables]].reset_coords(drop=True).assign_coords(self.coordinates)
        data.attrs = dict(self.attrs)
        return label_rest(data, self.layout, lost, rest)
