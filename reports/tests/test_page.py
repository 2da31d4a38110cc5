"""The page is made from run folders alone, holds every figure, survives runs that failed or are missing, and is sound in a browser."""

import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from reports.claims import claim_rows, columns_of
from reports.figures import Table
from reports.make_page import main
from reports.page import cell_words, minute
from reports.runs import Run
from reports.tests.browser import Chrome, faults, started
from reports.tests.synthetic import STEMS, Plan, claims, write_all, write_run
from reports.words import Shown
from verification.harness.claims import REPRODUCED
from verification.harness.paths import ROOT
from verification.stability.runner import RECORDS

STUDY_FIGURES = tuple(f"fig{number}" for number in range(1, 9))
KEPT_FIGURES = ("ablation", "crossing_map", "measured")
SCENES = Path(__file__).with_name("scenes")  # one of Experiment 1, and an open point


def text_of(out: Path, name: str = "index.html") -> str:
    """The text of a page."""
    return (out / name).read_text(encoding="utf-8")


def make(runs: Path, out: Path, experiments: Path | None = None) -> int:
    """Make a page of these runs, and of what is kept in atlas/ and kept/ beside them, without the chart of errors against time; its exit status."""
    folders = {"runs": runs, "out": out, "experiments": experiments or runs.parent / "no_scenes", "precision": runs.parent / "no_chart",
               "stability": runs.parent / "atlas", "records": runs.parent / "kept"}
    return main(["--strict", *(word for name, folder in folders.items() for word in (f"--{name}", str(folder)))])


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page of all six experiments, one run of which failed."""
    root = tmp_path_factory.mktemp("page")
    (root / "atlas").mkdir()
    shutil.copy(RECORDS / "flow_explicit.json", root / "atlas")
    for name in ("ladder/gates/heights.json", "ablation/records/exp1_single_interface.soft.json", "measured/records/rubin.json", "crossing_map/records/friction.csv"):
        (root / "kept" / name).parent.mkdir(parents=True)
        shutil.copy(ROOT / "verification" / name, root / "kept" / name)
    assert make(write_all(root), root / "out", SCENES) == 0
    return root / "out"


@pytest.fixture(scope="module")
def page(made: Path) -> str:
    """Its text."""
    return text_of(made)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    """Chromium."""
    with started(tmp_path_factory.mktemp("profile")) as one:
        yield one


@pytest.mark.parametrize("name", ["index", "runs", "stability", "verification"])
def test_a_page_is_sound_in_a_browser(made: Path, browser: Chrome, name: str) -> None:
    """From a file, without a server: nothing on the console, images and links lead somewhere, nothing is wider than windows of 360 to 1400, texts are
    dark or light enough in both schemes, and it prints."""
    assert faults(browser, made / f"{name}.html") == []


SOUND = "<style>html { background: #fff; color: #222 } @media (prefers-color-scheme: dark) { html { background: #222; color: #fff } }</style><p>words"


@pytest.mark.parametrize("planted, words", [
    ("", ""), ('<img src="gone.svg">', "no image: "), ('<script>console.error("broken")</script>', "console: "), ("<script>undefined_name()</script>", "exception: "),
    ('<table style="width:900px"><tr><td>1</table>', "wide in a window of 360"), ('<a href="gone.html">1</a>', "link to nothing"), ('<a href="#gone">1</a>', "link to nothing"),
    ('<a href="https://example.org">1</a>', "link to nothing"), ('<p style="color: #999">pale', "too pale in light: P."), ('<p style="color: #333">dark', "too pale in dark: P."),
    ("<style>html { background: #fff !important }</style>", "the same ground"),
])  # fmt: skip
def test_faults_are_found(tmp_path: Path, browser: Chrome, planted: str, words: str) -> None:
    """Each fault, planted in a page without any, is named."""
    (tmp_path / "one.html").write_text(f'<!DOCTYPE html><link rel="icon" href="data:,"><meta charset="utf-8">{SOUND}{planted}', encoding="utf-8")
    found = faults(browser, tmp_path / "one.html")
    assert any(words in one for one in found) if words else not found, found


def test_every_figure_is_written_and_shown(made: Path, page: str) -> None:
    """Each stands on the page with its data, its command and its PDF; no address on the page leads out of its folder."""
    for name in (*STUDY_FIGURES, *KEPT_FIGURES):
        for ending in (".svg", ".pdf", "_one_column.svg", "_one_column.pdf"):
            assert (made / "figures" / f"{name}{ending}").stat().st_size > 1000 and f'"figures/{name}{ending}"' in page
        assert json.loads((made / "figures" / f"{name}.json").read_text(encoding="utf-8"))["title"]
        assert f'src="figures/{name}.svg"' in page and "Made by <code>ci/" in page[page.index(f'<figure id="{name}"') :].split("</figure>")[0]
    assert not [one for one in re.findall(r'(?:href|src|srcset)="([^"]+)"', page) if re.match(r"(?!data:,)[a-z]+:|/|\.\.", one)]


def test_curves_that_are_alike_are_drawn_once(made: Path) -> None:
    """With all their names; one that differs has a line of its own."""
    labels = [curve["label"] for curve in json.loads((made / "figures" / "fig3.json").read_text(encoding="utf-8"))["curves"]]
    assert labels[0] == "perfect and friction, without inertia" and "weak, without inertia" in labels, "0.03 MPa from those with inertia"


def test_verdicts_come_first_with_their_numbers(page: str) -> None:
    """The table of claims precedes all figures and has what was measured and asked, for each mechanics."""
    assert page.index('id="verdicts"') < page.index("<figure")
    table = page[page.index('class="claims"') : page.index("<figure")]
    for words in ("only under a variant", "not reproduced", "0.64\u00a0MPa", "at least 1.6\u00a0MPa", "J at interface"):
        assert words in table, words
    row = table[table.index('class="id">2c') :]
    assert re.findall(r'class="mark (\w+)"', row)[:2] == ["yes", "partly"], "without and with inertia side by side"


def test_a_minute_s_summary_follows_the_verdicts_and_the_runs() -> None:
    """Of the first column what holds in the study's words and what does not by id; a median and the longest run. No claims, no runs: nothing is said."""
    rows = claim_rows(claims())
    runs = [Run("exp1", "a", Path(), "quasistatic", summary={"wall_s": wall}) for wall in (1.0, 2.0, 9.0)]
    assert minute(runs, rows, columns_of(rows), [Shown(name="accuracy", shown=Table("", [], [["K", "a crack", "2\u00a0% (1 m), 0.1\u00a0% (0.5 m)"]]))]) == [
        ("What holds", "Weak and soft stop the fracture (1b). The start is later (2c)."),
        ("What does not", "5a; only under another reading of what the study leaves open: none."),
        ("How accurate", "Errors in the finest cells tried: K\u00a00.1\u00a0%."),
        ("How fast", "A run of the experiments takes 2\u00a0s without inertia (medians), the longest 9\u00a0s, on one thread.")]
    assert minute([], [], [], []) == []


