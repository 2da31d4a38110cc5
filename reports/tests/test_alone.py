"""Pages made alone by their scripts: what is said, and the exit status where there is nothing to make them of."""
from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from reports.alone import Alone, make

REPORTS = Path(__file__).resolve().parents[1]
PAGES = [("make_stability.py", "--records", "stability.html"), ("make_precision.py", "--precision", "precision.html")]


def made(script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """A script's run."""
    return subprocess.run([str(REPORTS / script), *arguments], capture_output=True, text=True, timeout=300, check=False)


@pytest.mark.parametrize(("script", "option", "name"), PAGES)
def test_without_data_the_reason_is_told(tmp_path: Path, script: str, option: str, name: str) -> None:
    """An empty folder of data: status 1, how to fill it on stderr, no page."""
    done = made(script, option, str(tmp_path), "--out", str(tmp_path / "out"))
    assert done.returncode == 1 and done.stdout == ""
    assert "ci/" in done.stderr
    assert not (tmp_path / "out" / name).exists()


@dataclass
class Told:
    """What writing a made-up page tells."""

    lack: str = ""
    defect: str = ""


def test_the_page_is_written_where_it_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 0, the page's path and its words; a defect is shown whole, with status 1."""

    def write(out: Path, data: Path) -> Told:
        """The folder of data says what is wrong."""
        (out / "page.html").write_text(str(data))
        return Told("no page", "a defect of five lines") if data.name == "torn" else Told()

    page = Alone("A page.", "--from", tmp_path / "kept", write, "page.html", lambda made: f"{made.lack}seven words")
    assert make(page, ["--out", str(tmp_path)]) == 0
    assert (tmp_path / "page.html").read_text() == str(tmp_path / "kept")
    assert capsys.readouterr().out == f"{tmp_path / 'page.html'}: seven words\n"
    assert make(page, ["--out", str(tmp_path), "--from", "torn"]) == 1
    assert capsys.readouterr() == ("", "a defect of five lines\n")
