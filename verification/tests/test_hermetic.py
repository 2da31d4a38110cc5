"""Tests keep to themselves: what the user has in the checkout and in the environment decides on none of them."""

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from verification.harness import paths
from verification.harness.hermetic import FORBIDDEN, KEPT, ROOT, NotHermetic
from verification.tests import cases

# A user's account as it may be: narrow terminal, threads bound, other modules, other runs.
DIRTY = {
    "COLUMNS": "20", "TERM": "dumb", "LANG": "de_DE.UTF-8", "LC_ALL": "de_DE.UTF-8", "OMP_NUM_THREADS": "7", "OMP_PROC_BIND": "true", "OPENBLAS_NUM_THREADS": "9",
    "MPLBACKEND": "TkAgg", "MATPLOTLIBRC": "/nowhere", "PYTHONPATH": "/nowhere", "PYTHONWARNINGS": "error", "HOME": "/nowhere", "STRATA_RUNS": FORBIDDEN[0],
}  # fmt: skip


@pytest.mark.parametrize("place", FORBIDDEN)
def test_nothing_of_the_checkout_is_touched(place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Read, listed, made or handed to a process, by its whole path or from the project's root."""
    monkeypatch.chdir(ROOT)
    for path in (Path(place) / "x", Path(place, "x").relative_to(ROOT)):
        for touch in (path.read_text, path.mkdir, path.unlink, lambda: path.write_text(""), lambda: list(path.iterdir()), lambda: os.rename("nothing", path)):
            with pytest.raises(NotHermetic):
                touch()
        with pytest.raises(NotHermetic):
            subprocess.run(["true", "--out", str(path)], check=True)


def test_all_runs_go_below_one_folder_of_the_tests() -> None:
    """Every default of the harness, and no other place in the sources says where runs are."""
    assert not paths.RUNS.is_relative_to(ROOT) and paths.RUNS.is_dir() and cases.RUNS.is_relative_to(paths.RUNS)
    modules = [("harness.refine", "REFINE_RUNS"), ("harness.smoke", "SMOKE_RUNS"), ("benchmarks.__main__", "LAST"),
               ("ablation.__main__", "ABLATION_RUNS"), ("ablation.__main__", "BUDGET_RUNS"),
               *((name, "RUNS") for name in ("ladder.measure", "stability.runner", "precision.measure", "measured.__main__"))]  # fmt: skip
    for module, name in modules:
        assert getattr(importlib.import_module(f"verification.{module}"), name).is_relative_to(paths.RUNS), module
    named = []
    for top in ("verification", "reports", "ci"):
        for folder, below, names in os.walk(ROOT / top):
            below[:] = [name for name in below if name not in ("out", "__pycache__")]
            sources = [Path(folder, name) for name in names if Path(name).suffix in ("", ".py")]
            named += [path.name for path in sources if re.search(r"""ROOT / ["']runs["']""", path.read_text(encoding="utf-8", errors="replace"))]
    assert named == ["paths.py"]


def test_the_environment_is_that_of_no_user() -> None:
    """From any environment tests make the same one; their runs never go to those of the user."""
    code = "import os, verification.harness.hermetic; print(*sorted(f'{k}={v}' for k, v in os.environ.items()), sep='\\n')"

    def environment(**more: str) -> dict[str, str]:
        given = {name: os.environ[name] for name in KEPT if name in os.environ} | more
        said = subprocess.run([sys.executable, "-E", "-c", code], env=given, cwd=ROOT, capture_output=True, text=True, check=True).stdout
        return dict(line.partition("=")[::2] for line in said.splitlines())

    clean, dirty = environment(), environment(**DIRTY)
    own = {name for name in dirty if clean[name] != dirty[name]}
    assert clean.keys() == dirty.keys() and own == {"STRATA_RUNS", "HOME", "MPLCONFIGDIR"}, own
    assert not any(Path(dirty[name]).is_relative_to(ROOT) for name in own)
    assert {"COLUMNS", "LC_ALL", "MPLBACKEND"} <= clean.keys() and not any(name.startswith(("OMP_P", "PYTHON", "LANG")) for name in clean)
