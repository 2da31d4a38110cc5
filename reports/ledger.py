"""Prepares the energy ledger and the dot plot of every variant's events; and what of a run is not to be trusted."""

from collections.abc import Sequence

import numpy as np

from reports.layout import settings_between
from reports.outcome import Outcome, outcome_of
from reports.runs import Arrays, NotAvailable, Run
from reports.shown import Shown
from reports.words import listed, mechanics_name, metres, mpa, plain, setting, share
from verification.harness.claim_data import BY_J

_FAMILIES: dict[str, tuple[str, ...]] = {"supplied": ("work", "supplied"), "stored": ("kinetic", "strain"),
                                         "dissipated": ("",)}  # words in their names
_NOT_A_TERM: tuple[str, ...] = ("supplied", "stored", "dissipated", "total", "residual", "closure", "largest")


def energies_of(run: Run) -> dict[str, Arrays]:
    """Columns of the history that are energies of the ledger (J per metre of thickness), not their sums: supplied, stored and dissipated ones."""
    found: dict[str, Arrays] = {family: {} for family in _FAMILIES}
    for name, column in run.history.items():
        if name.endswith("_J") and name != "J" and not any(word in name for word in _NOT_A_TERM):
            found[next(family for family, words in _FAMILIES.items() if any(word in name for word in words))][name] = column
    return found


def closure_of(run: Run) -> float | None:
    """What the ledger leaves unexplained, as a fraction of its largest energy."""
    value = (run.summary.get("energy") or {}).get("closure")
    return float(value) if isinstance(value, (int, float)) else None


def ledger_figure(runs: list[Run], mechanics: str) -> Shown:
    """Energies against inlet pressure for one experiment's main variants in one mechanics."""
    own = [run for run in runs if run.is_main and run.drawable and run.mechanics == mechanics]
    panels = [panel for run in own if (panel := _ledger_panel(run)) is not None]
    if not panels:
        raise NotAvailable("no run of this experiment has energies in its history")
    parts = []
    for panel in panels:
        given = float(panel.supplied_kJ[-1])
        lost = sum(float(energy[-1]) for energy in panel.energies_kJ["dissipated"].values())
        parts += [f"{share(lost / given)} ({plain(panel.variant)})"] if given > 0.0 else []
    words = f"of the net work supplied, {listed(parts)} is dissipated" if parts else "no net work is supplied"
    return Shown(title=f"{mechanics_name(mechanics).capitalize()}: {words}", mechanics=mechanics, panels=panels,
                 up_to_Pa=1e6 * max(float(panel.inlet_MPa[-1]) for panel in panels))


def _ledger_panel(run: Run) -> Shown | None:
    """One run's energies that are not all zero, in kJ per metre of thickness against inlet pressure in MPa; None where there are none.

    Works that supply are summed, since those of fluid and in-situ stress nearly cancel; what supply, storage and dissipation leave is unexplained.
    """
    inlet = run.history["inlet_Pa"] / 1e6
    energies = {family: {plain(name.removesuffix("_J")): column / 1e3 for name, column in own.items() if np.nanmax(np.abs(column)) > 0.0}
                for family, own in energies_of(run).items()}
    if not any(energies.values()):
        return None
    total = {family: sum(own.values(), np.zeros_like(inlet)) for family, own in energies.items()}
    closure = closure_of(run)
    return Shown(variant=run.variant, heading=plain(run.variant) + ("" if closure is None else f": open by {share(abs(closure))}"), inlet_MPa=inlet,
                 energies_kJ=energies, supplied_kJ=total["supplied"], unexplained_kJ=total["supplied"] - total["stored"] - total["dissipated"])


def variant_figure(groups: list[list[Run]], mechanics: str) -> Shown:
    """Start, arrests and restarts of every variant of every experiment in one mechanics, experiment by experiment."""
    own = [[run for run in runs if run.mechanics == mechanics] for runs in groups]
    blocks = [(f"Experiment {runs[0].number}", rows) for runs in own
              if (rows := [_variant_row(run, runs) for run in runs if run.status != "missing" or run.drawable])]
    if not blocks:
        raise NotAvailable("there is no run")
    return Shown(title=f"{mechanics_name(mechanics).capitalize()}: {_variant_title(own)}", mechanics=mechanics, blocks=blocks)


def _variant_row(run: Run, runs: list[Run]) -> Shown:
    """One variant's line."""
    dots = _dots(outcome_of(run, runs)) if run.drawable else []
    return Shown(label=plain(run.variant), variant=run.variant, dots=dots, note="" if run.drawable and run.status == "completed" else run.status)


def _dots(outcome: Outcome) -> list[Shown]:
    """The marks of one variant: start, reach, each arrest with its restart (away from interfaces a pause), end."""

    def dot(kind: str, inlet_Pa: float, until_Pa: float | None = None, flag: str = "") -> Shown:
        """One event."""
        return Shown(kind=kind, inlet_MPa=inlet_Pa / 1e6, until_MPa=None if until_Pa is None else until_Pa / 1e6, flag=flag)

    dots = [dot(kind, inlet) for kind, inlet in (("start", outcome.start_Pa), ("reach_interface", outcome.reached_Pa)) if inlet is not None]
    for arrest in outcome.arrests:
        until = outcome.final_inlet_Pa if arrest.until_Pa is None else arrest.until_Pa
        if not arrest.tells:
            dots.append(dot("pause", arrest.from_Pa, until))
            continue
        dots.append(dot("arrest", arrest.from_Pa, until, arrest.flag))
        if arrest.until_Pa is not None:
            dots.append(dot("restart", arrest.until_Pa, None, arrest.flag))
    return [*dots, dot("stop", outcome.final_inlet_Pa)]


def _variant_title(groups: list[list[Run]]) -> str:
    """The variant that moves the start of growth most against its nearest main variant."""
    shifts = []
    for runs in groups:
        for run in runs:
            base = base_of(run, runs)
            if base is not None and run.drawable and base.drawable:
                here, there = outcome_of(run).start_Pa, outcome_of(base).start_Pa
                shifts += [(here - there, run, base)] if here is not None and there is not None else []
    if not shifts:
        return "no variant beside the study's interface types has started to grow"
    shift, run, base = max(shifts, key=lambda found: abs(found[0]))
    return (
        f"of all readings of what the study leaves open, '{plain(run.variant)}' in Experiment {run.number} {'raises' if shift > 0 else 'lowers'}"
        f" the start of growth most: by {mpa(abs(shift))} against '{plain(base.variant)}'"
    )


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
