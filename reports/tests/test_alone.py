"""Pages made alone by their scripts: what is said, and the exit status where there is nothing to make them of."""
from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from reports.figures import write_alone
from reports.shown import Shown

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


def test_the_page_is_written_where_it_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 0, the page's path and its words; a defect is shown whole, with status 1."""

    def write(out: Path, data: Path) -> Shown:
        """The folder of data says what is wrong."""
        (out / "page.html").write_text(str(data))
        if data.name == "torn":
            return Shown(lack="no page", defect="a defect of five lines")
        return Shown(words="seven words", link="page.html", lack="", defect="")

    def make(*arguments: str) -> int:
        """The page from a folder of data that is kept by default."""
        return write_alone("A page.", "--from", tmp_path / "kept", write, ["--out", str(tmp_path), *arguments])

    assert make() == 0
    assert (tmp_path / "page.html").read_text() == str(tmp_path / "kept")
    assert capsys.readouterr().out == f"{tmp_path / 'page.html'}: seven words\n"
    assert make("--from", "torn") == 1
    assert capsys.readouterr() == ("", "a defect of five lines\n")
