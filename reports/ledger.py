"""Prepares the energy ledger and the dot plot of every variant's events."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from reports.layout import settings_between
from reports.outcome import Outcome, flag_of, outcome_of
from reports.runs import NotAvailable, Run
from reports.words import listed, mechanics_name, metres, mpa, number, plain, setting, share
from verification.harness.claim_data import BY_J

_SUPPLIED: tuple[str, ...] = ("work", "supplied")
_STORED: tuple[str, ...] = ("kinetic", "strain")
_NOT_A_TERM: tuple[str, ...] = ("supplied", "stored", "dissipated", "total", "residual", "closure", "largest")


@dataclass(frozen=True)
class Term:
    """One energy in kJ per metre of thickness against inlet pressure in MPa."""

    name: str
    family: str  # "supplied", "stored" or "dissipated"
    inlet_MPa: np.ndarray
    energy_kJ: np.ndarray


@dataclass(frozen=True)
class LedgerPanel:
    """The energies of one run, and what they leave unexplained, in kJ per metre of thickness."""

    variant: str
    heading: str
    supplied: Term
    stored: tuple[Term, ...]
    dissipated: tuple[Term, ...]
    unexplained: Term


@dataclass(frozen=True)
class LedgerFigure:
    """Energy ledgers of one experiment's main variants."""

    title: str
    mechanics: str
    panels: tuple[LedgerPanel, ...]


@dataclass(frozen=True)
class Dot:
    """One event of one variant; MPa."""

    kind: str
    inlet_MPa: float
    until_MPa: float | None
    flag: str


@dataclass(frozen=True)
class VariantRow:
    """A line of the dot plot: a variant, what distinguishes it, and its events."""

    label: str
    variant: str
    is_main: bool
    dots: tuple[Dot, ...]
    note: str


@dataclass(frozen=True)
class VariantFigure:
    """The start, arrests and restarts of every variant, experiment by experiment."""

    title: str
    mechanics: str
    blocks: tuple[tuple[str, tuple[VariantRow, ...]], ...]


def energy_terms(run: Run) -> list[str]:
    """Columns of the history that are energies of the ledger, not their sums."""
    names = [name for name in run.history if name.endswith("_J") and name != "J"]
    return [name for name in names if not any(word in name for word in _NOT_A_TERM)]


def family_of(name: str) -> str:
    """Whether a ledger column is supplied, stored or dissipated energy."""
    if any(word in name for word in _SUPPLIED):
        return "supplied"
    return "stored" if any(word in name for word in _STORED) else "dissipated"


def closure_of(run: Run) -> float | None:
    """What the ledger leaves unexplained, as a fraction of its largest energy."""
    energy = run.summary.get("energy") or {}
    for key, value in energy.items():
        if "closure" in key and isinstance(value, (int, float)):
            return float(value)
    terms = energy_terms(run)
    if not terms or not run.drawable:
        return None
    sums = {"supplied": 0.0, "stored": 0.0, "dissipated": 0.0}
    for name in terms:
        sums[family_of(name)] += float(run.history[name][-1])
    scale = max((float(np.nanmax(np.abs(run.history[name]))) for name in terms), default=0.0)
    return (sums["stored"] + sums["dissipated"] - sums["supplied"]) / scale if scale > 0 else None


def ledger_figure(runs: list[Run], mechanics: str) -> LedgerFigure:
    """Energies against inlet pressure for one experiment's main variants in one mechanics."""
    own = [run for run in runs if run.is_main and run.drawable and run.mechanics == mechanics]
    panels = tuple(_ledger_panel(run) for run in own if _has_energies(run))
    if not panels:
        raise NotAvailable("no run of this experiment has energies in its history")
    return LedgerFigure(f"{mechanics_name(mechanics).capitalize()}: {_ledger_title(panels)}", mechanics, panels)


def _has_energies(run: Run) -> bool:
    """Whether any energy of the run is not zero."""
    return any(np.nanmax(np.abs(run.history[name])) > 0.0 for name in energy_terms(run))


