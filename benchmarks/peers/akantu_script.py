"""Run by the interpreter that has Akantu, in a folder with discs.msh, material.dat and case.json: writes result.npz.

Akantu reads its input once a process, and a run that goes wrong may take the process with it: hence a script apart.
"""

import json
import time
from pathlib import Path

import akantu
import numpy as np


def main() -> None:
    """The time loop, with the histories that the others keep too."""
    case = json.loads(Path("case.json").read_text(encoding="utf-8"))
    akantu.parseInput("material.dat")
    # Akantu keeps no hold of what it is given: mesh and selectors need names here as long as the models live.
    mesh = akantu.Mesh(2)
    mesh.read("discs.msh")
    coupled = akantu.CouplerSolidContact(mesh)
    solid, contact = coupled.getSolidMechanicsModel(), coupled.getContactMechanicsModel()
    materials = akantu.MeshDataMaterialSelectorString("physical_names", solid)
    solid.setMaterialSelector(materials)
    coupled.initFull(_analysis_method=akantu._explicit_lumped_mass)
    surfaces = akantu.PhysicalSurfaceSelector(mesh)
    contact.getContactDetector().setSurfaceSelector(surfaces)
    coupled.setTimeStep(case["dt"])
    velocity = solid.getVelocity()
    top, bottom = slice(0, case["nodes"] // 2), slice(case["nodes"] // 2, case["nodes"])
    velocity[bottom] = case["velocity"]
    solid.assembleMassLumped()
    mass, start = solid.getMass().copy(), solid.getEnergy("kinetic")
    before = (mass * velocity).sum(axis=0)
    gaps, pushes = contact.getGaps(), contact.getInternalForce()
    force, depth = np.zeros(case["steps"]), 0.0
    clock = time.perf_counter()
    for step in range(case["steps"]):
        coupled.solveStep()
        force[step] = np.linalg.norm(pushes[top], axis=1).sum()
        depth = max(depth, float(gaps.max()))
    seconds = time.perf_counter() - clock
    change = np.linalg.norm((mass * velocity).sum(axis=0) - before) / np.linalg.norm(before)
    energy = (solid.getEnergy("kinetic") + solid.getEnergy("potential")) / start
    found = {"force": force, "seconds": seconds, "depth": depth, "momentum_error": change, "energy_ratio": energy}
    np.savez("result.npz", **found)


if __name__ == "__main__":
    main()
