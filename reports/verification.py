"""The page of verification: the accuracy ladder, then the parts that other modules fill.

A module of reports/ that fills a part has `section(runs: Path) -> Section | None` (`reports/figures.py`): what it found below the folder of
runs in words, with its figures as declarations and its tables; None where the command that makes it was not run. What was run and failed
is to be said in a row, a caption or the intro.
"""

import importlib
import math
import traceback
from pathlib import Path
from typing import Any

from reports.charts.ladder import draw_convergence
from reports.figures import Figure, Section, make, told_of, words_of, write_page
from reports.ladder import Ladder, Row, case_words, convergence_figure, convergence_words, curves_of, load_ladder
from reports.shown import Shown
from reports.words import NONE, counted, number, order_words, plain, relative, sentence, thousands

# Modules of reports/ that fill parts of the page, in its order; one that is not there is left out.
PARTS: tuple[str, ...] = ("ablation", "path_check", "refinement", "budget", "benchmarks")
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
            shown |= {**ladder_context(ladder, out), "headline": headline(ladder)}
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


def headline(ladder: Ladder | None) -> str:
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


def ladder_context(ladder: Ladder, out: Path) -> dict[str, Any]:
    """What the template shows of the ladder; its figures are written below `out`."""
    return {
        "ladder": ladder, "mutation": words_of("mutation", tally=ladder.tally), "families": [_family(ladder, name, out) for name in ladder.families],
        "wrong": [{"name": f"{row.family} / {row.case}: {row.quantity} at {row.level}", "why": row.why, "verdict": row.verdict}
                  for row in ladder.rows if not row.passed],
    }


def _family(ladder: Ladder, name: str, out: Path) -> Shown:
    """A family: what it says, its chart (None where all is round-off), a block of table rows a case.

    exact: the blocks of cases of which everything holds to round-off as it should, which the page folds away;
    reasons: why no order is to be expected, which the tables refer to by their numbers.
    """
    rows = [row for row in ladder.rows if row.family == name]
    data, curves = convergence_figure(ladder, name), curves_of(rows)
    reasons = list(dict.fromkeys(row.no_order for row in rows if row.no_order))
    blocks: dict[bool, list[dict[str, Any]]] = {True: [], False: []}
    for case in dict.fromkeys(row.case for row in rows):
        own = [row for row in rows if row.case == case]
        blocks[all(row.round_off and row.passed for row in own)].append(_block(ladder, own, reasons))
    return Shown(
        name=name, title=plain(name)[:1].upper() + plain(name)[1:], says=sentence(ladder.families[name]),
        finding=convergence_words(curves) if curves else "Everything holds to round-off" if rows else "Nothing was run",
        figure=None if data is None else make(Figure(f"ladder_{name}", data, draw_convergence, "convergence"), out),
        blocks=blocks[False], exact=blocks[True], reasons=reasons, comparisons=len(rows), wrong=sum(not row.passed for row in rows),
    )


def _block(ladder: Ladder, rows: list[Row], reasons: list[str]) -> dict[str, Any]:
    """A case's part of the table: its quantities, each with its levels."""
    first = rows[0]
    quantities = [_quantity([row for row in rows if row.quantity == name], reasons) for name in dict.fromkeys(row.quantity for row in rows)]
    return {"name": case_words(first.case, first.mechanics), "says": sentence(ladder.cases[first.family, first.case]), "comparisons": len(rows),
            "quantities": quantities}


def _quantity(own: list[Row], reasons: list[str]) -> dict[str, Any]:
    """A quantity's cells: how many values there are at each level where there is more than one; what errors are relative to where it is not the
    reference itself; the numbers of the reasons why no order is expected, with the levels where that is not so of all; and the levels."""
    counts = list(dict.fromkeys(row.values for row in own if row.values > 0))
    scales = list(dict.fromkeys(number(row.scale, 3) for row in own if row.scale is not None))
    without = [(index, [row.level for row in own if row.no_order == reason]) for index, reason in enumerate(reasons, 1)]
    return {
        "name": own[0].quantity, "unit": own[0].unit, "count": f"rms of {' / '.join(map(str, counts))} values" if max(counts, default=1) > 1 else "",
        "reasons": [(index, "" if len(levels) == len(own) else f" at {', '.join(levels)}") for index, levels in without if levels],
        "scale": f"errors relative to {' / '.join(scales)} {own[0].unit}".rstrip() if scales else "",
        "levels": [line(row) for row in own], "height": len(own) + sum(bool(row.why or row.note) for row in own),
    }


def line(row: Row) -> dict[str, Any]:
    """A level's cells."""
    order = NONE if row.order is None else order_words(row.order, 2)
    value, reference = (NONE if math.isnan(one) else number(one, 6) for one in (row.value, row.reference))
    return {
        "level": row.level, "value": value, "reference": reference, "own": relative(row.reference_error) if row.reference_error > 0.0 else "",
        "own_matters": row.reference_error > abs(row.error) / 3.0, "error": relative(row.error, signed=row.values == 1),
        "order": f"({order})" if row.no_order and row.order is not None else order, "gate": "none" if math.isnan(row.gate) else relative(row.gate),
        "order_gate": "" if row.order_gate is None else f"≥ {row.order_gate:g}",
        "wall": NONE if math.isnan(row.wall_s) else f"{row.wall_s:.1f}" if row.wall_s >= 0.1 else f"{row.wall_s:.2g}",
        "particles": thousands(row.particles), "steps": thousands(row.steps), "memory": NONE if math.isnan(row.memory_MB) else f"{row.memory_MB:.0f}",
        "verdict": row.verdict, "passed": row.passed, "why": row.why, "note": row.note,
    }
