"""Turns runs, verdicts and figures into the page: tables as plain data, then the template."""

from __future__ import annotations

import platform
import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from reports.choices import signed_mpa
from reports.comparison import Comparison, Pair, comparisons, inertia_words
from reports.curves import held, metres_signed
from reports.figures import Made
from reports.layout import flat_keys
from reports.ledger import closure_of, differences, spread_of, suspicions
from reports.outcome import interface_states, outcome_of
from reports.precision_page import Front
from reports.stability_page import Front as Atlas
from reports.runs import Run, mechanics_in
from reports.sensitivity import SYMBOLS, sensitivity
from reports.verdicts import ClaimRow, claim_rows, counts, mechanics_of_rows
from reports.words import listed, mechanics_name, metres, mpa, number, plain, setting, share
from verification.harness.choices import Point
from verification.harness.claim_data import ClaimResult
from verification.harness.scenes import MECHANICS

COPIED: tuple[str, ...] = ("scene.toml", "summary.json", "history.csv")


@dataclass(frozen=True)
class Section:
    """One experiment on the page."""

    anchor: str
    number: int
    title: str
    figures: list[Made]
    claims: list[ClaimRow]
    rows: list[dict[str, Any]]
    failures: list[dict[str, str]]
    missing: list[str]
    settings: list[tuple[str, str]]


