"""What a run of any kind leaves for others to open: every data set says its unit and what it is, the .xdmf names what there is, and ParaView reads the
same numbers from it. The module `strata` that people install: a run from any folder, the fields at a time beside those that h5py reads, and what it says of
what it cannot read."""

import importlib.util
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.harness.paths import ANALYTIC, EXPERIMENTS, ROOT
from verification.strata import LoadError, Run, items_below, load  # noqa: F401
from verification.tests.cases import SCENES, completed, run_in, summary_of

COARSE = ("numerics.cell_m=2", "fracture.increment_m=2", "stop.tip_y_m=20")
STATIC = (*COARSE, "numerics.mechanics=quasistatic")
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
    if request.param == "block":
        place = tmp_path_factory.mktemp("block")
        assert run_in(place, SCENES / "rock_alone.toml").returncode == 0
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


@pytest.fixture(scope="module")
def soft() -> Run:
    """A short run with a fracture, its flow and a soft interface."""
    return completed(*KINDS["paper"])


def test_history_has_units_and_descriptions(soft: Run) -> None:
    """Of every column and every field; K's unit by hand."""
    assert soft.units["inlet_Pa"] == "Pa" and soft.units["K_I_Pa_sqrt_m"] == "Pa m^0.5" and soft.units["fracture/opening_m"] == "m"
    assert soft.history.keys() <= soft.units.keys() and soft.units.keys() == soft.descriptions.keys()
    assert soft.tips == soft.summary.tips and soft.events[0].kind == "start" and len(soft.suspect) == len(summary_of(soft.folder)["suspect"])


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0])
def test_the_state_at_a_time_is_that_of_the_nearest_output(soft: Run, share: float) -> None:
    """A time a third of the way to the next output gives the earlier one, two thirds the later."""
    times = soft.times_s
    k = int(share * (len(times) - 1))
    after = min(k + 1, len(times) - 1)
    for part, expected in ((1 / 3, k), (2 / 3, after)):
        state = soft.at(time_s=times[k] + part * (times[after] - times[k]))
        assert state.time_s == times[expected]
        with h5py.File(soft.folder / "result.h5") as store:
            rock, faces, bedding = (store[f"{kind}/{expected:05d}"] for kind in ("particles", "fracture", "interfaces"))
            for name, components in (("position_m", ("x_m", "y_m")), ("displacement_m", ("u_x_m", "u_y_m")), ("stress_Pa", ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa"))):
                assert state.particles[name].shape == (soft.summary.particles, len(components))
                for c, component in enumerate(components):
                    assert np.array_equal(state.particles[name][:, c], rock[component][()])
            assert np.array_equal(state.fracture["position_m"][:, 1], faces["y_m"][()])
            for name in ("opening_m", "pressure_Pa"):
                assert np.array_equal(state.fracture[name], faces[name][()])
            assert np.array_equal(state.interfaces[0]["slip_m"], bedding["0/slip_m"][()])
    assert np.ptp(soft.at(times[-1]).fracture["opening_m"]) > 1e-4, "fields of nothing are equal, too"


@pytest.mark.parametrize("outside", [-0.01, 1.01])
def test_a_time_outside_the_run_is_refused(soft: Run, outside: float) -> None:
    with pytest.raises(LoadError, match=r"outside the run: output times are 0 to \d"):
        soft.at(time_s=outside * float(soft.times_s[-1]))


def test_no_folder_no_run_and_no_end_are_told_apart(tmp_path: Path, soft: Run) -> None:
    with pytest.raises(LoadError, match="nowhere: no such folder"):
        load(tmp_path / "nowhere")
    with pytest.raises(LoadError, match="holds no run: there is no scene.toml"):
        load(tmp_path)
    for name in ("scene.toml", "history.csv"):
        (tmp_path / name).write_bytes((soft.folder / name).read_bytes())
    with pytest.raises(LoadError, match="has not ended.*strata resume"):
        load(str(tmp_path))


def test_what_another_version_did_not_write_is_named_with_the_version(tmp_path: Path, soft: Run) -> None:
    for name in ("scene.toml", "history.csv", "summary.json", "result.h5"):
        (tmp_path / name).write_bytes((soft.folder / name).read_bytes())
    with h5py.File(tmp_path / "result.h5", "a") as store:
        del store["particles/00000"]
    with pytest.raises(LoadError, match=rf"result.h5: .*00000.*strata {soft.summary.version} wrote it"):
        load(tmp_path).at(0.0)


def test_a_scene_without_fracture_has_particles_alone(tmp_path: Path) -> None:
    assert run_in(tmp_path, SCENES / "rock_alone.toml").returncode == 0
    state = load(tmp_path / "X").at(0.0)
    assert len(state.particles["rock"]) == 64 and state.fracture == {} and state.interfaces == {}


USE = "import strata, sys; run = strata.load(sys.argv[1]); print(strata.__file__, len(run.history['inlet_Pa']), run.at(run.summary.time_s).time_s)"


def used(folder: Path, run: Run, path: Path) -> list[str]:
    """What a process started in a folder prints of a run, with the module on this path alone."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | {"PYTHONPATH": str(path)}
    done = subprocess.run([sys.executable, "-s", "-c", USE, str(run.folder)], cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_the_checkout_is_used_from_any_folder(tmp_path: Path, soft: Run) -> None:
    where, rows, time_s = used(tmp_path, soft, ROOT / "verification")
    assert where == str(ROOT / "verification/strata/__init__.py")
    assert int(rows) == len(soft.history["inlet_Pa"]) and float(time_s) == soft.times_s[-1]


def test_the_wheel_holds_the_module_and_lists_all_that_it_holds(tmp_path: Path, soft: Run) -> None:
    spec = importlib.util.spec_from_file_location("wheel_of_strata", ROOT / "ci/wheel_of_strata.py")
    assert spec is not None and spec.loader is not None
    backend = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(backend)
    name = backend.build_wheel(str(tmp_path))
    assert name == f"strata-{soft.summary.version}-py3-none-any.whl"
    with zipfile.ZipFile(tmp_path / name) as wheel:
        listed = [line.split(",")[0] for line in wheel.read(f"strata-{soft.summary.version}.dist-info/RECORD").decode().splitlines()]
        assert sorted(listed) == sorted(wheel.namelist())
    assert used(tmp_path, soft, tmp_path / name)[0].startswith(str(tmp_path / name))


@pytest.mark.skipif(importlib.util.find_spec("pip") is None, reason="pip is not installed (python3-pip)")
def test_pip_installs_it_from_the_checkout_without_network_and_leaves_nothing_there(tmp_path: Path, soft: Run) -> None:
    def seen() -> set[str]:
        return {item.name for folder in (ROOT, ROOT / "ci", ROOT / "verification") for item in folder.iterdir() if item.name != "__pycache__"}

    before = seen()
    pip = [sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--target", str(tmp_path / "site"), str(ROOT)]
    done = subprocess.run(pip, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert seen() == before
    assert used(tmp_path, soft, tmp_path / "site")[0] == str(tmp_path / "site/strata/__init__.py")