def test_the_size_of_cells_is_told_beside_verdicts() -> None:
    """Claims on which the mechanics differ in the scenes' cells and agree in half of them are named; none without the finer ones."""
    finer = [replace(one, mechanics=f"{one.mechanics} 0.5 m", verdict=REPRODUCED) for one in claims()]
    words = cell_words(claim_rows([*claims(), *finer]))
    assert "differ on 1 claims (2c)" in words and "the two agree" in words and cell_words(claim_rows(claims())) == ""
    assert [column.words for column in columns_of(claim_rows([*claims(), *finer]))] == [
        f"{cells} cells, {inertia} inertia" for cells in ("0.5 m", "1 m") for inertia in ("without", "with")]


def test_the_two_mechanics_are_compared(page: str) -> None:
    """In how many variants the fracture does the same, and the kinetic energy."""
    assert "does the same with and without inertia" in page and "3.3\u00a0%" in page


def test_claims_stand_against_choices(page: str) -> None:
    """A line a claim and mechanics; a choice that holds only for some of the cases, or is open, says so."""
    table = page[page.index('class="sensitivity"') :].split("</table>")[0]
    assert "conserves volume" in table and "inlet pressure everywhere" not in table, "only choices that claims were evaluated under"
    lines = re.findall(r'class="mark (\w+)', table)
    assert lines == ["yes", "none", "yes", "none", "no", "yes", "yes", "yes", "no", "open", "no", "open"]
    assert "reproduced under every choice and mechanics that was run: 1b" in page.lower()


