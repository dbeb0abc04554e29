"""Results in a netCDF file: finished tasks wait as small files beside it, and become one file at the end."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from bipenalty.io import read_netcdf, write_netcdf
from bipenalty.sweeps.dataset import Coordinates, label_rest
from bipenalty.sweeps.files import check_call, chunk_in, replace
from bipenalty.sweeps.layout import Layout
from bipenalty.sweeps.lock import locked
from bipenalty.sweeps.store_memory import MemoryStore
from bipenalty.sweeps.work import Arrays


class NetcdfStore:
    """`name.nc`, and until it is whole `name.nc.parts` with one file a task."""

    keeps_partial = False

    def __init__(self, layout: Layout, coordinates: Coordinates, attrs: Mapping[str, Any], path: Path) -> None:
        self.path, self.layout, self.coordinates, self.attrs = path, layout, coordinates, dict(attrs)
        self.parts = path.with_name(path.name + ".parts")

    @staticmethod
    def chunk_of(path: Path) -> int | None:
        """Runs of a task of the store that is there, if one is."""
        parts = path.with_name(path.name + ".parts") / "call.json"
        if path.is_file():
            return chunk_in(read_netcdf(path).attrs)
        return chunk_in(json.loads(parts.read_text(encoding="utf-8"))) if parts.is_file() else None

    @contextlib.contextmanager
    def opened(self) -> Iterator[None]:
        """Locked, and with a folder for the parts unless the file is there already."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with locked(self.path):
            if self.path.exists():
                check_call(self.path, read_netcdf(self.path).attrs, self.attrs)
                shutil.rmtree(self.parts, ignore_errors=True)
            else:
                self.parts.mkdir(exist_ok=True)
                self._check_parts()
            yield

    def _check_parts(self) -> None:
        call = self.parts / "call.json"
        if call.exists():
            check_call(self.parts, json.loads(call.read_text(encoding="utf-8")), self.attrs)
        else:
            kept = {name: self.attrs[name] for name in ("fingerprint", "chunk", "version")}
            replace(call, json.dumps(kept).encode())

    def done(self) -> set[int]:
        """Tasks that need not be computed."""
        if self.path.exists():
            return set(range(self.layout.n_tasks))
        return {int(part.stem) for part in self.parts.glob("*.npz") if part.stem.isdigit()}

    def put(self, task: int, arrays: Arrays) -> None:
        """Write a task's arrays; the part is there wholly or not at all."""
        plain = {v.name: arrays[v.name] for v in self.layout.variables(timed=False)}
        plain = {name: values.astype(str) if values.dtype == object else values for name, values in plain.items()}
        partial = self.parts / "part.tmp"
        with partial.open("wb") as file:
            np.savez(file, **plain)
            file.flush()
            os.fsync(file.fileno())
        os.replace(partial, self.parts / f"{task:08d}.npz")

    def finish(self, lost: Mapping[int, str], rest: str) -> xr.Dataset:
        """The dataset, in memory; the file is written when no run is missing."""
        done = self.done()
        if self.path.exists():
            data = read_netcdf(self.path).reset_coords(drop=True).assign_coords(self.coordinates)
            return label_rest(data, self.layout, {}, rest)
        whole = MemoryStore(self.layout, self.coordinates, self.attrs, timed=False)
        for task in sorted(done):
            with np.load(self.parts / f"{task:08d}.npz", allow_pickle=False) as part:
                whole.put(task, dict(part))
        data = whole.finish(lost, rest)
        if len(done) == self.layout.n_tasks:
            write_netcdf(data, self.path)
            shutil.rmtree(self.parts)
        return data
