"""The page is made from run folders alone, holds every figure, and survives runs that failed or are missing."""

import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest

from reports.make_page import main
from reports.tests.synthetic import STEMS, Plan, write_all, write_run
from verification.stability.store import RECORDS

STUDY_FIGURES = tuple(f"fig{number}" for number in range(1, 9))
MECHANICS = ("explicit", "quasistatic")
FIGURES = (
    *STUDY_FIGURES, "choice_flow", *(f"variants_{name}" for name in MECHANICS),
    *(f"energy{number}_{name}" for number in range(1, 7) for name in MECHANICS),
)
SCENE = "[variants.perfect]\n[variants.weak]\n[variants.uniform]\nfluid.law = 'uniform'\n[variants.flow]\nfluid.law = 'reynolds'\n"
POINTS = """
[[point]]
id = "flow"
open = "flow law"
default = "the study's"
[[point.choice]]
id = "uniform"
name = "inlet pressure everywhere"
runs.exp1_single_interface = {perfect = "uniform"}
[[point.choice]]
id = "loaded"
name = "conserves volume"
runs.exp1_single_interface = {perfect = "flow"}
"""


def write_scenes(root: Path) -> Path:
    """A folder with a scene of Experiment 1 and an open point."""
    folder = root / "scenes"
    (folder / "choices").mkdir(parents=True)
    (folder / f"{STEMS[1]}.toml").write_text(SCENE, encoding="utf-8")
    (folder / "choices" / "points.toml").write_text(POINTS, encoding="utf-8")
    return folder


class Links(HTMLParser):
    """Collects what a page refers to and the anchors it has."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note a tag's references and id."""
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.targets.append(value)
            if name == "id" and value:
                self.anchors.add(value)


def text_of(out: Path, name: str = "index.html") -> str:
    """The text of a page."""
    return (out / name).read_text(encoding="utf-8")


def links_of(page: Path) -> Links:
    """The references and anchors of a page."""
    links = Links()
    links.feed(page.read_text(encoding="utf-8"))
    return links


def make(runs: Path, out: Path, experiments: Path | None = None) -> int:
    """Make a page of these runs, and of what is kept in atlas/ beside them, without the chart of errors against time; its exit status."""
    folders = {"runs": runs, "out": out, "experiments": experiments or runs.parent / "no_scenes",
               "precision": runs.parent / "no_chart", "stability": runs.parent / "atlas"}
    return main(["--strict", *(word for name, folder in folders.items() for word in (f"--{name}", str(folder)))])


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page of all six experiments, one run of which failed."""
    root = tmp_path_factory.mktemp("page")
    (root / "atlas").mkdir()
    shutil.copy(RECORDS / "flow_explicit.json", root / "atlas")
    assert make(write_all(root), root / "out", write_scenes(root)) == 0
    return root / "out"


@pytest.fixture(scope="module")
def page(made: Path) -> str:
    """Its text."""
    return text_of(made)


def test_every_figure_is_written_and_shown(made: Path, page: str) -> None:
    """Each figure exists as SVG and PNG and stands on the page."""
    for name in FIGURES:
        assert (made / "figures" / f"{name}.svg").stat().st_size > 1000
        assert (made / "figures" / f"{name}.png").stat().st_size > 1000
        assert f'src="figures/{name}.svg"' in page


def test_every_link_is_relative_and_leads_somewhere(made: Path) -> None:
    """Nothing on the page needs a network or a place outside its folder."""
    links = links_of(made / "index.html")
    assert len(links.targets) > 60 and "stability.html" in links.targets
    for target in links.targets:
        if target.startswith("#"):
            assert target[1:] in links.anchors, target
        else:
            assert not re.match(r"[a-z]+:|/|\.\.", target), target
            assert (made / target).is_file(), target


def test_verdicts_come_first_with_their_numbers(page: str) -> None:
    """The table of claims precedes all figures and has what was measured and asked, for each mechanics."""
    assert page.index('id="verdicts"') < page.index("<figure")
    table = page[page.index('class="claims"') : page.index("<figure")]
    for words in ("only under a variant", "not reproduced", "0.64\u00a0MPa", "at least 1.6\u00a0MPa", "J at interface"):
        assert words in table, words
    row = table[table.index('class="id">2c') :]
    assert re.findall(r'class="verdict (\w+)"', row)[:2] == ["partly", "yes"], "explicit and quasi-static side by side"


def test_the_two_mechanics_are_compared(page: str) -> None:
    """Start, arrest and kinetic energy of a variant stand one above the other with their difference."""
    table = page[page.index('id="inertia"') : page.index('id="open"')]
    row = table[table.index("<b>1 weak</b>") :].split("</tr>")[0]
    assert "+0.0" in row and "2.3" in row and "10\u00a0m" in row and "3.3\u00a0%" in row
    assert "In " in table and "does the same with and without inertia" in table


def test_claims_stand_against_choices(page: str) -> None:
    """A line a claim and mechanics; a choice that holds only for some of the cases, or is open, says so."""
    table = page[page.index('class="sensitivity"') :].split("</table>")[0]
    assert "conserves volume" in table and "inlet pressure everywhere" not in table, "only choices that claims were evaluated under"
    lines = re.findall(r'class="mark (\w+)', table)
    assert lines == ["yes", "none", "yes", "none", "no", "yes", "yes", "yes", "no", "open", "no", "open"]
    assert "reproduced under every choice and mechanics that was run: 1b" in page.lower()


def test_variants_of_other_choices_are_folded(page: str) -> None:
    """The study's own variants are open to see, the others behind a line that says how many there are."""
    part = page[page.index(f'id="{STEMS[1]}"') : page.index(f'id="{STEMS[2]}"')]
    assert "Runs of other choices (3)" in part, "uniform in both, flow missing in quasi-static, which alone can run it"
    assert part.index("<b>weak</b>") < part.index('class="others"') < part.index("<b>uniform</b>")


def test_a_failed_run_is_shown_with_its_reason(page: str) -> None:
    """A failed run stands in the list of failures and in its table, and its figure is still drawn."""
    assert page.count("a mechanism: the upper block is free") >= 2
    assert 'class="failed"' in page


def test_findings_are_computed_from_the_runs(tmp_path: Path) -> None:
    """Another arrest gives another title: nothing in it is typed."""
    titles = []
    for restart in (3.0e6, 3.4e6):
        runs = tmp_path / f"runs{restart:.0f}"
        write_run(runs, 1, Plan("weak", ("weak",), stop_at_m=10.0, restart_Pa=restart))
        make(runs, tmp_path / "out")
        titles += re.findall(r'alt="Figure 3: ([^"]+)"', text_of(tmp_path / "out"))
    pressures = [float(re.search(r"until ([\d.]+)\sMPa", title).group(1)) for title in titles]
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
    assert "not run: undamped (explicit)" in page and 'class="missing"' in page
    assert 'id="inertia"' not in page and "uasi-static" not in page


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
