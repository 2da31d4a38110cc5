"""Refines the mesh of an experiment with the growth increment held fixed, and says what each of its numbers does.

usage: ci/refine exp1 [--cells 2,1,0.5,0.25] [--variants perfect,weak] [--mechanics quasistatic|explicit|both]
                 [--heights 10,20] [--set KEY=VALUE]... [--jobs 2] [--limit MINUTES] [--yes] [--out DIR]

An experiment is the beginning of its name, or a scene file. What has been run for the same scene and solver is not run again.
Writes DIR/EXPERIMENT/refine.json (DIR: runs/refine) and prints it as tables. Where runs that are
still to be made would take longer than --limit (minutes, by an estimate that is printed first), nothing is run without --yes.
"""

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path
from typing import Any

from verification.harness import paths, store
from verification.harness.command import command, ends_for_bad_input
from verification.harness.load import Run
from verification.harness.observables import path_length
from verification.harness.paths import need_solver
from verification.harness.quantities import (
    HEIGHTS_M, NO_ARREST, Quantity, lack_words, lowest_end_m, noise_of, path_gap, quantities_of, turns,
)  # fmt: skip
from verification.harness.richardson import Estimate, estimate, estimate_of_changes
from verification.harness.run import Job, Outcome, affordable, make_all
from verification.harness.scenes import MECHANICS, chosen, content_of, mechanics_of, scene_of

REFINE_RUNS = paths.RUNS / "refine"
CELLS_M = (2.0, 1.0, 0.5, 0.25)


@dataclass(frozen=True)
class Level:
    """One run of a study: cell size (m), how it ended, and its data where it has any."""

    cell_m: float
    outcome: Outcome
    run: Run | None


@dataclass(frozen=True)
class Row:
    """One quantity over all sizes: the values (None where there is none, with a note why) and what they say of refinement."""

    name: str
    label: str
    unit: str
    values: tuple[float | None, ...]
    notes: tuple[str, ...]
    noise: float
    estimate: Estimate


@dataclass(frozen=True)
class Study:
    """A variant in one mechanics at all cell sizes (m, coarse to fine)."""

    mechanics: str
    variant: str
    increment_m: float
    levels: tuple[Level, ...]
    rows: tuple[Row, ...]
    notes: tuple[str, ...] = ()


def job_of(scene: Path, mechanics: str, variant: str, cell_m: float, settings: Sequence[str] = (), root: Path = REFINE_RUNS) -> Job:
    """The run at a cell size (m), the increment fixed to what scene, variant and settings say. Its grid is uniform unless settings say otherwise:
    with its cells the fine part of a graded one would shrink, too."""
    content = content_of(scene, variant, (f"numerics.mechanics={mechanics}", *settings))
    own = [f"numerics.mechanics={mechanics}", f"numerics.cell_m={cell_m!r}", f"fracture.increment_m={content['fracture']['increment_m']!r}", *settings]
    if "far_cell_m" in content["numerics"] and not any(setting.startswith("numerics.far_cell_m=") for setting in settings):
        own.append(f"numerics.far_cell_m={cell_m!r}")
    return Job(scene, variant, root / scene.stem / mechanics / variant / f"{cell_m:g}m", tuple(own))


def shown(quantity: Quantity, level: Level) -> tuple[float | None, str]:
    """A quantity of one run, or None with the reason."""
    if level.run is None or not level.outcome.ok and quantity.name.startswith(("final", "deflection")):
        return None, f"{level.cell_m:g} m: {level.outcome.word if level.run is None else 'the run failed'}"
    found = quantity.measure(level.run)
    if not found.exact:
        return None, f"{level.cell_m:g} m: {lack_words(found, level.run, quantity.unit)}"
    return found.low, f"{level.cell_m:g} m: {', '.join(found.flags)}" if found.flags else ""


def row_of(quantity: Quantity, levels: Sequence[Level]) -> Row:
    """One quantity over all sizes; the sizes without a value are left out of the order."""
    values, notes = zip(*(shown(quantity, level) for level in levels))
    known = [(level, value) for level, value in zip(levels, values) if value is not None]
    noise = max((noise_of(quantity, level.run, value) for level, value in known if level.run), default=0.0)
    said = estimate([level.cell_m for level, _ in known], [value for _, value in known], noise, quantity.unit)
    return Row(quantity.name, quantity.label, quantity.unit, values, tuple(filter(None, notes)), noise, said)


