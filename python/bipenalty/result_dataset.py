"""From the core's arrays to a dataset with names, dimensions and units."""

from __future__ import annotations

import math
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from bipenalty import _core
from bipenalty.methods.method import Method, damping_factor, penalty_factor, penalty_ratio

if TYPE_CHECKING:
    from bipenalty.model import Model

#: name: (unit, long name); everything per metre of depth.
ENERGIES = {
    "kinetic_energy": ("J/m", "kinetic energy"),
    "strain_energy": ("J/m", "strain energy"),
    "penalty_energy": ("J/m", "energy in the stiffness penalties"),
    "mass_penalty_energy": ("J/m", "kinetic energy of the mass penalties"),
    "load_potential": ("J/m", "potential of the body forces"),
    "damping_loss": ("J/m", "energy taken out by the damping penalties"),
}
AXES = ["x", "y"]


def package_version() -> str:
    """Version of the installed package."""
    try:
        return version("bipenalty")
    except PackageNotFoundError:
        return _core.__version__


def method_attributes(method: Method, dt: float) -> dict[str, float | str]:
    """Label and parameters of a method; 0 for a penalty it does not have, R infinite without mass penalty."""
    ratio, damping = penalty_ratio(method, dt), damping_factor(method, dt)
    zeta = 0.0 if math.isinf(ratio) else damping * math.sqrt(ratio) / 2
    return {"method": method.label, "ps": penalty_factor(method), "R": ratio, "D": damping, "zeta": zeta}


def run_dataset(model: Model, core: _core.Model, seen: dict[str, Any]) -> xr.Dataset:
    """The dataset of one run."""
    dt, bodies = model.dt, [body.name for body in model.scene.bodies]
    times = {"time": "time_step", "energy_time": "energy_step", "snapshot_time": "snapshot_step"}
    coords: dict[str, Any] = {
        dim: (dim, seen[key] * dt, {"units": "s", "long_name": "time"}) for dim, key in times.items()
    }
    coords |= {"axis": AXES, "body": bodies, "contact": list(core.contacts)}
    snapshot_shape = (len(seen["snapshot_step"]), model.scene.n_nodes, 2)

    def snapshots(name: str) -> Any:
        return np.array(seen[name], dtype=float).reshape(snapshot_shape)

    data: dict[str, Any] = {
        "contact_force": ("time", seen["contact_force"], _about("N/m", "total contact force, compression positive")),
        "penetration": ("time", seen["penetration"], _about("m", "deepest penetration")),
        "active_rows": ("time", seen["active_rows"], _about("1", "active rows")),
        "force_on": (("time", "contact", "axis"), seen["force_on"], _about("N/m", "force on the first-named body")),
        "momentum": (("energy_time", "body", "axis"), seen["momentum"], _about("N s/m", "momentum")),
        "largest_displacement": ("energy_time", seen["largest_displacement"], _about("m", "largest displacement")),
        "displacement": (("snapshot_time", "node", "axis"), snapshots("displacement"), _about("m", "displacement")),
        "velocity": (("snapshot_time", "node", "axis"), snapshots("velocity"), _about("m/s", "velocity")),
    }
    for name, (unit, about) in ENERGIES.items():
        data[name] = ("energy_time", seen[name], _about(unit, about))
    data |= _mesh(model)
    return xr.Dataset(data, coords, _attributes(model, seen))


def _about(units: str, long_name: str) -> dict[str, str]:
    return {"units": units, "long_name": long_name}


def _mesh(model: Model) -> dict[str, Any]:
    """Mesh of all bodies in the model's node numbers."""
    meshes = [body.mesh for body in model.scene.bodies]
    first = np.cumsum([0] + [mesh.n_nodes for mesh in meshes])
    points = np.concatenate([mesh.points for mesh in meshes])
    triangles = np.concatenate([mesh.triangles + n for mesh, n in zip(meshes, first, strict=False)])
    quads = np.concatenate([mesh.quads + n for mesh, n in zip(meshes, first, strict=False)])
    body_of_node = np.repeat(np.arange(len(meshes)), [mesh.n_nodes for mesh in meshes])
    return {
        "points": (("node", "axis"), points, _about("m", "reference coordinates")),
        "triangles": (("triangle", "triangle_corner"), triangles, _about("1", "nodes of the triangles")),
        "quads": (("quad", "quad_corner"), quads, _about("1", "nodes of the quads")),
        "body_of_node": ("node", body_of_node, _about("1", "body of the node")),
    }


def _attributes(model: Model, seen: dict[str, Any]) -> dict[str, Any]:
    summary = (
        "outcome",
        "reason",
        "steps",
        "max_penetration",
        "max_displacement",
        "peak_force",
        "impulse",
        "energy_ratio",
        "energy_made",
        "row_steps",
        "block_operations",
        "seconds",
    )
    steps = {"dt": model.dt, "critical_dt": model.critical_dt}
    about = {name: seen[name] for name in summary}
    return method_attributes(model.method, model.dt) | steps | about | {"version": package_version()}
