"""Files: netCDF for any dataset of the package, ParaView (VTU and PVD) for the snapshots of a run."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
import xarray as xr

from bipenalty.errors import InputError

# netCDF has neither booleans nor a missing value among its attributes: these words stand for them.
_WORDS = {"true": True, "false": False, "none": None}
_SNAPSHOT_VARIABLES = (
    "points",
    "triangles",
    "quads",
    "body_of_node",
    "displacement",
    "velocity",
    "snapshot_time",
)


def write_netcdf(dataset: xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write a dataset with its units and attributes to a netCDF file; returns the path.

    A file of that name is replaced only once the new one is complete, also if it is the file the dataset was
    read from. Attributes that are True, False or None are stored as "true", "false", "none" and come back as
    they were through `read_netcdf`.

    Raises
    ------
    InputError : the path is a folder.

    Example
    -------
    >>> import bipenalty as bp, xarray as xr
    >>> run = xr.Dataset({"penetration": ("time", [0.0, 1e-3], {"units": "m"})}, attrs={"failed": False})
    >>> bp.io.read_netcdf(bp.io.write_netcdf(run, "out/run.nc")).attrs
    {'failed': False}
    """
    target = Path(path)
    if target.is_dir():
        raise InputError(f'netCDF file "{target}": is a folder; give the name of a file, such as run.nc')
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        _with_attrs(dataset, _to_file).to_netcdf(partial)
        os.replace(partial, target)
    finally:
        with contextlib.suppress(FileNotFoundError):
            partial.unlink()
    return target


def read_netcdf(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read a dataset written by `write_netcdf`, wholly into memory; the file is closed again.

    Raises
    ------
    InputError : there is no such file.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(f'netCDF file "{source}": does not exist; the current folder is {os.getcwd()}')
    return _with_attrs(xr.load_dataset(source, decode_times=False), _from_file)


def write_paraview(dataset: xr.Dataset, folder: str | os.PathLike[str], name: str = "run") -> Path:
    """Write the snapshots of a run for ParaView; returns the path of the .pvd file to open there.

    One `name_0000.vtu` per snapshot and `name.pvd` with their times in s. Nodes are where they are at that
    time (no "Warp By Vector" needed). Point data: `displacement` in m, `velocity` and its magnitude `speed`
    in m/s, `body` (0, 1, ... in the order of the scene, which is the dataset's `body`). Cell data: `body`.

    Parameters
    ----------
    dataset : of one run with snapshots (`Model.run(t_end, snapshots=...)`).
    folder : made if need be; files of the same names are replaced.
    name : of the files, without a folder.

    Raises
    ------
    InputError : a dataset without snapshots, a name with a folder in it.
    """
    import meshio  # on first use: most runs write no VTU

    missing = [variable for variable in _SNAPSHOT_VARIABLES if variable not in dataset]
    if missing or dataset.sizes["snapshot_time"] == 0:
        lacks = f"has no {', '.join(missing)}" if missing else "has 0 snapshots"
        raise InputError(f"write_paraview: the dataset {lacks}; give it one run made with run(t_end, snapshots=...)")
    if not name or Path(name).name != name:
        raise InputError(f"write_paraview: name = {name!r}, must be a plain file name; the place goes into folder")
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)

    body = dataset["body_of_node"].values.astype(np.int64)
    cells = [(kind, dataset[f"{kind}s"].values.astype(np.int64)) for kind in ("triangle", "quad")]
    cells = [(kind, connectivity) for kind, connectivity in cells if len(connectivity)]
    times = dataset["snapshot_time"].values
    digits = max(4, len(str(len(times) - 1)))
    files = []
    for i in range(len(times)):
        frame = dataset.isel(snapshot_time=i)
        displacement, velocity = _padded(frame["displacement"].values), _padded(frame["velocity"].values)
        mesh = meshio.Mesh(
            _padded(dataset["points"].values) + displacement,
            cells,
            point_data={
                "displacement": displacement,
                "velocity": velocity,
                "speed": np.linalg.norm(velocity, axis=1),
                "body": body,
            },
            cell_data={"body": [body[connectivity[:, 0]] for _, connectivity in cells]},
        )
        files.append(f"{name}_{i:0{digits}d}.vtu")
        mesh.write(target / files[-1])
    collection = target / f"{name}.pvd"
    collection.write_text(_pvd(files, times.tolist()), encoding="utf-8")
    return collection


def _padded(vectors: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    """(N, 2) to (N, 3) with z = 0, the only vectors ParaView knows."""
    return np.column_stack([vectors, np.zeros(len(vectors))])


def _pvd(files: list[str], times: list[float]) -> str:
    rows = [
        f'    <DataSet timestep="{time!r}" group="" part="0" file={quoteattr(file)}/>'
        for file, time in zip(files, times, strict=True)
    ]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">'
    return "\n".join([head, "  <Collection>", *rows, "  </Collection>", "</VTKFile>\n"])


def _with_attrs(dataset: xr.Dataset, change: Callable[[Any], Any]) -> xr.Dataset:
    """A shallow copy with every attribute of the dataset and of its variables changed."""

    def changed(attrs: Mapping[Any, Any]) -> dict[Any, Any]:
        return {key: change(value) for key, value in attrs.items()}

    result = dataset.copy()
    result.attrs = changed(dataset.attrs)
    for variable in result.variables:
        result[variable].attrs = changed(dataset[variable].attrs)
    return result


def _to_file(value: Any) -> Any:
    if value is None:
        return "none"
    return str(bool(value)).lower() if isinstance(value, (bool, np.bool_)) else value


def _from_file(value: Any) -> Any:
    if isinstance(value, str):
        return _WORDS.get(value, value)
    return value.item() if isinstance(value, np.generic) else value