def test_variants_of_other_choices_are_folded(made: Path) -> None:
    """The study's own variants are open to see, the others behind a line that says how many there are."""
    page = text_of(made, "runs.html")
    part = page[page.index(f'id="{STEMS[1]}"') : page.index(f'id="{STEMS[2]}"')]
    assert "Runs of other choices (3)" in part, "uniform in both, flow missing in quasi-static, which alone can run it"
    assert part.index("<b>weak</b>") < part.index('class="others"') < part.index("<b>uniform</b>")


def test_a_failed_run_is_shown_with_its_reason(made: Path, page: str) -> None:
    """A failed run stands in the list of failures and in the table of runs, and its figure is still drawn."""
    assert "a mechanism: the upper block is free" in page and 'class="failed"' in text_of(made, "runs.html")


def test_findings_are_computed_from_the_runs(tmp_path: Path) -> None:
    """Another arrest gives another title: nothing in it is typed."""
    titles = []
    for restart in (3.0e6, 3.4e6):
        runs = tmp_path / f"runs{restart:.0f}"
        write_run(runs, 1, Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=restart))
        make(runs, tmp_path / "out")
        titles += re.findall(r"Figure 3. ([^<]+)</b>", text_of(tmp_path / "out"))
    pressures = [float(re.search(r"to ([\d.]+)\sMPa", title).group(1)) for title in titles]
    assert pressures[0] == pytest.approx(3.0, abs=0.1) and pressures[1] == pytest.approx(3.4, abs=0.1)


def test_no_runs_at_all_still_gives_a_page(tmp_path: Path) -> None:
    """An empty folder of runs is told, not crashed on."""
    (tmp_path / "runs").mkdir()
    assert make(tmp_path / "runs", tmp_path / "out") == 0
    page = text_of(tmp_path / "out")
    assert "No verdict on any claim" in page and "Figure 3 is not there" in page


def test_one_mechanics_alone_with_a_variant_that_was_not_run(tmp_path: Path) -> None:
    """With explicit runs only nothing speaks of the other mechanics; a variant of a scene that was not run is listed as missing."""
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    (scenes / f"{STEMS[1]}.toml").write_text("[variants.perfect]\n[variants.undamped]\n", encoding="utf-8")
    write_run(tmp_path / "runs", 1, Plan("perfect"))
    assert make(tmp_path / "runs", tmp_path / "out", scenes) == 0
    page = text_of(tmp_path / "out")
    assert "undamped, with inertia missing: not run" in page and 'class="missing"' in text_of(tmp_path / "out", "runs.html")
    assert "without inertia" not in page


@pytest.mark.parametrize("name", ["scene.toml", "summary.json", "history.csv", "result.h5"])
@pytest.mark.parametrize("how", ["absent", "torn"])
def test_a_damaged_folder_is_not_fatal(tmp_path: Path, name: str, how: str) -> None:
    """Any one file absent or torn costs at most the figures that need it, without a defect."""
    runs = tmp_path / "runs"
    write_run(runs, 1, Plan("friction", ("friction",)))
    victim = write_run(runs, 1, Plan("perfect")) / name
    if how == "absent":
        victim.unlink()
    else:
        victim.write_bytes(victim.read_bytes()[: victim.stat().st_size // 3])
    assert make(runs, tmp_path / "out") == 0
    page = text_of(tmp_path / "out")
    assert 'src="figures/fig3.svg"' in page


def test_a_run_that_never_started_is_told_from_its_outcome(tmp_path: Path) -> None:
    """A folder with only the process's outcome is a failure with that reason."""
    folder = tmp_path / "runs" / "explicit" / STEMS[2] / "weak"
    folder.mkdir(parents=True)
    (folder / "outcome.json").write_text('{"status": "failed", "reason": "bad input: no rock"}', encoding="utf-8")
    assert make(tmp_path / "runs", tmp_path / "out") == 0
    assert "bad input: no rock" in text_of(tmp_path / "out")
