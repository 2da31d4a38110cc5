"""The page of verification: the accuracy ladder, then the parts that other modules fill.

A module of reports/ that fills a part has `section(runs: Path) -> Section | None` (`reports/figures.py`): what it found below the folder of
runs in words, with its figures as declarations and its tables; None where the command that makes it was not run. What was run and failed
is to be said in a row, a caption or the intro.
"""

import importlib
import traceback
from pathlib import Path
from typing import Any

from reports.charts.ladder import draw_convergence
from reports.figures import Figure, Section, make, told_of, words_of, write_page
from reports.ladder import family_shown, load_ladder
from reports.shown import Shown
from reports.words import counted

# Modules of reports/ that fill parts of the page, in its order; one that is not there is left out.
PARTS: tuple[str, ...] = ("measured", "ablation", "path_check", "refinement", "budget", "benchmarks")
NAME = "verification.html"
LADDER = Path("ladder") / "ladder.json"


def write_verification(runs: Path, out: Path, ladder_file: Path | None = None, with_index: bool = False) -> Shown:
    """Write verification.html from ladder.json and whatever the parts find below `runs`; with_index: index.html is about to be written beside it."""
    return told_of(NAME, lambda: _write(runs, out, ladder_file or runs / LADDER, with_index), "The page of verification could not be made")


def _write(runs: Path, out: Path, ladder_file: Path, with_index: bool) -> Shown:
    """The page; a part that meets a defect is told on it and left out."""
    sections, defects = _parts(runs)
    shown: dict[str, Any] = {"families": [], "ladder": None, "headline": headline(None)}
    pictures: list[Shown] = []
    try:
        ladder = load_ladder(ladder_file)
        if ladder is not None:
            shown |= ladder_context(ladder, out)
            pictures += (family.figure for family in shown["families"] if family.figure)
    except Exception:  # a torn file must not cost the reader the other parts
        defects.append(traceback.format_exc())
        shown["headline"] = "The accuracy ladder's judgement could not be read."
    if shown["ladder"] is None and not sections and not defects:
        return Shown(lack=f"nothing to show below {runs}")
    parts = [{**section, "figures": [make(figure, out) for figure in section["figures"]]} for section in sections]
    defects += [made.defect for made in (*pictures, *(made for part in parts for made in part["figures"])) if made.defect]
    words = [defect.strip().splitlines()[-1] for defect in defects]
    write_page(out, NAME, {**shown, "parts": parts, "defects": words, "index": with_index or (out / "index.html").is_file()})
    return Shown(words=shown["headline"], defect="\n".join(defects))


def _parts(runs: Path) -> tuple[list[Section], list[str]]:
    """What the other modules have for the page, and the traces of those that broke."""
    sections, defects = [], []
    for name in PARTS:
        try:
            found = importlib.import_module(f"reports.{name}").section(runs)
            sections += [] if found is None else [found]
        except Exception as error:  # a defect in one part must not cost the reader all the others
            if not (isinstance(error, ModuleNotFoundError) and error.name == f"reports.{name}"):
                defects.append(traceback.format_exc())
    return sections, defects


def headline(ladder: Shown | None) -> str:
    """What the ladder found, in a sentence or two."""
    if ladder is None:
        return "The accuracy ladder has not been run: ci/verify does."
    rows = ladder.rows
    wrong = sum(not row.passed for row in rows)
    cases, families = len({(row.family, row.case) for row in rows}), len({row.family for row in rows})
    of_what = f"{len(rows)} comparisons with references ({counted(cases, 'case')} in {counted(families, 'family')})"
    if not rows:
        return "No case of the accuracy ladder has been run."
    if wrong == 0:
        return f"All {of_what} are within their gates."
    return f"Of {of_what}, {wrong} {'is' if wrong == 1 else 'are'} not as {'its gate asks' if wrong == 1 else 'their gates ask'}."


def ladder_context(ladder: Shown, out: Path) -> dict[str, Any]:
    """What the template shows of the ladder; its figures are written below `out`."""
    families = [family_shown(ladder, family) for family in ladder.families]
    for one in families:
        one.figure = one.data and make(Figure(f"ladder_{one.name}", one.data, draw_convergence, "convergence"), out)
    return {"ladder": ladder, "mutation": words_of("mutation", tally=ladder.tally), "families": families,
            "wrong": [row for row in ladder.rows if not row.passed], "headline": headline(ladder)}