def path_rows(levels: Sequence[Level]) -> list[Row]:
    """Distance of each path to the finest, and to the next finer: whose fall is the order of the path."""
    known = [(level, level.run) for level in levels if level.run is not None]
    if len(known) < 2:
        return []
    runs = [run for _, run in known]
    common = min(path_length(run.path) for run in runs)
    gaps = [[path_gap(one, other, common) for one, other in zip(runs, against)] for against in (runs[-1:] * (len(runs) - 1), runs[1:])]
    if any(gap is None for both in gaps for gap in both):
        return []
    to_finest, to_next = ([gap[0] for gap in both if gap is not None] for both in gaps)

    def row(name: str, label: str, values: Sequence[float], said: Estimate) -> Row:
        at = dict(zip((level.cell_m for level, _ in known), values))
        note = (f"root mean square over the first {common:.1f} m",)
        return Row(name, f"path: distance to the {label}", "m", tuple(at.get(level.cell_m) for level in levels), note, 1e-6, said)

    plain = Estimate("beside", "beside the finest: no order is taken from it")
    said = estimate_of_changes([level.cell_m for level, _ in known], to_next, 1e-6, "m")
    return [row("path_to_finest_m", "finest", [*to_finest, 0.0], plain), row("path_to_next_m", "next finer", to_next, said)]


def study_of(
    scene: Path, mechanics: str, variant: str, levels: Sequence[Level], settings: Sequence[str] = (), heights_m: Sequence[float] = HEIGHTS_M
) -> Study:
    """What the runs of one variant in one mechanics say."""
    content = content_of(scene, variant, (f"numerics.mechanics={mechanics}", *settings))
    rows = []
    for row in (row_of(quantity, levels) for quantity in quantities_of(content, heights_m)):
        without_arrest = sum(note.endswith(NO_ARREST) for note in row.notes)
        if not without_arrest or without_arrest < sum(value is not None for value in row.values):
            rows.append(row)
    nowhere = [row.label for row in rows if all(value is None for value in row.values)]
    rows = [row for row in rows if row.label not in nowhere] + (path_rows(levels) if turns(content) else [])
    notes = unlike(content, [level.cell_m for level in levels])
    if nowhere:
        notes += (f"{variant or 'base'}: nothing to follow at any size: {', '.join(nowhere)}",)
    return Study(mechanics, variant, content["fracture"]["increment_m"], tuple(levels), tuple(rows), notes)


def unlike(content: dict[str, Any], cells_m: Sequence[float]) -> tuple[str, ...]:
    """Where the first tip or an interface lies in its cell otherwise than at the finest size: such sizes are of another family. The solver's error
    depends on that place, so that values at these sizes and at the others need not lie on one line."""
    path, strata = content["fracture"]["path_m"], content["strata"]
    axis = "x" if strata.get("along", "y") == "x" else "y"
    thickness = [float(layer["thickness_m"]) for layer in strata["layers"][:-1]]
    names = ["the interface"] if len(thickness) == 1 else [f"interface {k + 1}" for k in range(len(thickness))]
    places = {"the first tip": ("y", max(float(y) for _, y in path)), "the fracture": ("x", float(path[0][0]))}
    if (foot := lowest_end_m(content)) is not None:
        places["the lower tip"] = ("y", foot)
    places |= {name: (axis, place) for name, place in zip(names, accumulate(thickness))}

    def words(place_m: float, cell_m: float) -> str:
        share = round(place_m / cell_m % 1.0, 6) % 1.0
        return {0.0: "on a grid line", 0.5: "at mid-cell"}.get(share, f"at {share:g} of a cell")

    finest = min(cells_m)
    return tuple(
        f"at {cell:g} m {name} ({along} = {place:g} m) lies {words(place, cell)}, at {finest:g} m {words(place, finest)}"
        for name, (along, place) in places.items() for cell in cells_m if words(place, cell) != words(place, finest)
    )  # fmt: skip


def marks_of(level: Level) -> list[str]:
    """The monitors that mark the run of a size."""
    return [mark.monitor for mark in level.run.suspect] if level.run else []


def as_json(scene: Path, settings: Sequence[str], studies: Sequence[Study]) -> dict[str, Any]:
    """The whole as plain data: of each level how its run ended and what it cost."""

    def plain(level: Level) -> dict[str, Any]:
        found = {"cell_m": level.cell_m, "status": level.outcome.word, "reason": level.outcome.reason}
        cost = {name: getattr(level.run.summary, name) for name in ("particles", "steps", "wall_s")} if level.run else {}
        return found | cost | ({"suspect": marks_of(level), "run": str(level.run.folder)} if level.run else {})

    versions = sorted({level.run.summary.version for study in studies for level in study.levels if level.run})
    all_plain = [store.plain(replace(study, levels=())) | {"levels": [plain(level) for level in study.levels]} for study in studies]
    return {"experiment": scene.stem, "settings": list(settings), "versions": versions, "studies": all_plain}


