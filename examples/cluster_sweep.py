"""A grid on a cluster, into a store that goes on after a kill: penalty factor and s^2 = R dt^2 for two cylinders.

The cluster is two processes of this machine; for several machines give the address of dask's scheduler. Kill it at any
moment and start it again: what is in the store is not computed anew. Writes out/cluster_sweep.zarr. SI units.

    python examples/cluster_sweep.py [--scheduler tcp://first:8786]
"""

import argparse
import logging
from pathlib import Path

import numpy as np
import xarray as xr
from distributed import Client, LocalCluster

import bipenalty as bp

STORE = Path("out") / "cluster_sweep.zarr"
T_END = 0.18  # s
AXES = {"ps": np.logspace(-1, 5, 13), "s2": [0.25, 0.5, 1.0, 1.5, 1.75, 2.0]}  # the last is out of its bounds


class Computed(logging.Handler):
    """Counts the tasks that were computed, from the package's log."""

    count = 0

    def emit(self, record: logging.LogRecord) -> None:
        """One line a task."""
        self.count += "computed" in record.getMessage()


def collision() -> bp.Scene:
    """A soft cylinder comes up at 2 m/s and 45 degrees to a stiff one."""
    disc = bp.mesh.disc(radius=1.0, segments=40)
    top = bp.Body("top", disc.moved(0, 2), bp.LinearElastic(young=1000, poisson=0.2, density=0.1))
    bottom = bp.Body("bottom", disc, bp.LinearElastic(young=100, poisson=0.2, density=0.1), velocity=(2**0.5, 2**0.5))
    return bp.Scene([top, bottom], contacts=[bp.Contact("top", "bottom", passes=2)])


def study(client: Client, tasks: Computed) -> tuple[xr.Dataset, int]:
    """The grid, and how many tasks this call had to compute."""
    before = tasks.count
    data = bp.grid(collision(), T_END, AXES, executor=client.get_executor(), store=STORE, chunk=6)
    return data, tasks.count - before


def check(data: xr.Dataset) -> None:
    """What the study says, as numbers."""
    assert data.outcome.size == 78
    assert int(data.attrs["interrupted"]) == 0
    assert (data.outcome.sel(s2=2.0) == "refused").all(), "s^2 = 2 is where the critical rule ends"
    ran = data.sel(s2=slice(0, 1.75))
    assert ran.finished.all(), f"failed: {ran.reason.values[~ran.finished.values]}"
    assert float(ran.energy_made.max()) < 0.01
    stiff = ran.impulse.sel(ps=slice(10, None))
    assert float(stiff.max() / stiff.min()) < 1.02, "the impulse is not that of the collision alone"


def main() -> None:
    """Compute what is missing, check, and see that nothing is left to do."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scheduler", help="address of dask's scheduler; two processes of this machine if left out")
    address = parser.parse_args().scheduler
    logger, tasks = logging.getLogger("bipenalty.sweeps"), Computed()
    logger.setLevel(logging.INFO)
    logger.addHandler(tasks)
    cluster = address or LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with Client(cluster) as client:
        data, computed = study(client, tasks)
        if data.attrs["interrupted"]:
            raise SystemExit(f"interrupted: {STORE} goes on from here")
        check(data)
        again, more = study(client, tasks)
        xr.testing.assert_equal(data, again)
        assert more == 0, f"{more} tasks were computed twice"
    if not address:
        cluster.close()
    print(f"{data.outcome.size} runs, {computed} tasks computed now, {data.attrs['memory'] / 1e6:.1f} MB expected")
    depth = data.max_penetration.max("s2")
    for ps in (0.1, 1.0, 10.0, 100.0):
        print(f"p_s = {ps:<6g} penetration at most {1e3 * float(depth.sel(ps=ps)):.3f} mm")


if __name__ == "__main__":
    main()
