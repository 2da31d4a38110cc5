"""What a run of any kind leaves for others to open: every data set says its unit and what it is, the .xdmf names what there is, and ParaView reads the
same numbers from it."""

import importlib.util
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.harness.paths import ANALYTIC, EXPERIMENTS, ROOT
from verification.strata import items_below
from verification.tests.cases import completed, run_in

COARSE = ("numerics.cell_m=2", "fracture.increment_m=2", "stop.tip_y_m=20")
STATIC = (*COARSE, "numerics.mechanics=quasistatic")
BLOCK = """
domain = {width_m = 4, height_m = 4}
rock.a.youngs_modulus_Pa = 1e10
strata.layers = [{rock = "a"}]
numerics = {mechanics = "quasistatic", cell_m = 1}
stop.time_s = 0
"""
KINDS = {
    "inertia": (EXPERIMENTS / "exp1_single_interface.toml", "weak", (*COARSE, "stop.time_s=1.2")),
    "inertia, points in place": (EXPERIMENTS / "exp4_soft_between.toml", "friction", (*COARSE, "stop.time_s=0.6", "numerics.kinematics=total")),
    "paper": (EXPERIMENTS / "exp1_single_interface.toml", "soft", STATIC),
    "uniform": (EXPERIMENTS / "exp1_single_interface.toml", "friction", (*STATIC, "fluid.law=uniform")),
    "two interfaces": (EXPERIMENTS / "exp3_two_interfaces.toml", "weak_soft", STATIC),
    "interface beside": (EXPERIMENTS / "exp5_parallel_interface.toml", "soft", STATIC),
    "reynolds": (EXPERIMENTS / "exp1_single_interface.toml", "reynolds_weak", STATIC),
    "leakoff": (ANALYTIC / "kgd_leakoff.toml", "", ("stop.time_s=5",)),
}
UNITS = {"1", "Pa", "m", "s", "m^2", "m/s", "N/m", "J/m", "Pa m^0.5", "deg"}
# What a name's end says of the unit.
ENDS = {"_Pa": "Pa", "_m": "m", "_s": "s", "_m2": "m^2", "_m_s": "m/s", "_N_m": "N/m", "_J": "J/m", "_sqrt_m": "Pa m^0.5", "_deg": "deg"}


def unit_of(name: str) -> str:
    """The unit that a name ends in, by the longest end; 1 where it ends in none."""
    return next((ENDS[end] for end in sorted(ENDS, key=len, reverse=True) if name.endswith(end)), "1")


@pytest.fixture(scope="module", params=[*KINDS, "block"])
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of each kind."""
    if request.param == "block":
        place = tmp_path_factory.mktemp("block")
        assert run_in(place, BLOCK).returncode == 0
        return place / "X"
    return completed(*KINDS[request.param]).folder


def test_every_data_set_has_its_unit_and_says_what_it_is(folder: Path) -> None:
    """The unit is that in the name; what a thing is, is said in more than its name."""
    with h5py.File(folder / "result.h5") as store:
        sets = {path: item for path, item in items_below(store) if isinstance(item, h5py.Dataset)}
        assert len(sets) > 40 and {path.split("/")[0] for path in sets} >= {"times", "history", "particles"}
        for path, item in sets.items():
            name = path.split("/")[-1]
            assert item.attrs["unit"] in UNITS and item.attrs["unit"] == ("s" if name == "times" else unit_of(name)), path
            words = str(item.attrs["description"])
            assert len(words) >= 4 and words != name, path


def test_the_xdmf_names_every_field_as_it_is_stored(folder: Path) -> None:
    """Path, shape, type of each DataItem; each grid has its points' places; all fields but the places' components are there; times are the outputs'."""
    domain = ElementTree.parse(folder / "result.xdmf").getroot().find("Domain/Grid")
    assert domain is not None
    with h5py.File(folder / "result.h5") as store:
        assert [float(step.find("Time").get("Value")) for step in domain] == store["times"][()].tolist()
        named = set()
        for grid in domain.iterfind("Grid/Grid"):
            shapes = []
            for item in grid.iterfind(".//DataItem"):
                file, path = item.text.split(":")
                stored = store[path]
                assert file == "result.h5" and item.get("Format") == "HDF"
                assert [int(n) for n in item.get("Dimensions").split()] == list(stored.shape), path
                assert (item.get("NumberType"), int(item.get("Precision"))) == ({"f": "Float", "i": "Int"}[stored.dtype.kind], stored.dtype.itemsize), path
                named.add(path)
                shapes.append(stored.shape[0])
            assert len(set(shapes)) == 1, "points of one grid"
            topology, geometry = grid.find("Topology"), grid.find("Geometry")
            assert store[topology.find("DataItem").text.split(":")[1]][()].tolist() == list(range(shapes[0]))
            assert int(topology.get("NumberOfElements")) * int(topology.get("NodesPerElement")) == shapes[0]
            assert geometry.get("GeometryType") == "XYZ" and geometry.find("DataItem").text.endswith("/paraview/position_m")
        fields = {f"/{path}" for path, item in items_below(store) if isinstance(item, h5py.Dataset) and path.split("/")[0] not in ("times", "history")}
        assert {path for path in fields - named} == {path for path in fields if path.endswith(("/x_m", "/y_m"))} and named <= fields


