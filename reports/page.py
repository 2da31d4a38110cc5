"""Turns runs, verdicts, figures and kept records into the front page and the page of all runs (what each did, in which settings it differs, what it cost, and what
of it is not to be trusted): tables as plain data, then the templates."""

import json
import platform
import shutil
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from reports import crossing_map, kept
from reports.claims import SYMBOLS, by_verdict, choice_rows, claim_rows, columns_of, differing, sensitivity
from reports.figures import Table, Topic, make, words_of, write_page
from reports.ladder import load_ladder, topic as accuracy
from reports.outcome import comparisons, held, inertia_words, interface_states, outcome_of
from reports.runs import Run, flat_keys, mechanics_in, settings_between
from reports.words import NONE, Shown, listed, mechanics_name, metres, mpa, number, plain, setting, share, thousands, wall_time, written
from verification.benchmarks.machine import this_machine
from verification.harness.claims import NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, ClaimResult, Point
from verification.harness.observables import BY_J
from verification.harness.scenes import MECHANICS


def topics(ladder: Path, chart: Path, records: Path) -> list[Topic | Shown]:
    """The sections from records that are kept, in the page's order; one whose records cannot be read is told as such."""
    builders: dict[str, Callable[[], Topic | None]] = {
        "accuracy": lambda: accuracy(load_ladder(ladder, records / "ladder" / "gates")), "precision": lambda: kept.chart_topic(chart),
        "needs": lambda: kept.needs_topic(records / "ablation" / "records"), "measured": lambda: kept.beside_topic(records / "measured" / "records" / "rubin.json"),
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


RUNS_PAGE = "runs.html"
COPIED: tuple[str, ...] = ("scene.toml", "summary.json", "history.csv")


def write_runs(out: Path, runs: list[Run], compared: Sequence[Shown]) -> Path:
    """Write runs.html and copies of each run's small files beside it."""
    for run in runs:
        target = out / "data" / run.mechanics / run.experiment / run.variant
        for name in COPIED:
            if (run.folder / name).exists():
                target.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(run.folder / name, target / name)
    parts = [part_of([run for run in runs if run.experiment == stem]) for stem in dict.fromkeys(run.experiment for run in runs)]
    unlike = [(f"{row.number} {plain(row.variant)}", "; ".join(row.unlike)) for row in compared if row.unlike]
    return write_page(out, RUNS_PAGE, {"parts": parts, "both": len(mechanics_in(runs)) > 1, "unlike": unlike, "compared": len(compared), "made_of": made_of(runs)})


def part_of(runs: list[Run]) -> Shown:
    """One experiment's part of the page."""
    base = next((run for run in runs if run.scene), None)
    return Shown(anchor=runs[0].experiment, title=title_of(runs), rows=[run_row(run, runs) for run in runs],
                 settings=[(key, setting(value)) for key, value in flat_keys(base.scene).items()] if base else [])


def title_of(runs: Sequence[Run]) -> str:
    """An experiment's title as its scene has it."""
    base = next((run for run in runs if run.scene.get("title")), None)
    return str(base.scene["title"]) if base else plain(runs[0].experiment)


def run_row(run: Run, runs: list[Run]) -> dict[str, Any]:
    """One run's line in its experiment's table."""
    summary, outcome = run.summary, outcome_of(run, runs) if run.drawable else None
    return {
        "variant": plain(run.variant), "mechanics": mechanics_name(run.mechanics), "is_main": run.is_main, "status": run.status, "reason": run.reason,
        "link": f"data/{run.mechanics}/{run.experiment}/{run.variant}/", "files": [name for name in COPIED if (run.folder / name).exists()],
        "differs": differences(run, runs), "start": written(outcome.start_Pa if outcome else None, mpa),
        "arrest": (held(run, runs) or NONE) if outcome else NONE,
        "end": f"{metres(outcome.final_height_m)} at {mpa(outcome.final_inlet_Pa)}" if outcome else NONE,
        "interfaces": interface_states(run), "steps": thousands(summary.get("steps")),
        "wall": written(summary.get("wall_s"), lambda seconds: f"{number(float(seconds))} s"),
        "closure": written(closure_of(run), lambda size: share(abs(size))), "spread": written(spread_of(run), share),
        "suspect": suspicions(run, runs),
    }


def made_of(runs: list[Run]) -> list[tuple[str, str]]:
    """Versions, machine and run times."""

    def known(key: str, own: Sequence[Run] = runs) -> list[float]:
        """A number of all summaries that have it."""
        return [float(run.summary[key]) for run in own if isinstance(run.summary.get(key), (int, float))]

    present = mechanics_in(runs)
    walls = {name: known("wall_s", [run for run in runs if run.mechanics == name]) for name in present}
    versions = sorted({str(run.summary.get("version", "unknown")) for run in runs if run.summary})
    cells = sorted({run.cell_m for run in runs if run.scene})
    return [
        ("strata", listed(versions) or "no run has said"), ("mechanics", listed(list(map(mechanics_name, present))) or "no run has said"),
        ("cells", listed(list(map(metres, cells))) or "no run has said"), ("runs", str(len(runs))),
        *((f"run time, {mechanics_name(name)}, summed", f"{number(sum(times))} s in {len(times)} runs") for name, times in walls.items()),
        ("longest run", written(max(known("wall_s"), default=None), lambda seconds: f"{number(seconds)} s")),
        ("largest memory of a run", written(max(known("peak_memory_MB"), default=None), lambda size: f"{number(size)} MB")),
        ("machine that made this page", this_machine().words), ("page made with", f"Python {platform.python_version()}, jinja2 {jinja2.__version__}"),
    ]


def closure_of(run: Run) -> float | None:
    """What the ledger leaves unexplained, as a fraction of its largest energy."""
    value = (run.summary.get("energy") or {}).get("closure")
    return float(value) if isinstance(value, (int, float)) else None


def base_of(run: Run, runs: list[Run]) -> Run | None:
    """For a variant that is no interface type of the study, the main variant with the fewest other settings."""
    if run.is_main or not run.scene:
        return None
    others = [other for other in runs if other.is_main and other.scene and (other.experiment, other.mechanics) == (run.experiment, run.mechanics)]
    return min(others, key=lambda other: (len(settings_between(run, other)), other.variant not in run.variant), default=None)


def differences(run: Run, runs: list[Run]) -> str:
    """In words, the settings by which a variant differs from its nearest main variant."""
    base = base_of(run, runs)
    if base is None:
        return ""
    parts = [f"{key} {setting(old)} → {setting(new)}" for key, old, new in settings_between(run, base)]
    return f"as {plain(base.variant)}" + (f" but {'; '.join(parts)}" if parts else "")


def spread_of(run: Run) -> float | None:
    """The median spread of J over its rings at growth away from interfaces, as a fraction of its mean."""
    if "J_spread" not in run.history:
        return None
    column = run.history["J_spread"]
    grown = np.isfinite(column) & (run.history.get("J_N_m", column) > 0.0)
    return float(np.median(column[grown])) if grown.any() else None


def suspicions(run: Run, runs: Sequence[Run] = ()) -> list[str]:
    """What the run itself or its data mark as not to be trusted, in words; J at an interface unless a run confirms it."""
    arrests = outcome_of(run, runs).arrests if run.drawable else ()
    places = list(dict.fromkeys(metres(arrest.height_m) for arrest in arrests if arrest.flag))
    return run.marks + ([f"{BY_J} ({listed(places)})"] if places else [])
