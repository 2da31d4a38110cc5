"""The page of all runs: what each did, in which settings it differs, what it cost, and what of it is not to be trusted."""

import platform
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from reports.figures import write_page
from reports.outcome import held, interface_states, outcome_of
from reports.runs import Run, flat_keys, mechanics_in, settings_between
from reports.words import NONE, Shown, listed, mechanics_name, metres, mpa, number, plain, setting, share, thousands, written
from verification.benchmarks.machine import this_machine
from verification.harness.claim_data import BY_J

NAME = "runs.html"
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
    return write_page(out, NAME, {"parts": parts, "both": len(mechanics_in(runs)) > 1, "unlike": unlike, "compared": len(compared), "made_of": made_of(runs)})


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
