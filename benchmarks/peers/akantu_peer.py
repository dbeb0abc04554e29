"""Akantu: central differences with lumped mass, coupled to its penalty contact, both from Python."""

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import bipenalty as bp
from peers.interface import (
    DENSITY,
    POISSON,
    VELOCITY,
    YOUNG,
    Case,
    Outcome,
    impulse_of_steps,
    scene,
    segment_length,
    unfinished,
)

SCRIPT = Path(__file__).with_name("akantu_script.py")

#: Its contact: the nodes of the top cylinder on the segments of the bottom one, linear and without friction. Nothing
#: else that was tried keeps the momentum either: sides swapped, two passes, the other detector, a rigid primary side.
CONTACT = """
contact_detector [
  type = explicit
  master = contact_bottom
  slave = contact_top
  projection_tolerance = 1e-10
  max_iterations = 100
  extension_tolerance = 1e-5
]
contact_resolution penalty_linear [
  name = contact_top
  mu = 0.0
  epsilon_n = {epsilon!r}
  epsilon_t = 0.0
  is_master_deformable = true
]
"""


@dataclass(frozen=True)
class Akantu:
    """Runs in the interpreter that has the package akantu: this one, or another that is named.

    Parameters
    ----------
    python : path of that interpreter.
    """

    python: str = sys.executable
    name: str = "Akantu"
    install: str = "Python package akantu (pip), here or where --akantu-python points to"
    better: str = "3-D, friction, plasticity, damage, cohesive fracture, heat, implicit solvers"
    rounds: int = 3

    def available(self) -> str | None:
        """Version of the package akantu."""
        ask = "import akantu; from importlib.metadata import version; print(version('akantu'))"
        try:
            asked = subprocess.run([self.python, "-c", ask], capture_output=True, text=True, timeout=60, check=False)
        except OSError:
            return None
        return asked.stdout.split()[-1] if asked.returncode == 0 and asked.stdout.split() else None

    def run(self, mesh: bp.Mesh, case: Case) -> Outcome:
        """One process of its own."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write(folder, mesh, case)
            alone = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": ""}
            command = [self.python, str(SCRIPT)]
            try:
                ran = subprocess.run(
                    command, cwd=folder, env=alone, capture_output=True, text=True, timeout=case.limit, check=False
                )
            except subprocess.TimeoutExpired:
                return unfinished("time limit", "", case.limit)
            return read(folder, case, ran.returncode, ran.stdout + ran.stderr)


def write(folder: Path, mesh: bp.Mesh, case: Case) -> None:
    """Its three input files. The penalty of a node is epsilon_n times the length that the node stands for."""
    top, bottom = (body.mesh for body in scene(mesh).bodies)
    material = "".join(
        f"material elastic [\n  name = {name}\n  rho = {DENSITY!r}\n  E = {young!r}\n  nu = {POISSON!r}\n]\n"
        for name, young in zip(("top", "bottom"), YOUNG, strict=True)
    )
    text = material + CONTACT.format(epsilon=float(case.alpha_s / segment_length(mesh)))
    (folder / "material.dat").write_text(text, encoding="utf-8")
    (folder / "discs.msh").write_text(gmsh(top, bottom), encoding="utf-8")
    about = {"dt": case.dt, "steps": case.steps, "nodes": top.n_nodes + bottom.n_nodes, "velocity": VELOCITY}
    (folder / "case.json").write_text(json.dumps(about), encoding="utf-8")


def gmsh(top: bp.Mesh, bottom: bp.Mesh) -> str:
    """Both meshes in gmsh's format 2.2, with named bodies and rims."""
    rims: list[str] = []
    quads: list[str] = []
    for number, (body, first) in enumerate(((top, 0), (bottom, top.n_nodes)), start=1):
        rim = np.stack([body.loops[0], np.roll(body.loops[0], -1)], axis=1)
        rims += [f"1 2 {number + 2} {number + 2} {a} {b}" for a, b in rim + first + 1]
        quads += [f"3 2 {number} {number} {a} {b} {c} {d}" for a, b, c, d in body.quads + first + 1]
    points, rows = np.concatenate([top.points, bottom.points]), rims + quads
    names = ['2 1 "top"', '2 2 "bottom"', '1 3 "contact_top"', '1 4 "contact_bottom"']
    blocks = {
        "MeshFormat": ["2.2 0 8"],
        "PhysicalNames": [str(len(names)), *names],
        "Nodes": [str(len(points)), *(f"{i} {x!r} {y!r} 0" for i, (x, y) in enumerate(points.tolist(), start=1))],
        "Elements": [str(len(rows)), *(f"{i} {row}" for i, row in enumerate(rows, start=1))],
    }
    return "".join("\n".join([f"${name}", *lines, f"$End{name}", ""]) for name, lines in blocks.items())


def read(folder: Path, case: Case, code: int, text: str) -> Outcome:
    """What the script left; Akantu's own words if it did not come so far."""
    if not (folder / "result.npz").exists():
        last = [line.strip() for line in text.splitlines() if line.strip()][-1:]
        return unfinished("stopped", " ".join([f"exit code {code}", *last]), float("nan"))
    with np.load(folder / "result.npz") as found:
        return Outcome(
            float(found["seconds"]),
            case.steps,
            *impulse_of_steps(found["force"], case.dt),
            summed=True,
            penetration=float(found["depth"]),
            momentum_error=float(found["momentum_error"]),
            energy_ratio=float(found["energy_ratio"]),
            said=" ".join(line.strip() for line in text.splitlines() if "rror" in line or "arning" in line)[:200],
        )
