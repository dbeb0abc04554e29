"""Files: netCDF there and back, and what ParaView finds."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import meshio
import numpy as np
import pytest
import xarray as xr

import bipenalty as bp
from bipenalty.errors import InputError


@pytest.fixture
def run() -> xr.Dataset:
    """A run dataset made by hand: a triangle and a quad that move apart, seen three times."""
    points = np.array([[0, 0], [1, 0], [0, 1], [2, 0], [3, 0], [3, 1], [2, 1]], dtype=float)
    times = np.array([0.0, 0.1, 0.25])
    velocity = np.zeros((3, 7, 2))
    velocity[:, 3:] = [3.0, 4.0]
    m, s = {"units": "m"}, {"units": "s"}
    return xr.Dataset(
        {
            "penetration": ("time", np.array([0.0, 1e-3]), m),
            "points": (("node", "axis"), points, m),
            "triangles": (("triangle", "corner3"), np.array([[0, 1, 2]])),
            "quads": (("quad", "corner4"), np.array([[3, 4, 5, 6]])),
            "body_of_node": ("node", np.array([0, 0, 0, 1, 1, 1, 1])),
            "displacement": (("snapshot_time", "node", "axis"), velocity * times[:, None, None], m),
            "velocity": (("snapshot_time", "node", "axis"), velocity, {"units": "m/s"}),
        },
        coords={"snapshot_time": ("snapshot_time", times, s), "axis": ["x", "y"], "body": ["top", "bottom"]},
        attrs={
            "method": "bipenalty",
            "dt": np.float64(1e-4),
            "steps": 2500,
            "failed": False,
            "finished": np.True_,
            "D": None,
            "reason": "",
        },
    )


def test_netcdf_there_and_back(run: xr.Dataset, tmp_path: Path) -> None:
    run["failed"] = ("run", np.array([True, False]))
    run["penetration"].attrs["positive"] = True
    before = run.copy(deep=True)
    path = bp.io.write_netcdf(run, tmp_path / "new" / "run.nc")
    assert path == tmp_path / "new" / "run.nc"
    xr.testing.assert_identical(run, before)  # writing changes nothing
    back = bp.io.read_netcdf(path)
    xr.testing.assert_equal(back, run)
    assert back.attrs == {**run.attrs, "dt": 1e-4, "finished": True}
    assert back.attrs["failed"] is False
    assert back.attrs["D"] is None
    assert back["velocity"].attrs["units"] == "m/s"
    assert back["penetration"].attrs == {"units": "m", "positive": True}
    assert back["failed"].dtype == bool
    assert back["snapshot_time"].attrs["units"] == "s"
    assert back["snapshot_time"].dtype == np.float64  # a number of seconds, not a date or a duration


def test_netcdf_replaces_the_file_it_came_from(run: xr.Dataset, tmp_path: Path) -> None:
    path = bp.io.write_netcdf(run, tmp_path / "run.nc")
    again = bp.io.read_netcdf(path)
    again.attrs["steps"] = 1
    bp.io.write_netcdf(again, path)
    assert bp.io.read_netcdf(path).attrs["steps"] == 1
    with xr.open_dataset(path) as lazy:  # not yet read: its file stays open while it is replaced
        bp.io.write_netcdf(lazy, path)
    xr.testing.assert_equal(bp.io.read_netcdf(path), again)


def test_netcdf_that_fails_leaves_the_old_file(run: xr.Dataset, tmp_path: Path) -> None:
    path = bp.io.write_netcdf(run, tmp_path / "run.nc")
    with pytest.raises(TypeError):
        bp.io.write_netcdf(run.assign_attrs(bad=object()), path)
    assert bp.io.read_netcdf(path).attrs["steps"] == 2500
    assert [file.name for file in tmp_path.iterdir()] == ["run.nc"]


def test_netcdf_bad_path(run: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'netCDF file ".*none.nc": does not exist; the current folder is'):
        bp.io.read_netcdf(tmp_path / "none.nc")
    with pytest.raises(InputError, match="is a folder; give the name of a file"):
        bp.io.write_netcdf(run, tmp_path)


def test_paraview(run: xr.Dataset, tmp_path: Path) -> None:
    pvd = bp.io.write_paraview(run, tmp_path / "a & b", name="hit & run")
    assert pvd == tmp_path / "a & b" / "hit & run.pvd"
    entries = ElementTree.parse(pvd).getroot().findall("Collection/DataSet")
    assert [float(entry.attrib["timestep"]) for entry in entries] == [0.0, 0.1, 0.25]
    last = meshio.read(pvd.parent / entries[-1].attrib["file"])
    np.testing.assert_allclose(last.points[:, :2], run["points"] + run["displacement"][-1])
    np.testing.assert_array_equal(last.points[:, 2], 0)
    np.testing.assert_allclose(last.point_data["displacement"][4], [0.75, 1.0, 0.0])
    np.testing.assert_allclose(last.point_data["velocity"][:, :2], run["velocity"][-1])
    np.testing.assert_allclose(last.point_data["speed"], [0, 0, 0, 5, 5, 5, 5])
    assert last.point_data["body"].tolist() == [0, 0, 0, 1, 1, 1, 1]
    assert last.cells_dict["triangle"].tolist() == [[0, 1, 2]]
    assert last.cells_dict["quad"].tolist() == [[3, 4, 5, 6]]
    assert [values.tolist() for values in last.cell_data["body"]] == [[0], [1]]


def test_paraview_one_kind_of_cell(run: xr.Dataset, tmp_path: Path) -> None:
    quads_only = run.isel(triangle=slice(0), snapshot_time=slice(1))
    pvd = bp.io.write_paraview(quads_only, tmp_path)
    assert [block.type for block in meshio.read(pvd.with_name("run_0000.vtu")).cells] == ["quad"]


def test_a_real_run(tmp_path: Path) -> None:
    """Through `Result`: what comes back is what was there, and the last file holds the last snapshot."""
    block = bp.mesh.rectangle(1.0, 1.0, 2, 2)
    steel = bp.LinearElastic(young=900.0, poisson=0.3, density=1.0)
    upper = bp.Body("upper", bp.mesh.disc(segments=16, centre=(0.5, 2.001)), steel, velocity=(0.0, -1.0))
    scene = bp.Scene([bp.Body("lower", block, steel), upper], contacts=[bp.Contact("lower", "upper")])
    result = bp.Model(scene, bp.Bipenalty(ps=1.0, rule="published")).run(0.05, snapshots=[0.0, 0.02, 0.05])
    back = bp.io.read_netcdf(result.to_netcdf(tmp_path / "run.nc"))
    xr.testing.assert_identical(back, result.dataset)
    folder = result.to_paraview(tmp_path).parent
    last = meshio.read(folder / "run_0002.vtu")
    assert [(block.type, len(block.data)) for block in last.cells] == [("quad", 4 + 32)]
    assert last.point_data["body"].tolist() == [0] * 9 + [1] * 41
    moved = last.points[:, :2] - result.dataset["points"].values
    np.testing.assert_allclose(moved, result.dataset["displacement"][-1], atol=1e-15)
    assert moved[9:, 1].mean() < -0.04


def test_paraview_bad_input(run: xr.Dataset, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"has no velocity; give it one run made with run\(t_end, snapshots="):
        bp.io.write_paraview(run.drop_vars("velocity"), tmp_path)
    with pytest.raises(InputError, match="has 0 snapshots; give it one run"):
        bp.io.write_paraview(run.isel(snapshot_time=slice(0)), tmp_path)
    with pytest.raises(InputError, match="name = 'a/b', must be a plain file name"):
        bp.io.write_paraview(run, tmp_path, name="a/b")
