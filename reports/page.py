"""Turns runs, verdicts and figures into the page: tables as plain data, then the template."""

import platform
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2

from reports.claims import SYMBOLS, claim_rows, counts, mechanics_of_rows, sensitivity
from reports.comparison import comparisons, inertia_words
from reports.figures import write_page
from reports.layout import flat_keys
from reports.ledger import closure_of, differences, spread_of, suspicions
from reports.outcome import held, interface_states, outcome_of
from reports.runs import Run, mechanics_in
from reports.shown import Shown
from reports.words import NONE, listed, mechanics_name, metres, mpa, number, plain, setting, share, thousands, written
from verification.benchmarks.machine import this_machine
from verification.harness.choices import Point
from verification.harness.claim_data import ClaimResult
from verification.harness.scenes import MECHANICS

COPIED: tuple[str, ...] = ("scene.toml", "summary.json", "history.csv")


def write_index(out: Path, runs: list[Run], claims: list[ClaimResult], figures: list[Shown], points: Sequence[Point] = (), **beside: Shown) -> Path:
    """Write index.html and copies of each run's small files. Beside: what is told of the pages `verification`, `precision` (whose chart comes first)
    and `stability`, of those that there are."""
    for run in runs:
        _copy_sources(run, out)
    return write_page(out, "index.html", {**context(runs, claims, figures, points), **beside})


def _copy_sources(run: Run, out: Path) -> None:
    """Put a run's scene, summary and history beside the page, so that its links hold wherever it is moved."""
    target = out / "data" / run.mechanics / run.experiment / run.variant
    for name in COPIED:
        if (run.folder / name).exists():
            target.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(run.folder / name, target / name)


def context(runs: list[Run], claims: list[ClaimResult], figures: list[Shown], points: Sequence[Point]) -> dict[str, Any]:
    """Everything that the template shows."""
    verdicts = claim_rows(claims)
    tally = counts(verdicts)
    compared = comparisons(runs)
    experiments = sorted({(run.number, run.experiment) for run in runs})
    numbers = {0, *(number for number, _ in experiments)}
    return {
        "claims": verdicts, "counts": [(name, [entry for entry in entries if entry[2]]) for name, entries in tally],
        "mechanics": mechanics_of_rows(verdicts), "both": len(mechanics_in(runs)) > 1, "compared": compared,
        "inertia": inertia_words(compared), "symbols": SYMBOLS, "headline": headline(runs, tally), "made_of": made_of(runs),
        "sensitivity": sensitivity([claim for claim in claims if claim.mechanics in MECHANICS], points), "figures": figures,
        "sections": [section([run for run in runs if run.experiment == stem], verdicts, figures) for _, stem in experiments],
        "homeless": [made for made in figures if made.experiment not in numbers],
        "findings": [made for made in figures if not made.lack and made.experiment > 0 and made.name.startswith("fig")],
        "failures": [{"run": f"{run.experiment} / {plain(run.variant)}, {mechanics_name(run.mechanics)}", "status": run.status, "reason": run.reason}
                     for run in runs if run.status not in ("completed", "missing")],
    }


def headline(runs: list[Run], tally: list[tuple[str, list[tuple[str, str, int]]]]) -> str:
    """The page's first sentence: how many claims hold and how many runs stand behind them."""
    complete = sum(run.status == "completed" for run in runs)
    runs_words = f"{complete} of {len(runs)} runs are complete."
    totals = [sum(count for _, _, count in entries) for _, entries in tally]
    if not any(totals):
        return f"No verdict on any claim has been written yet. {runs_words}"
    told = []
    for mechanics, entries in tally:
        parts = [f"{count} {_predicate(name, count)}" for name, _, count in entries if count]
        told.append(listed(parts) + (f" by {mechanics} runs" if len(tally) > 1 else ""))
    return f"Of {max(totals)} claims of the study, {'; '.join(told)}. {runs_words}"


def _predicate(verdict: str, count: int) -> str:
    """A verdict as a predicate of so many claims."""
    if verdict == "only under a variant":
        return f"hold{'s' if count == 1 else ''} only under a variant"
    return f"{'is' if count == 1 else 'are'} {verdict}"


def section(runs: list[Run], claims: list[Shown], figures: list[Shown]) -> Shown:
    """One experiment's part of the page."""
    first = runs[0]
    base = next((run for run in runs if run.scene), None)
    return Shown(
        anchor=first.experiment, number=first.number, title=(str(base.scene.get("title", "")) if base else "") or plain(first.experiment),
        figures=[made for made in figures if made.experiment == first.number], claims=[row for row in claims if row.id.startswith(str(first.number))],
        rows=[run_row(run, runs) for run in runs],
        missing=[f"{plain(run.variant)} ({mechanics_name(run.mechanics)})" for run in runs if run.status == "missing"],
        settings=[(key, setting(value)) for key, value in flat_keys(base.scene).items()] if base else [],
    )


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
        "rate": written(summary.get("particle_steps_per_s"), lambda rate: f"{number(float(rate) / 1e6)} M/s"),
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
