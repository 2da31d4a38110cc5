"""Turns runs, verdicts, figures and kept records into the front page: tables as plain data, then the template."""

import json
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from reports import ablation, crossing_map, measured, precision
from reports.choices import choice_rows
from reports.claims import SYMBOLS, by_verdict, claim_rows, columns_of, differing, sensitivity
from reports.comparison import comparisons, inertia_words
from reports.figures import Table, Topic, make, words_of, write_page
from reports.ladder import load_ladder
from reports.ladder import topic as accuracy
from reports.run_rows import title_of, write_runs
from reports.runs import Run
from reports.words import Shown, listed, mechanics_name, plain, wall_time
from verification.harness.choices import Point
from verification.harness.claim_data import NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, ClaimResult
from verification.harness.scenes import MECHANICS


def topics(ladder: Path, chart: Path, records: Path) -> list[Topic | Shown]:
    """The sections from records that are kept, in the page's order; one whose records cannot be read is told as such."""
    builders: dict[str, Callable[[], Topic | None]] = {
        "accuracy": lambda: accuracy(load_ladder(ladder, records / "ladder" / "gates")), "precision": lambda: precision.topic(chart),
        "needs": lambda: ablation.topic(records / "ablation" / "records"), "measured": lambda: measured.topic(records / "measured" / "records" / "rubin.json"),
        "crossing": lambda: crossing_map.topic(records / "crossing_map" / "records"),
    }  # fmt: skip
    found: list[Topic | Shown] = []
    for name, build in builders.items():
        try:
            made = build()
            found += [] if made is None else [made]
        except Exception as error:  # a torn record must not cost the reader the rest
            found.append(Shown(name=name, title=plain(name).capitalize(), lack=f"its records cannot be read: {error}", defect=traceback.format_exc()))
    return found


def topic_shown(topic: Topic | Shown, out: Path) -> Shown:
    """A section as the template shows it, its figure written."""
    if isinstance(topic, Shown):
        return topic
    return Shown(**{**vars(topic), "made": topic.figure and make(topic.figure, out), "lack": "", "defect": ""})


def write_index(
    out: Path, runs: list[Run], claims: list[ClaimResult], figures: list[Shown], points: Sequence[Point], sections: Sequence[Shown],
    films: Sequence[Path] = (), **beside: Shown,
) -> Path:  # fmt: skip
    """Write index.html and runs.html; films: the animations, below `out`; beside: what is told of the pages `verification` and `stability`."""
    compared = comparisons(runs)
    write_runs(out, runs, compared)
    return write_page(out, "index.html", {**context(runs, claims, figures, points, sections), "inertia": inertia_words(compared), "topics": sections,
                                         "films": {film.stem: Shown(path=film.relative_to(out), **json.loads(film.with_suffix(".json").read_text("utf-8"))) for film in films},
                                         **beside})


def context(runs: list[Run], claims: list[ClaimResult], figures: list[Shown], points: Sequence[Point], sections: Sequence[Shown]) -> dict[str, Any]:
    """What the template shows of experiments and verdicts."""
    rows = claim_rows(claims)
    columns = columns_of(rows)
    named = {made.name: made for made in figures}
    experiments = {run.number: [one for one in runs if one.experiment == run.experiment] for run in runs}
    of_figure = {number: [named[name] for name in names if name in named] for number, names in FIGURES.items()}
    return {
        "groups": [Shown(number=number, title=title_of(own), stem=own[0].experiment, claims=[row for row in rows if row.id.startswith(str(number))],
                         figures=of_figure.get(number, [])) for number, own in experiments.items()],
        "columns": columns, "symbols": SYMBOLS, "headline": headline(runs, rows, columns), "minute": minute(runs, rows, columns, sections), "by_cell": cell_words(rows),
        "method": of_figure[0] if experiments else figures, "how": words_of("how"),
        "sensitivity": sensitivity([claim for claim in claims if claim.mechanics in MECHANICS], points),
        "choices": Table("", ["Open", "Default", "Choice", "What it moves at most"], choice_rows(points, runs)) if points else None,
        "failures": [f"{run.experiment} / {plain(run.variant)}, {mechanics_name(run.mechanics)} {run.status}: {run.reason or 'no reason given'}" for run in runs
                     if run.status != "completed"],
        "versions": listed(sorted({str(run.summary["version"]) for run in runs if run.summary.get("version")})),
        "recorded": listed(sorted({flag for claim in claims for flag in claim.flags if flag.startswith("recorded by")})),
    }  # fmt: skip


FIGURES = {0: ("fig1", "fig2"), 1: ("fig3",), 2: ("fig4",), 3: ("fig5",), 4: ("fig6", "fig7"), 5: ("fig8",)}  # by experiment; 0: of the method


def headline(runs: list[Run], rows: Sequence[Shown], columns: Sequence[Shown]) -> str:
    """The page's first sentence: how many claims hold in the first column, and how many runs stand behind them."""
    complete = f"{sum(run.status == 'completed' for run in runs)} of {len(runs)} runs are complete."
    if not columns:
        return f"No verdict on any claim has been written yet. {complete}"
    told = [f"{len(own)} {_predicate(name, len(own))}" for name, own in by_verdict(rows, columns[0].key).items()]
    return f"Of {len(rows)} claims of the study {listed(told)} ({columns[0].words}). {complete}"


def minute(runs: list[Run], rows: Sequence[Shown], columns: Sequence[Shown], sections: Sequence[Shown]) -> list[tuple[str, str]]:
    """What a reader takes along in a minute: which claims hold and which do not, how accurate the numbers are, how fast the runs."""
    told = []
    if columns:
        holds, *rest = (by_verdict(rows, columns[0].key).get(name, []) for name in (REPRODUCED, ONLY_UNDER_A_VARIANT, NOT_REPRODUCED))
        turned, never = (listed([row.id for row in own]) or "none" for own in rest)
        told = [("What holds", " ".join(f"{row.text.rstrip('.')} ({row.id})." for row in holds) or "No claim."),
                ("What does not", f"{never}; only under another reading of what the study leaves open: {turned}.")]
    errors = [f"{what}\u00a0{found.split(', ')[-1].split(' (')[0]}" for one in sections if one.name == "accuracy" and one.shown for what, _, found in one.shown.rows]
    told += [("How accurate", f"Errors in the finest cells tried: {'; '.join(errors)}.")] if errors else []
    times = {name: own for name in MECHANICS[::-1] if (own := [float(run.summary["wall_s"]) for run in runs if run.mechanics == name and run.summary.get("wall_s")])}
    medians = listed([f"{wall_time(float(np.median(own)))} {mechanics_name(name)}" for name, own in times.items()])
    return told + ([("How fast", f"A run of the experiments takes {medians} (medians), the longest {wall_time(max(map(max, times.values())))}, on one thread.")] if times else [])


def _predicate(verdict: str, count: int) -> str:
    """A verdict as a predicate of so many claims."""
    if verdict == "only under a variant":
        return f"hold{'s' if count == 1 else ''} only under another reading"
    return f"{'is' if count == 1 else 'are'} {verdict}"


def cell_words(rows: Sequence[Shown]) -> str:
    """What the size of cells decides: claims on which runs with and without inertia differ, at the cells of the scenes and at half of them."""
    coarse, fine = differing(rows, ""), differing(rows, " 0.5 m")
    return words_of("by_cell", coarse=coarse, fine=fine) if coarse and fine is not None and len(fine) < len(coarse) else ""