def write_page(
    out: Path,
    runs: list[Run],
    claims: list[ClaimResult],
    figures: list[Made],
    points: Sequence[Point] = (),
    verified: str = "",
    precision: Front | None = None,
    stability: Atlas | None = None,
) -> Path:
    """Write index.html and copies of each run's small files; `verified`: what verification.html beside it says, if it is there;
    `precision`: the chart of error against time, which comes first; `stability`: what stability.html beside it says."""
    out.mkdir(parents=True, exist_ok=True)
    for run in runs:
        _copy_sources(run, out)
    loader = jinja2.FileSystemLoader(Path(__file__).parent / "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    page = out / "index.html"
    content = {**context(runs, claims, figures, points), "verified": verified, "precision": precision, "stability": stability}
    page.write_text(environment.get_template("page.html").render(content), encoding="utf-8")
    return page


def _copy_sources(run: Run, out: Path) -> None:
    """Put a run's scene, summary and history beside the page, so that its links hold wherever it is moved."""
    target = out / "data" / run.mechanics / run.experiment / run.variant
    for name in COPIED:
        if (run.folder / name).exists():
            target.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(run.folder / name, target / name)


def context(runs: list[Run], claims: list[ClaimResult], figures: list[Made], points: Sequence[Point]) -> dict[str, Any]:
    """Everything that the template shows."""
    verdicts = claim_rows(claims)
    tally = counts(verdicts)
    compared = comparisons(runs)
    experiments = sorted({(run.number, run.experiment) for run in runs})
    sections = [section(stem, [run for run in runs if run.experiment == stem], verdicts, figures)
                for _, stem in experiments]
    return {
        "claims": verdicts,
        "counts": [(name, [entry for entry in entries if entry[2]]) for name, entries in tally],
        "mechanics": mechanics_of_rows(verdicts),
        "both": len(mechanics_in(runs)) > 1,
        "compared": [comparison_row(row) for row in compared],
        "inertia": inertia_words(compared),
        "sensitivity": sensitivity([claim for claim in claims if claim.mechanics in MECHANICS], points),
        "symbols": SYMBOLS,
        "headline": headline(runs, tally),
        "sections": sections,
        "homeless": [made for made in figures if made.experiment not in (0, *(number for number, _ in experiments))],
        "method": [made for made in figures if made.part == "method"],
        "choices": [made for made in figures if made.part == "choice"],
        "dots": [made for made in figures if made.part == "variants"],
        "figures": figures,
        "made_of": made_of(runs),
        "findings": [made for made in figures if made.ok and made.experiment > 0 and made.name.startswith("fig")],
        "failures": [row for part in sections for row in part.failures],
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


def section(stem: str, runs: list[Run], claims: list[ClaimRow], figures: list[Made]) -> Section:
    """One experiment's part of the page."""
    number_of = runs[0].number
    base = next((run for run in runs if run.scene), None)
    own = [made for made in figures if made.experiment == number_of or (made.name == "fig8" and number_of == 6)]
    title = str(base.scene.get("title", "")) if base else ""
    return Section(
        anchor=stem,
        number=number_of,
        title=title or plain(stem),
        figures=[made for made in own if not (made.name == "fig8" and number_of == 6)],
        claims=[row for row in claims if row.id.startswith(str(number_of))],
        rows=[run_row(run, runs) for run in runs],
        failures=[
            {"run": f"{run.experiment} / {plain(run.variant)}, {mechanics_name(run.mechanics)}", "status": run.status, "reason": run.reason}
            for run in runs if run.status not in ("completed", "missing")
        ],
        missing=[f"{plain(run.variant)} ({mechanics_name(run.mechanics)})" for run in runs if run.status == "missing"],
        settings=settings_of(base) if base else [],
    )


def run_row(run: Run, runs: list[Run]) -> dict[str, Any]:
    """One run's line in its experiment's table."""
    summary = run.summary
    outcome = outcome_of(run, runs) if run.drawable else None
    closure, spread = closure_of(run), spread_of(run)
    return {
        "variant": plain(run.variant),
        "mechanics": mechanics_name(run.mechanics),
        "is_main": run.is_main,
        "status": run.status,
        "reason": "" if run.status == "completed" else run.reason,
        "link": f"data/{run.mechanics}/{run.experiment}/{run.variant}/",
        "files": [name for name in COPIED if (run.folder / name).exists()],
        "differs": differences(run, runs),
        "start": mpa(outcome.start_Pa) if outcome and outcome.start_Pa is not None else "–",
        "arrest": (held(run, runs) or "–") if outcome else "–",
        "end": f"{metres(outcome.final_height_m)} at {mpa(outcome.final_inlet_Pa)}" if outcome else "–",
        "interfaces": interface_states(run),
        "steps": _count(summary.get("steps")),
        "wall": _seconds(summary.get("wall_s")),
        "rate": _millions(summary.get("particle_steps_per_s")),
        "closure": "–" if closure is None else share(abs(closure)),
        "spread": "–" if spread is None else share(spread),
        "suspect": suspicions(run, runs),
    }


def comparison_row(row: Comparison) -> dict[str, Any]:
    """One variant's line in the table of the two mechanics: (without inertia, with it, difference) a quantity."""

    def triple(pair: Pair, written: Callable[[float], str], signed: Callable[[float], str]) -> tuple[str, str, str]:
        """A pair in words with its difference."""
        known = ["–" if value is None else written(value) for value in (pair.quasistatic, pair.explicit)]
        return known[0], known[1], "" if pair.difference is None else signed(pair.difference)

    return {
        "experiment": row.number,
        "variant": plain(row.variant),
        "is_main": row.is_main,
        "start": triple(row.start_Pa, mpa, signed_mpa),
        "arrest": triple(row.arrest_Pa, mpa, signed_mpa),
        "arrest_m": triple(row.arrest_m, metres, metres_signed),
        "restart": triple(row.restart_Pa, mpa, signed_mpa),
        "end": triple(row.end_m, metres, metres_signed),
        "path": "–" if row.path_m is None else f"{row.path_m:.2f}\u00a0m",
        "kinetic": ["–" if value is None else share(value) for value in (row.kinetic_ratio.quasistatic, row.kinetic_ratio.explicit)],
        "G_over_J": "–" if row.G_over_J is None else number(row.G_over_J),
        "unlike": row.unlike,
    }


def _count(value: Any) -> str:
    """A count with thin spaces between thousands."""
    return f"{int(value):,}".replace(",", "\u202f") if isinstance(value, (int, float)) else "–"


def _seconds(value: Any) -> str:
    """A duration in s."""
    return f"{number(float(value))} s" if isinstance(value, (int, float)) else "–"


def _millions(value: Any) -> str:
    """A rate in millions a second."""
    return f"{number(float(value) / 1e6)} M/s" if isinstance(value, (int, float)) else "–"


def settings_of(run: Run) -> list[tuple[str, str]]:
    """The resolved scene of a run as key and value."""
    return [(key, setting(value)) for key, value in flat_keys(run.scene).items()]


def made_of(runs: list[Run]) -> list[tuple[str, str]]:
    """Versions, machine and run times."""
    with_summary = [run for run in runs if run.summary]
    versions = sorted({str(run.summary.get("version", "unknown")) for run in with_summary})
    walls = [float(run.summary["wall_s"]) for run in with_summary
             if isinstance(run.summary.get("wall_s"), (int, float))]
    mechanics = [mechanics_name(name) for name in mechanics_in(runs)]
    cells = sorted({run.cell_m for run in runs if run.scene})
    memory = [float(run.summary["peak_memory_MB"]) for run in with_summary
              if isinstance(run.summary.get("peak_memory_MB"), (int, float))]
    rows = [
        ("strata", listed(versions) or "no run has said"),
        ("mechanics", listed(mechanics) or "no run has said"),
        ("cells", listed([metres(cell) for cell in cells]) or "no run has said"),
        ("runs", str(len(runs))),
        *((f"run time, {mechanics_name(name)}, summed", _summed(runs, name)) for name in mechanics_in(runs)),
        ("longest run", f"{number(max(walls))} s" if walls else "–"),
        ("largest memory of a run", f"{number(max(memory))} MB" if memory else "–"),
        ("machine that made this page", machine()),
        ("page made with", f"Python {platform.python_version()}, jinja2 {jinja2.__version__}"),
    ]
    return rows


def _summed(runs: list[Run], mechanics: str) -> str:
    """The wall time of all runs of a mechanics."""
    own = [run.summary.get("wall_s") for run in runs if run.mechanics == mechanics]
    known = [float(value) for value in own if isinstance(value, (int, float))]
    return f"{number(sum(known))} s in {len(known)} runs"


def machine() -> str:
    """The processor's name and the number of its threads, and the system."""
    names: list[str] = []
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    except OSError:
        pass
    processor = f"{names[0]}, {len(names)} threads" if names else platform.processor() or platform.machine()
    return f"{processor}; {platform.system()} {platform.release()}"