def test_vectors_are_their_components(folder: Path) -> None:
    """Nothing is stored twice: they are read through what they are made of."""
    with h5py.File(folder / "result.h5") as store:
        for path, item in items_below(store):
            if path.endswith("/paraview"):
                for name, components in {"position_m": "xy", "displacement_m": ("u_x", "u_y"), "velocity_m_s": ("v_x", "v_y")}.items():
                    if name in item:
                        unit = name[name.index("_m"):]
                        parts = [item.parent[component + unit][()] for component in components]
                        assert item[name].is_virtual and np.array_equal(item[name][()], np.stack([*parts, 0 * parts[0]], axis=-1))


READ = """
import sys
import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

reader, xdmf, out, *wanted = sys.argv[1:]
source = getattr(simple, reader)(**{"FileNames" if reader == "XDMFReader" else "FileName": [xdmf]})
source.UpdatePipelineInformation()
found = {"times": numpy.atleast_1d(source.TimestepValues)}

def leaves(block):
    if block is None:
        return
    if block.IsA("vtkMultiBlockDataSet") or block.IsA("vtkMultiPieceDataSet"):
        count = block.GetNumberOfBlocks() if block.IsA("vtkMultiBlockDataSet") else block.GetNumberOfPieces()
        for k in range(count):
            yield from leaves(block.GetBlock(k) if block.IsA("vtkMultiBlockDataSet") else block.GetPiece(k))
    else:
        yield block

for k in wanted:
    source.UpdatePipeline(found["times"][int(k)])
    for number, block in enumerate(leaves(servermanager.Fetch(source))):
        data, at = block.GetPointData(), f"{k}/{number}/"
        found[at + "position_m"] = vtk_to_numpy(block.GetPoints().GetData()).copy()  # the block goes
        found[at + "cells"] = numpy.array([[block.GetCell(c).GetPointId(j) for j in range(block.GetCell(c).GetNumberOfPoints())] for c in range(min(3, block.GetNumberOfCells()))])
        for a in range(data.GetNumberOfArrays()):
            found[at + data.GetArrayName(a)] = vtk_to_numpy(data.GetArray(a)).copy()
numpy.savez(out, **found)
"""


@pytest.mark.skipif(importlib.util.find_spec("paraview") is None, reason="ParaView is not installed (ci/setup --paraview)")
@pytest.mark.parametrize("reader", ["XDMFReader", "Xdmf3ReaderS", "Xdmf3ReaderT"])
@pytest.mark.parametrize("kind", ["inertia", "paper"])
def test_each_of_paraviews_readers_finds_the_same_numbers(tmp_path: Path, kind: str, reader: str) -> None:
    """All fields of particles, fracture and interface at the first, a middle and the last output time."""
    run = completed(*KINDS[kind])
    wanted = (0, len(run.times_s) // 2, len(run.times_s) - 1)
    (tmp_path / "read.py").write_text(READ, encoding="utf-8")
    command = [sys.executable, "read.py", reader, str(run.folder / "result.xdmf"), "found.npz", *map(str, wanted)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    found = np.load(tmp_path / "found.npz")
    assert found["times"].tolist() == run.times_s.tolist()
    compared = 0
    with h5py.File(run.folder / "result.h5") as store:
        for k in wanted:
            for number, group in enumerate((f"particles/{k:05d}", f"fracture/{k:05d}", f"interfaces/{k:05d}/0")):
                cells = found[f"{k}/{number}/cells"]
                n = len(store[group]["x_m"])
                assert cells.tolist() == ([[0], [1], [2]] if number == 0 else [list(range(n))]), "points, or one line through all"
                for path, item in items_below(store[group]):
                    name = path.split("/")[-1]
                    if isinstance(item, h5py.Dataset) and name not in ("x_m", "y_m", "order"):
                        assert np.array_equal(found[f"{k}/{number}/{name}"], item[()]), (group, name)
                        compared += 1
    assert compared == 3 * (13 + 6 + 7)


@pytest.mark.skipif(importlib.util.find_spec("paraview") is None or not Path("/usr/bin/Xvfb").exists(), reason="no ParaView or Xvfb (ci/setup --paraview)")
def test_paraview_draws_a_run(tmp_path: Path) -> None:
    """A picture of many colours; an unknown field is named with those that there are."""
    from PIL import Image  # comes with matplotlib

    run = completed(*KINDS["paper"])
    command = [str(ROOT / "ci/paraview"), str(run.folder), "--out", str(tmp_path / "run.png")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and f"t = {run.times_s[-1]:g} s" in done.stdout, done.stderr
    with Image.open(tmp_path / "run.png") as picture:
        assert picture.size == (1200, 900) and len(picture.convert("RGB").getcolors(1 << 20)) > 200
    done = subprocess.run([*command, "--field", "nothing"], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "no field nothing; there are displacement_m" in done.stderr


def test_paraview_says_what_is_not_there(tmp_path: Path) -> None:
    """No such folder, and a run that has not ended."""
    for folder, why in ((tmp_path / "none", "no such folder"), (tmp_path, "the run has not ended")):
        done = subprocess.run([str(ROOT / "ci/paraview"), str(folder)], capture_output=True, text=True, check=False)
        assert done.returncode == 1 and why in done.stderr