def _ledger_panel(run: Run) -> LedgerPanel:
    """One run's energies; works that supply are summed, since those of fluid and in-situ stress nearly cancel."""
    inlet = run.history["inlet_Pa"] / 1e6
    groups: dict[str, list[Term]] = {"supplied": [], "stored": [], "dissipated": []}
    for name in energy_terms(run):
        if np.nanmax(np.abs(run.history[name])) > 0.0:
            family = family_of(name)
            groups[family].append(Term(plain(name.removesuffix("_J")), family, inlet, run.history[name] / 1e3))
    total = {family: sum((term.energy_kJ for term in terms), np.zeros_like(inlet)) for family, terms in groups.items()}
    closure = closure_of(run)
    return LedgerPanel(
        variant=run.variant,
        heading=plain(run.variant) + ("" if closure is None else f": open by {share(abs(closure))}"),
        supplied=Term("net work of fluid, in-situ stress and edges", "supplied", inlet, total["supplied"]),
        stored=tuple(groups["stored"]),
        dissipated=tuple(groups["dissipated"]),
        unexplained=Term("unexplained", "", inlet, total["supplied"] - total["stored"] - total["dissipated"]),
    )


def _ledger_title(panels: tuple[LedgerPanel, ...]) -> str:
    """How much of the net work is stored and dissipated in each variant."""
    parts = []
    for panel in panels:
        given = float(panel.supplied.energy_kJ[-1])
        lost = sum(float(term.energy_kJ[-1]) for term in panel.dissipated)
        if given > 0.0:
            parts.append(f"{share(lost / given)} ({plain(panel.variant)})")
    return f"of the net work supplied, {listed(parts)} is dissipated" if parts else "no net work is supplied"


def variant_figure(groups: list[list[Run]], mechanics: str) -> VariantFigure:
    """Events of every variant of every experiment in one mechanics."""
    blocks = []
    for runs in groups:
        own = [run for run in runs if run.mechanics == mechanics]
        rows = tuple(_variant_row(run, runs) for run in own if run.status != "missing" or run.drawable)
        if rows:
            blocks.append((f"Experiment {runs[0].number}", rows))
    if not blocks:
        raise NotAvailable("there is no run")
    own_groups = [[run for run in runs if run.mechanics == mechanics] for runs in groups]
    title = f"{mechanics_name(mechanics).capitalize()}: {_variant_title(own_groups)}"
    return VariantFigure(title, mechanics, tuple(blocks))


def _variant_row(run: Run, runs: list[Run]) -> VariantRow:
    """One variant's line."""
    label = plain(run.variant)
    if not run.drawable:
        return VariantRow(label, run.variant, run.is_main, (), run.status)
    outcome = outcome_of(run, runs)
    note = "" if run.status == "completed" else run.status
    return VariantRow(label, run.variant, run.is_main, tuple(_dots(outcome)), note)


def _dots(outcome: Outcome) -> list[Dot]:
    """The marks of one variant: start, reach, each arrest with its restart (away from interfaces a pause), end."""
    dots = []
    if outcome.start_Pa is not None:
        dots.append(Dot("start", outcome.start_Pa / 1e6, None, ""))
    if outcome.reached_Pa is not None:
        dots.append(Dot("reach_interface", outcome.reached_Pa / 1e6, None, ""))
    for arrest in outcome.arrests:
        until = outcome.final_inlet_Pa if arrest.until_Pa is None else arrest.until_Pa
        if arrest.interface is None and arrest.until_Pa is not None:
            dots.append(Dot("pause", arrest.from_Pa / 1e6, until / 1e6, ""))
            continue
        flag = flag_of(arrest)
        dots.append(Dot("arrest", arrest.from_Pa / 1e6, until / 1e6, flag))
        if arrest.until_Pa is not None:
            dots.append(Dot("restart", arrest.until_Pa / 1e6, None, flag))
    dots.append(Dot("stop", outcome.final_inlet_Pa / 1e6, None, ""))
    return dots