def value_words(value: float | None, unit: str) -> str:
    """A value in the unit of the tables: pressures in MPa."""
    return "-" if value is None else f"{value / 1e6:.5f}" if unit == "Pa" else f"{value:.4g}"


def estimate_words(row: Row) -> str:
    """What refinement says of a row, with the extrapolate where there is one."""
    said, (factor, unit) = row.estimate, (1e-6, "MPa") if row.unit == "Pa" else (1.0, row.unit)
    uncertainty = f"{factor * (said.uncertainty or 0.0):.2g} {unit}"
    if said.extrapolate is not None:
        return f"{value_words(said.extrapolate, row.unit)} +- {uncertainty} ({said.says})"
    return said.says if said.kind != "clean" else f"{said.says}; the finest is within {uncertainty} of the limit"


def table(study: Study) -> str:
    """One study as a table in text."""
    lines = [f"\n{study.mechanics} {study.variant}, increment {study.increment_m:g} m"]
    lines += [f"  {level.cell_m:g} m {level.outcome.word}: {level.outcome.reason}" for level in study.levels if not level.outcome.ok]
    lines += [f"  {level.cell_m:g} m is suspect: {', '.join(marks_of(level))}" for level in study.levels if marks_of(level)]
    lines.append(f"  {'':38}" + "".join(f"{f'{level.cell_m:g} m':>11}" for level in study.levels) + "   limit h -> 0, or why there is none")
    lines += [f"  {note}" for note in study.notes]
    for row in study.rows:
        label = f"{row.label} ({'MPa' if row.unit == 'Pa' else row.unit})"
        lines.append(f"  {label:38}" + "".join(f"{value_words(value, row.unit):>11}" for value in row.values) + f"   {estimate_words(row)}")
        lines += [f"  {'':38}  {note}" for note in row.notes if "root mean square" not in note]
    return "\n".join(lines)


def numbers(text: str, what: str) -> list[float]:
    """Positive numbers separated by commas; raises ValueError for others."""
    try:
        found = [float(part) for part in text.split(",") if part]
    except ValueError as error:
        raise ValueError(f"--{what} {text}: {error}") from error
    if any(not (math.isfinite(one) and one > 0.0) for one in found):
        raise ValueError(f"--{what} {text}: sizes are positive")
    return found


def main(arguments: list[str] | None = None) -> int:
    """The study from the command line; 0 where all runs completed, 3 where some did not, 2 for bad input."""
    parser = command("ci/refine", __doc__, "variants", "mechanics", "set", "jobs", "limit", "yes", "out", mechanics="quasistatic", out=REFINE_RUNS)
    parser.add_argument("experiment", help="the beginning of its name, or a scene file")
    parser.add_argument("--cells", default=",".join(f"{cell:g}" for cell in CELLS_M), help="cell sizes in m")
    parser.add_argument("--heights", default="", help="heights in m at which the pressure is followed")
    options = parser.parse_args(arguments)
    with ends_for_bad_input(parser):
        scene, cells = scene_of(options.experiment), sorted(set(numbers(options.cells, "cells")), reverse=True)
        variants, heights = chosen(scene, options.variants), numbers(options.heights, "heights") or list(HEIGHTS_M)
        need_solver()
        mechanics = MECHANICS if options.mechanics == "both" else (options.mechanics,)
        cases = [(one, variant) for one in mechanics for variant in variants if one in mechanics_of(scene, variant)]
        if not cases:
            raise ValueError(f"none of {', '.join(variants)} runs in {options.mechanics}")
        jobs = [job_of(scene, *case, cell, options.settings, options.out.resolve()) for case in cases for cell in cells]
    if not affordable(jobs, options):
        return 2
    made = make_all(jobs, options.jobs)
    studies = []
    for k, (one, variant) in enumerate(cases):
        own = [Level(cell, *found) for cell, found in zip(cells, made[k * len(cells) : (k + 1) * len(cells)])]
        studies.append(study_of(scene, one, variant, own, options.settings, heights))
        print(table(studies[-1]))
    target = store.write(as_json(scene, options.settings, studies), options.out / scene.stem / "refine.json")
    print(f"\nwritten: {target}")
    return 0 if all(outcome.ok for outcome, _ in made) else 3


if __name__ == "__main__":
    sys.exit(main())
