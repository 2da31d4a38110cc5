"""What README files name is there, and the version is the same wherever it stands."""

import re
from pathlib import Path

import pytest

from verification.harness.paths import ROOT

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
