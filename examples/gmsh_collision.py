"""Two bodies meshed with gmsh collide: a blunt wedge is thrown at a supported block with a round hole.

Shows how a .msh file is read by region, how a named boundary is supported, and what to check after a run.
Writes out/gmsh_collision/run.pvd for ParaView and out/gmsh_collision.png. Plane strain, SI units.

    python examples/gmsh_collision.py
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import bipenalty as bp

MESH = Path(__file__).parent / "meshes" / "wedge_and_block.msh"
OUT = Path("out")
SPEED = 6.0  # m/s, downwards
T_END = 4e-3  # s
PICTURES = np.array([0.0, 0.4e-3, 0.8e-3, 1.6e-3, 2.4e-3, 4.0e-3])  # s


def collide() -> bp.Result:
    """Throw the hammer, 0.5 mm above the anvil at first, at the anvil, whose base does not move."""
    hammer = bp.Body(
        "hammer",
        bp.mesh.read(MESH, region="hammer"),
        bp.LinearElastic(young=200e6, poisson=0.35, density=1200.0),
        velocity=(0.0, -SPEED),
    )
    anvil = bp.Body(
        "anvil",
        bp.mesh.read(MESH, region="anvil"),
        bp.LinearElastic(young=40e6, poisson=0.4, density=1100.0),
    )
    scene = bp.Scene(
        [hammer, anvil],
        contacts=[bp.Contact("hammer", "anvil")],
        constraints=[bp.Support("anvil", on="base")],
    )
    return bp.Model(scene, bp.Bipenalty()).run(T_END, snapshots=PICTURES)


def total_energy(run: xr.Dataset) -> xr.DataArray:
    """Energy of the bodies and the contact together, J/m, in time."""
    parts = ("kinetic_energy", "strain_energy", "penalty_energy", "mass_penalty_energy", "damping_loss")
    return sum((run[part] for part in parts[1:]), start=run[parts[0]])


def check(run: xr.Dataset) -> None:
    """What mechanics asks of any such run, and the numbers of this one."""
    assert run.attrs["outcome"] == "finished", run.attrs["reason"]
    hammer = run["momentum"].sel(body="hammer")
    gained = (hammer[-1] - hammer[0]).values  # N s/m
    impulse = run.attrs["dt"] * run["force_on"].sum("time")[0].values
    np.testing.assert_allclose(gained, impulse, atol=1e-9 * abs(impulse[1]))

    energy = total_energy(run)
    assert abs(energy / energy[0] - 1).max() < 1e-3  # nothing gained or lost in the contact

    nose_segment = 1.6e-3  # m
    assert 0 < run.attrs["max_penetration"] < 0.05 * nose_segment

    assert run["contact_force"][-1] == 0  # they have parted
    restitution = float(-hammer.sel(axis="y")[-1] / hammer.sel(axis="y")[0])
    assert 0.92 < restitution < 0.96  # the rest of the energy rings in the bodies

    base = bp.mesh.read(MESH, region="anvil").nodes_of("base")
    anvil = run["displacement"][:, run["body_of_node"].values == 1]
    assert (anvil[:, base] == 0).all()
    print(
        f"peak force {1e-3 * run.attrs['peak_force']:.1f} kN/m, impulse {impulse[1]:.2f} N s/m, "
        f"restitution {restitution:.3f}, penetration at most {1e6 * run.attrs['max_penetration']:.0f} um"
    )


def draw(run: xr.Dataset, path: Path) -> None:
    """The bodies at the snapshots, coloured by speed, above the histories of force and energy."""
    figure = plt.figure(figsize=(11, 11), layout="constrained")
    rows = figure.subfigures(2, 1, height_ratios=[2.1, 1])
    panels = rows[0].subplots(2, 3, sharex=True, sharey=True)
    triangles = run["triangles"].values
    top_speed = float(np.linalg.norm(run["velocity"], axis=-1).max())
    for panel, time in zip(panels.flat, run["snapshot_time"].values, strict=True):
        frame = run.sel(snapshot_time=time)
        x, y = 1e3 * (run["points"] + frame["displacement"]).values.T
        speed = np.linalg.norm(frame["velocity"], axis=-1)
        colours = panel.tripcolor(x, y, triangles, speed, shading="gouraud", vmin=0, vmax=top_speed)
        panel.triplot(x, y, triangles, color="white", linewidth=0.25, alpha=0.6)
        panel.set(aspect="equal", title=f"t = {1e3 * time:.2f} ms")
    for panel in panels[:, 0]:
        panel.set_ylabel("y (mm)")
    for panel in panels[-1]:
        panel.set_xlabel("x (mm)")
    rows[0].colorbar(colours, ax=panels, label="speed (m/s)", shrink=0.7)

    left, right = rows[1].subplots(1, 2)
    left.plot(1e3 * run["time"], 1e-3 * run["contact_force"])
    left.set(xlabel="time (ms)", ylabel="contact force (kN/m)", title="Contact force")
    ms = 1e3 * run["energy_time"]
    right.plot(ms, total_energy(run), color="black", label="total")
    right.plot(ms, run["kinetic_energy"], label="kinetic")
    right.plot(ms, run["strain_energy"], label="strain")
    right.plot(ms, run["penalty_energy"] + run["mass_penalty_energy"], label="in the penalties")
    right.set(xlabel="time (ms)", ylabel="energy (J/m)", title="Energy", ylim=(0, None))
    right.legend()
    for axes in (left, right):
        axes.grid(alpha=0.3)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def main() -> None:
    """Run, check, draw."""
    result = collide()
    check(result.dataset)
    draw(result.dataset, OUT / "gmsh_collision.png")
    print(f"open {result.to_paraview(OUT / 'gmsh_collision')} in ParaView")


if __name__ == "__main__":
    main()
