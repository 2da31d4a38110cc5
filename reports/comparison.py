"""What inertia changes: the same variant in both mechanics, number by number."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from reports.figures import words_of
from reports.outcome import Arrest, Outcome, outcome_of
from reports.runs import Run
from reports.shown import Shown
from reports.words import metres, metres_signed, mpa, number, share, signed_mpa, written
from verification.harness.observables import distances_to, path_length, resample
from verification.harness.scenes import MECHANICS

LEAST_STRAIN = 0.01  # of its largest: with less strain energy than that, no ratio to it is taken


class Pair(NamedTuple):
    """A number of a variant without and with inertia, in the same unit; None where a run has none."""

    quasistatic: float | None
    explicit: float | None

    @property
    def difference(self) -> float | None:
        """With less without inertia."""
        return None if self.quasistatic is None or self.explicit is None else self.explicit - self.quasistatic

    def words(self, told: Callable[[float], str], signed: Callable[[float], str] | None = None) -> list[str]:
        """Both, and where asked for their difference."""
        return [*(written(value, told) for value in self), *([signed(self.difference) if self.difference is not None else ""] if signed else [])]


def comparisons(runs: Sequence[Run]) -> list[Shown]:
    """Every variant that can be drawn in both mechanics, in the order of the runs."""
    of = {(run.experiment, run.variant, run.mechanics): run for run in runs if run.drawable}
    names = dict.fromkeys((run.experiment, run.variant) for run in runs)
    pairs = [tuple(of.get((*name, mechanics)) for mechanics in MECHANICS) for name in names]
    return [_comparison(static, moving, runs) for moving, static in pairs if moving is not None and static is not None]


def _comparison(static: Run, moving: Run, runs: Sequence[Run]) -> Shown:
    """One variant without (static) and with inertia: pairs of Pa, m, and the energies' ratio; and the cells of its row."""
    own = [run for run in runs if run.experiment == static.experiment]
    without, with_ = outcome_of(static, own), outcome_of(moving, own)
    stays = [arrest if (arrest := one.longest) is not None and arrest.tells else None for one in (without, with_)]
    from_Pa, height_m, until_Pa = (Pair(*(getattr(arrest, key, None) for arrest in stays)) for key in ("from_Pa", "height_m", "until_Pa"))
    start, kinetic = Pair(without.start_Pa, with_.start_Pa), Pair(kinetic_ratio(static), kinetic_ratio(moving))
    apart, ratio = path_distance(static, moving), G_over_J(static)
    return Shown(
        number=static.number, variant=static.variant, is_main=static.is_main, start_Pa=start, arrest_m=height_m, path_m=apart, kinetic_ratio=kinetic,
        G_over_J=ratio, unlike=_unlike(*stays, without, with_, static.cell_m),
        triples=[start.words(mpa, signed_mpa), from_Pa.words(mpa, signed_mpa), height_m.words(metres, metres_signed),
                 until_Pa.words(mpa, signed_mpa), Pair(without.final_height_m, with_.final_height_m).words(metres, metres_signed)],
        cells=[[written(apart, lambda length: f"{length:.2f}\u00a0m")], kinetic.words(share), [written(ratio, number)]],
    )


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


def kinetic_ratio(run: Run) -> float | None:
    """Largest ratio of kinetic to strain energy, over rows with at least a hundredth of the largest strain energy."""
    if not {"kinetic_J", "strain_J"} <= run.history.keys():
        return None
    kinetic, strain = run.history["kinetic_J"], run.history["strain_J"]
    enough = np.isfinite(kinetic) & np.isfinite(strain) & (strain > LEAST_STRAIN * np.nanmax(np.abs(strain)))
    return float(np.max(kinetic[enough] / strain[enough])) if enough.any() else None


def G_over_J(run: Run) -> float | None:
    """Energy released over an increment by the mean of J over it, the ratio farthest from 1 away from interfaces; None where not known."""
    if not {"G_N_m", "G_by_J_N_m"} <= run.history.keys():
        return None
    released, by_J = run.history["G_N_m"], run.history["G_by_J_N_m"]
    near = run.history.get("near", run.history.get("at_interface", np.zeros_like(by_J)))
    was_near = np.concatenate([near[:1], near[:-1]])  # J at the increment's start came from the row before
    known = np.isfinite(released) & (by_J > 0.0) & (near == 0) & (was_near == 0)
    ratios = released[known] / by_J[known]
    return float(ratios[np.argmax(np.abs(ratios - 1.0))]) if known.any() else None


def inertia_words(rows: Sequence[Shown]) -> str:
    """One sentence on whether inertia mattered, by the study's own variants and all."""
    ratios = {row.kinetic_ratio.explicit: row for row in reversed(rows) if row.kinetic_ratio.explicit is not None}
    if not ratios:
        return words_of("inertia", rows=[])
    known = [row.kinetic_ratio.explicit for row in rows if row.kinetic_ratio.explicit is not None]
    return words_of("inertia", rows=rows, unlike=sum(bool(row.unlike) for row in rows), half=float(np.median(known)), most=max(known),
                    worst=ratios[max(known)])
