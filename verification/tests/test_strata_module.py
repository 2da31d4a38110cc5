"""The module `strata` that people install: a run from any folder, the fields at a time beside those that h5py reads, and what it says of what it
cannot read."""

import importlib.util
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest

from verification.harness.paths import EXPERIMENTS, ROOT
from verification.strata import LoadError, Run, load
from verification.tests.cases import completed, strata, summary_of

QUASISTATIC = ("numerics.cell_m=2", "fracture.increment_m=2", "numerics.mechanics=quasistatic", "stop.tip_y_m=20")


@pytest.fixture(scope="module")
def soft() -> Run:
    """A short run with a fracture, its flow and a soft interface."""
    return completed(EXPERIMENTS / "exp1_single_interface.toml", "soft", QUASISTATIC)


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
    scene = '[domain]\nwidth_m=4\nheight_m=4\n[rock.a]\nyoungs_modulus_Pa=1e10\n[strata]\nlayers=[{rock="a"}]\n[numerics]\nmechanics="quasistatic"\ncell_m=1\n[stop]\ntime_s=0\n'
    (tmp_path / "block.toml").write_text(scene, encoding="utf-8")
    done = strata(tmp_path, "run", "block.toml", "--out", "X", "--quiet")
    assert done.returncode == 0, done.stderr
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