def _variant_title(groups: list[list[Run]]) -> str:
    """The variant that moves the start of growth most against its nearest main variant."""
    best: tuple[float, Run, Run] | None = None
    for runs in groups:
        for run in runs:
            base = base_of(run, runs)
            if base is None or not (run.drawable and base.drawable):
                continue
            here, there = outcome_of(run).start_Pa, outcome_of(base).start_Pa
            if here is not None and there is not None and (best is None or abs(here - there) > abs(best[0])):
                best = (here - there, run, base)
    if best is None:
        return "no variant beside the study's interface types has started to grow"
    shift, run, base = best
    move = "raises" if shift > 0 else "lowers"
    return (
        f"of all readings of what the study leaves open, '{plain(run.variant)}' in Experiment {run.number} {move}"
        f" the start of growth most: by {mpa(abs(shift))} against '{plain(base.variant)}'"
    )


def base_of(run: Run, runs: list[Run]) -> Run | None:
    """For a variant that is no interface type of the study, the main variant with the fewest other settings."""
    if run.is_main or not run.scene:
        return None
    others = [other for other in runs if other.is_main and other.scene
              and (other.experiment, other.mechanics) == (run.experiment, run.mechanics)]

    def distance(other: Run) -> tuple[int, bool]:
        """How many settings differ, and whether the name differs too."""
        return len(settings_between(run, other)), other.variant not in run.variant

    return min(others, key=distance, default=None)


def differences(run: Run, runs: list[Run]) -> str:
    """In words, the settings by which a variant differs from its nearest main variant."""
    base = base_of(run, runs)
    if base is None:
        return ""
    changed = settings_between(run, base)
    parts = [f"{key} {setting(old)} → {setting(new)}" for key, old, new in changed]
    return f"as {plain(base.variant)} but " + "; ".join(parts) if parts else f"as {plain(base.variant)}"


def spread_of(run: Run) -> float | None:
    """The median spread of J over its rings at growth away from interfaces, as a fraction of its mean."""
    for name in ("J_spread", "J_spread_at_growth"):
        if name in run.history:
            column = run.history[name]
            grown = np.isfinite(column) & (run.history.get("J_N_m", column) > 0.0)
            return float(np.median(column[grown])) if grown.any() else None
    tips = [tip.get("J_spread") for tip in run.summary.get("tips") or []]
    known = [float(value) for value in tips if isinstance(value, (int, float))]
    return max(known) if known else None


def suspicions(run: Run, runs: Sequence[Run] = ()) -> list[str]:
    """What the run itself or its data mark as not to be trusted, in words; J at an interface unless a run confirms it."""
    flags = marks_of(run)
    if run.drawable:
        by_J = [arrest for arrest in outcome_of(run, runs).arrests if flag_of(arrest)]
        if by_J:
            places = list(dict.fromkeys(metres(arrest.height_m) for arrest in by_J))
            flags.append(f"{BY_J} ({listed(places)})")
    if "suspect" in run.summary:
        return flags
    closure = closure_of(run)
    if closure is not None and abs(closure) > 0.01:
        flags.append(f"energy open by {share(abs(closure))}")
    return flags + [f"{words} {number(size)}" for words, size in open_monitors(run)]


def marks_of(run: Run) -> list[str]:
    """Why the run's own monitors mark it as suspect, each with its value; empty for a sound run and for one that has none."""
    marks = run.summary.get("suspect") or []
    return [_mark_words(mark) for mark in marks if isinstance(mark, dict)]


def _mark_words(mark: dict[str, Any]) -> str:
    """One mark of a summary in words: its sentence and, where it has one, its value against the threshold."""
    why, value, threshold = str(mark.get("why") or mark.get("monitor")), mark.get("value"), mark.get("threshold")
    if not isinstance(value, (int, float)) or not isinstance(threshold, (int, float)):
        return why
    return f"{why} ({number(float(value))} against {number(float(threshold))})"


# Monitors of a quasi-static run that are to be next to nothing, with what they are called; for runs that do not judge theirs.
MONITORS: dict[str, str] = {"volume_balance": "fluid volume open by", "contact_residual": "contact open by"}
CLOSED = 1e-8  # what volume and contact are to be satisfied to, relative to the run's own


def open_monitors(run: Run) -> list[tuple[str, float]]:
    """The run's monitors that are not closed."""
    monitors = run.summary.get("monitors") or {}
    found = [(words, monitors.get(key)) for key, words in MONITORS.items()]
    return [(words, abs(float(size))) for words, size in found if isinstance(size, (int, float)) and abs(size) > CLOSED]
