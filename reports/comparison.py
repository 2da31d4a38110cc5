"""What inertia changes: the same variant in both mechanics."""

from collections.abc import Sequence

import numpy as np

from reports.figures import words_of
from reports.outcome import Arrest, Outcome, outcome_of
from reports.runs import Run
from reports.words import Shown
from verification.harness.observables import distances_to, path_length, resample
from verification.harness.scenes import MECHANICS

LEAST_STRAIN = 0.01  # of its largest: with less strain energy than that, no ratio to it is taken


def comparisons(runs: Sequence[Run]) -> list[Shown]:
    """Every variant that can be drawn in both mechanics, in the order of the runs: in what they are unlike, and the largest ratio of kinetic to strain energy."""
    of = {(run.experiment, run.variant, run.mechanics): run for run in runs if run.drawable}
    pairs = [[of.get((*name, mechanics)) for mechanics in MECHANICS] for name in dict.fromkeys((run.experiment, run.variant) for run in runs)]
    return [_comparison(static, moving, runs) for moving, static in pairs if moving is not None and static is not None]


def _comparison(static: Run, moving: Run, runs: Sequence[Run]) -> Shown:
    """One variant without (static) and with inertia."""
    own = [run for run in runs if run.experiment == static.experiment]
    without, with_ = outcome_of(static, own), outcome_of(moving, own)
    stays = [arrest if (arrest := one.longest) is not None and arrest.tells else None for one in (without, with_)]
    return Shown(number=static.number, variant=static.variant, kinetic_ratio=kinetic_ratio(moving), unlike=_unlike(*stays, without, with_, static.cell_m))


def _unlike(first: Arrest | None, other: Arrest | None, without: Outcome, with_: Outcome, cell_m: float) -> tuple[str, ...]:
    """In what the two do not do the same thing."""
    found = []
    if (first is None) != (other is None):
        found.append(f"arrested only {'without' if other is None else 'with'} inertia")
    elif first is not None and other is not None and abs(first.height_m - other.height_m) > 1.5 * cell_m:
        found.append("arrested elsewhere")
    elif first is not None and other is not None and (first.until_Pa is None) != (other.until_Pa is None):
        found.append(f"driven on only {'with' if first.until_Pa is None else 'without'} inertia")
    if abs(without.final_height_m - with_.final_height_m) > 1.5 * cell_m:
        found.append("ends at another height")
    return tuple(found)


def path_distance(run: Run, other: Run) -> float | None:
    """Root mean square distance between two paths over the length both have, m; None where one has not grown."""
    paths = (run.path_m, other.path_m)
    if any(len(path) < 3 for path in paths):
        return None
    common = min(path_length(path) for path in paths)
    points = resample(paths[0], 0.25)[: int(common / 0.25) + 1]
    return float(np.sqrt(np.mean(distances_to(points, paths[1]) ** 2)))


def shift_Pa(run: Run, other: Run) -> float:
    """Largest distance between the inlet pressures of two runs at which the tip first comes to whole metres that both reach, Pa."""
    tops = [float(np.max(one.history["height_m"])) for one in (run, other)]
    foot = max(float(one.history["height_m"][0]) for one in (run, other))
    heights = np.arange(np.floor(foot) + 1.0, min(tops) + 1e-6) - 0.05  # so near counts as there
    if heights.size == 0:
        return 0.0
    first, second = (one.history["inlet_Pa"][np.searchsorted(np.maximum.accumulate(one.history["height_m"]), heights)] for one in (run, other))
    return float(np.max(np.abs(first - second)))


def kinetic_ratio(run: Run) -> float | None:
    """Largest ratio of kinetic to strain energy, over rows with at least a hundredth of the largest strain energy."""
    if not {"kinetic_J", "strain_J"} <= run.history.keys():
        return None
    kinetic, strain = run.history["kinetic_J"], run.history["strain_J"]
    enough = np.isfinite(kinetic) & np.isfinite(strain) & (strain > LEAST_STRAIN * np.nanmax(np.abs(strain)))
    return float(np.max(kinetic[enough] / strain[enough])) if enough.any() else None


def inertia_words(rows: Sequence[Shown]) -> str:
    """Whether inertia mattered, in a sentence or two; nothing where no variant was run in both mechanics."""
    known = [row for row in rows if row.kinetic_ratio is not None]
    if not known:
        return ""
    worst = max(known, key=lambda row: row.kinetic_ratio)
    return words_of("inertia", rows=rows, unlike=[row for row in rows if row.unlike], half=float(np.median([row.kinetic_ratio for row in known])), worst=worst)
