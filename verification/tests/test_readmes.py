"""What README files name is there, and the version is the same wherever it stands; the README's table of accuracy says what the ladder's gates allow, and is
made as its module says; the notebook is kept without outputs, and runs from top to bottom: its figures appear, and its K is that of the reference."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from verification.harness.front_table import END, LINES, README, START, Line, measured_row, table, with_table
from verification.harness.paths import EXPERIMENTS, ROOT, reference_program, solver
from verification.ladder import gates
from verification.measured import rubin

ROOMS = ("solver", "reference", "experiments", "verification", "reports", "ci")
READMES = [ROOT / "README.md", *(path for room in ROOMS for path in sorted([*(ROOT / room).glob("README.md"), *(ROOT / room).glob("*/README.md")]))]
NAMED = re.compile(r"`((?:[\w.-]+/)+[\w.-]+\.(?:[ch]pp|py|md|toml|json|csv|svg))`")


@pytest.mark.parametrize("readme", READMES, ids=lambda path: str(path.relative_to(ROOT)))
def test_files_named_are_there(readme: Path) -> None:
    """A file is named from the project's root, from solver/ or from beside the README; runs and pages are made by commands."""
    names = {name for name in NAMED.findall(readme.read_text(encoding="utf-8")) if not name.startswith(("runs/", "reports/out/"))}
    names = {name for name in names if not re.search(r"/[A-Z]+\.(py|json|toml)$", name)}  # FAMILY.json stands for any
    missing = [name for name in sorted(names) if not any((base / name).is_file() for base in (ROOT, ROOT / "solver", readme.parent, readme.parent.parent))]
    assert not missing


def test_names_are_found() -> None:
    """The pattern finds names, and one that is gone is missed."""
    assert NAMED.findall("see `solver/run.cpp` and `a/b.json`, not `K_I/E`") == ["solver/run.cpp", "a/b.json"]
    assert len(READMES) > 5


def test_the_version_is_the_same_everywhere() -> None:
    places = {"CMakeLists.txt": r"project\(strata VERSION (\S+)", "CITATION.cff": r"^version: (\S+)", "CHANGELOG.md": r"^## (\S+)"}
    found = {name: re.search(pattern, (ROOT / name).read_text(), re.MULTILINE) for name, pattern in places.items()}
    assert len({match and match.group(1) for match in found.values()}) == 1, found
    assert None not in found.values()


NOTEBOOK = EXPERIMENTS / "notebook" / "reading_a_run.ipynb"


def test_it_is_kept_without_outputs() -> None:
    cells = [cell for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    assert len(cells) > 4 and all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells)


@pytest.mark.skipif(shutil.which("jupyter-nbconvert") is None, reason="jupyter-nbconvert is not installed (ci/setup --test)")
def test_it_runs(tmp_path: Path) -> None:
    """K at 0.5 m cells is off by 0.045 % on the ladder (README), at most twice that here; the sides close the opening by F = 0.981 to 1 (block_crack)."""
    command = ["jupyter-nbconvert", "--to", "notebook", "--execute", str(NOTEBOOK), "--output-dir", str(tmp_path), "--output", "done.ipynb"]
    places = {"HOME": str(tmp_path), "STRATA": str(solver()), "STRATA_REFERENCE": str(reference_program())}
    environment = {name: value for name, value in os.environ.items() if name != "MPLBACKEND"} | places  # figures into the notebook
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr[-3000:]
    outputs = [item for cell in json.loads((tmp_path / "done.ipynb").read_text())["cells"] for item in cell.get("outputs", ())]
    said = "".join("".join(item.get("text", ())) for item in outputs)
    assert sum("image/png" in item.get("data", ()) for item in outputs) == 3
    assert "completed - tip reached y = 12 m" in said and "suspect: no" in said
    K = re.search(r"K_I ([\d.]+) MPa m\^0.5, reference ([\d.]+): error (\S+) %", said)
    mouth = re.search(r"at the mouth (\S+) % beside an infinite plane", said)
    assert K is not None and mouth is not None
    assert 1.3 < float(K[2]) < 1.45 and abs(float(K[1]) / float(K[2]) - 1.0) < 9e-4 and abs(float(K[3])) < 0.09
    assert -1.9 < float(mouth[1]) < 0.0


# The largest error that passes, by case, quantity and level, of all families; and rows of a ladder with half of it.
ERRORS = {key: gate.error for path in sorted(gates.FOLDER.glob("*.json")) for key, gate in gates.read(path.stem).items()}
ROWS = [{"case": case, "quantity": quantity, "level": level, "error": -0.5 * error, "cost": {"wall_s": 1.0}}
        for (case, quantity, level), error in ERRORS.items()]  # fmt: skip


def errors(text: str, line: Line) -> dict[str, float]:
    """The errors that a table gives in a line, by level."""
    found = next(one for one in text.splitlines() if one.startswith(f"| {line.says} |"))
    return {level: float(number) / 100.0 for number, level in re.findall(r"(?<![-.\d])([\d.]+) % \(([^)]+)\)", found)}


@pytest.mark.parametrize("line", LINES, ids=[line.case for line in LINES])
def test_the_readme_is_within_the_gates(line: Line) -> None:
    """Each error stands there, is one that its gate lets pass and no nothing."""
    told = errors(README.read_text(encoding="utf-8"), line)
    assert list(told) == list(line.levels)
    assert all(0.0 < error <= ERRORS[line.case, line.quantity, level] for level, error in told.items())


def test_a_table_from_the_ladder() -> None:
    """Errors lose their sign and are those of the rows; a row that is missing is an error."""
    made = table(ROWS)
    for line in LINES:
        half = {level: 0.5 * ERRORS[line.case, line.quantity, level] for level in line.levels}
        assert errors(made, line) == pytest.approx(half, rel=0.05)
    with pytest.raises(ValueError, match="no K_I of graded at 1 m"):
        table([row for row in ROWS if row["case"] != "graded"])


def test_the_last_row_is_what_is_kept_beside_the_experiment() -> None:
    """Its errors are the record's of the plain run in 1 mm cells, and of its pressure less the gauges' zero; without a record there is no row."""
    record = rubin.kept()
    assert record is not None
    row = measured_row(record)
    assert row.rpartition("|")[0].rpartition("|")[0] in README.read_text(encoding="utf-8").partition(END)[0]  # but for the seconds
    kept = {(one.name, one.cell_m): one.errors for one in record.results}
    plain = [kept["plain", 0.001][name].late for name in (rubin.LENGTH, rubin.OPENING, rubin.WELL)]
    told = [float(number) / 100.0 for number in re.findall(r"([\d.]+) %", row)]
    assert told == pytest.approx([*plain, kept["gauges_from_zero", 0.001][rubin.WELL].late], rel=0.05)
    with pytest.raises(ValueError, match="no .*rubin.json"):
        measured_row(None)


def test_only_the_table_changes() -> None:
    """What stands around the table stays; without its marks there is nothing to write to."""
    assert with_table(f"a\n{START}old\n{END}\nb\n", "new\n") == f"a\n{START}new\n{END}\nb\n"
    with pytest.raises(ValueError, match="no table"):
        with_table("a\n", "new\n")
