"""Refines the mesh of an experiment with the growth increment held fixed, and says what each of its numbers does.

usage: ci/refine exp1 [--cells 2,1,0.5,0.25] [--variants perfect,weak] [--mechanics quasistatic|explicit|both]
                 [--heights 10,20] [--set KEY=VALUE]... [--jobs 2] [--limit MINUTES] [--yes] [--out DIR]

An experiment is the beginning of its name, or a scene file. What has been run for the same scene and solver is not run again.
Writes DIR/EXPERIMENT/refine.json (DIR: runs/refine) and prints it as tables; reports/refinement.py draws it. Where runs that are
still to be made would take longer than --limit (minutes, by an estimate that is printed first), nothing is run without --yes.
"""
from __future__ import annotations

import argparse
import json
import math
import sys
import threading
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from verification.harness import paths
from verification.harness.cost import Cost, cost_of, nearest
from verification.harness.load import LoadError, Run, load
from verification.harness.observables import Measured
from verification.harness.paths import EXPERIMENTS, solver
from verification.harness.quantities import HEIGHTS_M, Quantity, noise_of, path_gap, quantities_of, turns
from verification.harness.richardson import Estimate, estimate, estimate_of_changes
from verification.harness.run import Job, Outcome, done_before, key_of, run
from verification.harness.scenes import MECHANICS, STUDY_VARIANTS, mechanics_of, merged, resolved, scenes_of, variants_of
from verification.harness.side_by_side import Task, side_by_side

REFINE_RUNS = paths.RUNS / "refine"
NAME = "refine.json"
CELLS_M = (2.0, 1.0, 0.5, 0.25)
LIMIT_MIN = 30.0
REFUSED = 2  # exit status of a scene that cannot be run


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


# --- jobs


def scene_of(name: str) -> Path:
    """The scene of an experiment by the beginning of its name, or a scene file; raises ValueError where that is not one."""
    if name.endswith(".toml"):
        if not Path(name).is_file():
            raise ValueError(f"there is no file {name}")
        return Path(name).resolve()
    found = [path for path in scenes_of(EXPERIMENTS) if path.stem.startswith(name)]
    if len(found) != 1:
        names = ", ".join(path.stem for path in (found or scenes_of(EXPERIMENTS)))
        raise ValueError(f"{'several experiments begin' if found else 'no experiment begins'} with {name}: {names}")
    return found[0]


def nested(setting: str) -> dict[str, Any]:
    """A setting key.path=value of the command line as nested tables; a value that is no TOML is a word."""
    key, _, text = setting.partition("=")
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        value = text
    for part in reversed(key.split(".")):
        value = {part: value}
    return value


def content_of(scene: Path, variant: str, settings: Sequence[str]) -> dict[str, Any]:
    """The keys of a scene with those of a variant and of settings in place."""
    content = resolved(scene, variant)
    for setting in settings:
        content = merged(content, nested(setting))
    return content


def increment_of(content: dict[str, Any]) -> float:
    """Growth increment of a scene, m; the solver's default is 1 m."""
    return float(content["fracture"].get("increment_m", 1.0))


def job_of(scene: Path, mechanics: str, variant: str, cell_m: float, settings: Sequence[str] = (), root: Path = REFINE_RUNS) -> Job:
    """The run at a cell size (m), the increment fixed to what scene, variant and settings say.

    Its grid is uniform unless settings say otherwise: with its cells the fine part of a graded one would shrink, too.
    """
    content = content_of(scene, variant, settings)
    own = [f"numerics.mechanics={mechanics}", f"numerics.cell_m={cell_m!r}", f"fracture.increment_m={increment_of(content)!r}", *settings]
    if "far_cell_m" in content["numerics"] and not any(setting.startswith("numerics.far_cell_m=") for setting in settings):
        own.append(f"numerics.far_cell_m={cell_m!r}")
    return Job(scene, variant, root / scene.stem / mechanics / variant / f"{cell_m:g}m", tuple(own))


def cost_to_make(job: Job) -> Cost:
    """What a job will cost: as in a run of the same variant where there is one."""
    content = content_of(job.scene, job.variant, job.settings)
    mechanics, cell = str(content["numerics"]["mechanics"]), float(content["numerics"]["cell_m"])
    beside = [*job.out.parent.glob("*/"), paths.RUNS / mechanics / job.scene.stem / job.variant]
    return cost_of(content, mechanics, *(nearest(beside, cell) or ()))


def expected_s(job: Job) -> float:
    """How long a job will take, s; nothing where it is done."""
    return 0.0 if done_before(job, key_of(job, solver())) is not None else cost_to_make(job).seconds


def cost_lines(jobs: Sequence[Job]) -> tuple[list[str], float]:
    """What the jobs that are still to be made will cost, in words a job, and in seconds on one thread together."""
    lines, total, binary = [], 0.0, solver()
    for job in jobs:
        if done_before(job, key_of(job, binary)) is not None:
            continue
        cost = cost_to_make(job)
        total += cost.seconds
        basis = "as in a run of this variant" if cost.measured else "by experience"
        lines.append(f"  {job.out.relative_to(job.out.parents[2])}: {cost.particles:.3g} particles x {cost.steps:.3g} steps:"
                     f" {cost.seconds:.0f} s ({basis})")  # fmt: skip
    return lines, total


def make(job: Job, stop: threading.Event | None = None) -> tuple[Outcome, Run | None]:
    """Run a job and read what it wrote; a run that failed is read as far as it came, one that was refused is not."""
    outcome = run(job, stop=stop)
    if outcome.exit_status == REFUSED:
        return outcome, None
    try:
        return outcome, load(job.out)
    except LoadError:
        return outcome, None


def made_words(made: tuple[Outcome, Run | None]) -> str:
    """How a run ended, in words."""
    outcome = made[0]
    how = "done before" if outcome.skipped else f"{outcome.wall_s:.0f} s"
    return f"{outcome.status} ({how}) {outcome.reason[:160]}".rstrip()


def make_all(jobs: Sequence[Job], at_a_time: int) -> list[tuple[Outcome, Run | None]]:
    """Make all jobs, so many at a time, each on one thread, with a line for each."""
    tasks = [Task(str(job.out.relative_to(job.out.parents[2])), partial(make, job), made_words, expected_s(job)) for job in jobs]
    return side_by_side(tasks, at_a_time)


# --- what the runs say


def shown(quantity: Quantity, level: Level) -> tuple[float | None, str]:
    """A quantity of one run, or None with the reason."""
    if level.run is None:
        return None, f"{level.cell_m:g} m: {'refused' if level.outcome.exit_status == REFUSED else 'failed'}"
    if not level.outcome.ok and quantity.name.startswith(("final", "deflection")):
        return None, f"{level.cell_m:g} m: the run failed"
    found: Measured = quantity.measure(level.run)
    if found.exact:
        return found.low, f"{level.cell_m:g} m: {', '.join(found.flags)}" if found.flags else ""
    bound = f", at least {found.low:.6g} {quantity.unit}" if math.isfinite(found.low) else ""
    return None, f"{level.cell_m:g} m: {found.note.removeprefix(level.run.name).strip()}{bound}"


def row_of(quantity: Quantity, levels: Sequence[Level]) -> Row:
    """One quantity over all sizes; the sizes without a value are left out of the order."""
    pairs = [shown(quantity, level) for level in levels]
    values = tuple(value for value, _ in pairs)
    known = [(level, value) for level, value in zip(levels, values) if value is not None]
    noise = max((noise_of(quantity, level.run, value) for level, value in known if level.run), default=0.0)
    said = estimate([level.cell_m for level, _ in known], [value for _, value in known], noise, quantity.unit)
    return Row(quantity.name, quantity.label, quantity.unit, values, tuple(note for _, note in pairs if note), noise, said)


def path_rows(levels: Sequence[Level]) -> list[Row]:
    """Distance of each path to the finest, and to the next finer: whose fall is the order of the path."""
    known = [level for level in levels if level.run is not None]
    if len(known) < 2:
        return []
    runs = [level.run for level in known if level.run is not None]
    common = min(float(sum_length(one)) for one in runs)

    def distances(against: Sequence[Run]) -> list[float] | None:
        found = [path_gap(one, other, common) for one, other in zip(runs, against)]
        return None if any(gap is None for gap in found) else [gap[0] for gap in found if gap is not None]

    to_finest, to_next = distances(runs[-1:] * (len(runs) - 1)), distances(runs[1:])
    if to_finest is None or to_next is None:
        return []
    sizes = [level.cell_m for level in known]
    said = estimate_of_changes(sizes, to_next, 1e-6, "m")
    places = [next((k for k, one in enumerate(known) if one is level), None) for level in levels]

    def spread_out(values: Sequence[float]) -> tuple[float | None, ...]:
        return tuple(values[k] if k is not None and k < len(values) else None for k in places)

    note = (f"root mean square over the first {common:.1f} m",)
    plain = Estimate("beside", "beside the finest: no order is taken from it")
    return [
        Row("path_to_finest_m", "path: distance to the finest", "m", spread_out([*to_finest, 0.0]), note, 1e-6, plain),
        Row("path_to_next_m", "path: distance to the next finer", "m", spread_out(to_next), note, 1e-6, said),
    ]


def sum_length(run: Run) -> float:
    """Length of a run's path, m."""
    return float(sum(math.dist(a, b) for a, b in zip(run.path[:-1], run.path[1:])))


def arrests_nowhere(row: Row) -> bool:
    """Whether a quantity of an arrest has no arrest behind it at any size."""
    flagged = sum(note.endswith("no arrest") for note in row.notes)
    return flagged > 0 and flagged == sum(value is not None for value in row.values)


def study_of(
    scene: Path, mechanics: str, variant: str, levels: Sequence[Level], settings: Sequence[str] = (), heights_m: Sequence[float] = HEIGHTS_M
) -> Study:
    """What the runs of one variant in one mechanics say."""
    content = content_of(scene, variant, settings)
    rows = [row_of(quantity, levels) for quantity in quantities_of(content, heights_m)]
    rows = [row for row in rows if not arrests_nowhere(row)]
    nowhere = [row.label for row in rows if all(value is None for value in row.values)]
    rows = [row for row in rows if row.label not in nowhere]
    if turns(content):
        rows += path_rows(levels)
    notes = unlike(content, [level.cell_m for level in levels])
    if nowhere:
        notes += (f"{variant or 'base'}: at no size is there a {', '.join(nowhere)}",)
    return Study(mechanics, variant, increment_of(content), tuple(levels), tuple(rows), notes)


def unlike(content: dict[str, Any], cells_m: Sequence[float]) -> tuple[str, ...]:
    """Where the first tip or an interface lies in its cell otherwise than at the finest size: such sizes are of another family.

    The solver's error depends on that place, so that values at these sizes and at the others need not lie on one line.
    """
    path, strata = content["fracture"]["path_m"], content["strata"]
    axis = "x" if strata.get("along", "y") == "x" else "y"
    thickness = [float(layer["thickness_m"]) for layer in strata["layers"][:-1]]
    places = {"the first tip": ("y", max(float(y) for _, y in path)), "the fracture": ("x", float(path[0][0]))}
    for k in range(len(thickness)):
        name = "the interface" if len(thickness) == 1 else f"interface {k + 1}"
        places[name] = (axis, sum(thickness[: k + 1]))

    def within(place_m: float, cell_m: float) -> float:
        return round(place_m / cell_m % 1.0, 6) % 1.0

    def words(share: float) -> str:
        return {0.0: "on a grid line", 0.5: "at mid-cell"}.get(share, f"at {share:g} of a cell")

    notes, finest = [], min(cells_m)
    for name, (along, place) in places.items():
        for cell in cells_m:
            if within(place, cell) != within(place, finest):
                there, here = words(within(place, cell)), words(within(place, finest))
                notes.append(f"at {cell:g} m {name} ({along} = {place:g} m) lies {there}, at {finest:g} m {here}")
    return tuple(notes)


# --- what is written


def as_json(scene: Path, settings: Sequence[str], studies: Sequence[Study]) -> dict[str, Any]:
    """The whole as plain data."""
    versions = sorted({level.run.summary.version for study in studies for level in study.levels if level.run})
    return {
        "experiment": scene.stem,
        "settings": list(settings),
        "versions": versions,
        "studies": [
            {
                "mechanics": study.mechanics,
                "variant": study.variant,
                "increment_m": study.increment_m,
                "levels": [_level_json(level) for level in study.levels],
                "notes": list(study.notes),
                "rows": [asdict(row) for row in study.rows],
            }
            for study in studies
        ],
    }


def _level_json(level: Level) -> dict[str, Any]:
    """How one run ended and what it cost."""
    status = "refused" if level.outcome.exit_status == REFUSED else level.outcome.status
    found: dict[str, Any] = {"cell_m": level.cell_m, "status": status, "reason": level.outcome.reason}
    if level.run is not None:
        summary = level.run.summary
        found |= {"particles": summary.particles, "steps": summary.steps, "wall_s": summary.wall_s, "run": str(level.run.folder)}
    return found


def value_words(value: float | None, unit: str) -> str:
    """A value in the unit of the tables: pressures in MPa."""
    if value is None:
        return "-"
    return f"{value / 1e6:.5f}" if unit == "Pa" else f"{value:.4g}"


def estimate_words(row: Row) -> str:
    """What refinement says of a row, with the extrapolate where there is one."""
    said, unit = row.estimate, "MPa" if row.unit == "Pa" else row.unit
    if said.kind != "clean":
        return said.says
    factor = 1e-6 if row.unit == "Pa" else 1.0
    uncertainty = f"+- {factor * (said.uncertainty or 0.0):.2g} {unit}"
    if said.extrapolate is None:
        return f"{said.says}; the finest is within {uncertainty.removeprefix('+- ')} of the limit"
    return f"{value_words(said.extrapolate, row.unit)} {uncertainty} ({said.says})"


def table(study: Study) -> str:
    """One study as a table in text."""
    head = [f"{level.cell_m:g} m" for level in study.levels]
    lines = [f"\n{study.mechanics} {study.variant}, increment {study.increment_m:g} m"]
    lines += [f"  {level.cell_m:g} m {_level_json(level)['status']}: {level.outcome.reason}" for level in study.levels if not level.outcome.ok]
    lines.append(f"  {'':38}" + "".join(f"{name:>11}" for name in head) + "   limit h -> 0, or why there is none")
    lines += [f"  {note}" for note in study.notes]
    for row in study.rows:
        label = f"{row.label} ({'MPa' if row.unit == 'Pa' else row.unit})"
        lines.append(f"  {label:38}" + "".join(f"{value_words(value, row.unit):>11}" for value in row.values) + f"   {estimate_words(row)}")
        lines += [f"  {'':38}  {note}" for note in row.notes if "root mean square" not in note]
    return "\n".join(lines)


def parse(arguments: list[str] | None) -> tuple[argparse.ArgumentParser, argparse.Namespace]:
    """The command line."""
    parser = argparse.ArgumentParser(prog="ci/refine", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiment", help="the beginning of its name, or a scene file")
    parser.add_argument("--cells", default=",".join(f"{cell:g}" for cell in CELLS_M), help="cell sizes in m")
    parser.add_argument("--variants", default="", help="names, comma-separated (default: the interface types of the study)")
    parser.add_argument("--mechanics", default="quasistatic", choices=(*MECHANICS, "both"))
    parser.add_argument("--heights", default="", help="heights in m at which the pressure is followed")
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE", help="a scene key")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    parser.add_argument("--limit", type=float, default=LIMIT_MIN, help="minutes above which --yes is asked for")
    parser.add_argument("--yes", action="store_true", help="run whatever it costs")
    parser.add_argument("--out", type=Path, default=REFINE_RUNS)
    return parser, parser.parse_args(arguments)


def numbers(text: str, what: str) -> list[float]:
    """Positive numbers separated by commas; raises ValueError for others."""
    try:
        found = [float(part) for part in text.split(",") if part]
    except ValueError as error:
        raise ValueError(f"--{what} {text}: {error}") from error
    if any(not (math.isfinite(one) and one > 0.0) for one in found):
        raise ValueError(f"--{what} {text}: sizes are positive")
    return found


def chosen(scene: Path, names: str) -> list[str]:
    """The variants to run: those named, or the study's own, or the base scene; raises ValueError for unknown names."""
    known = variants_of(scene)
    wanted = [name for name in names.split(",") if name] or [name for name in known if name in STUDY_VARIANTS] or [""]
    unknown = [name for name in wanted if name and name not in known]
    if unknown:
        raise ValueError(f"{scene.stem} has no variant {', '.join(unknown)}; there are {', '.join(known)}")
    return wanted


def affordable(jobs: Sequence[Job], options: argparse.Namespace) -> bool:
    """Print what the jobs will cost; whether they may be made."""
    lines, seconds = cost_lines(jobs)
    minutes = seconds / 60.0 / max(options.jobs, 1)
    if lines:
        print("\n".join([f"{len(lines)} of {len(jobs)} runs to make, by estimate:", *lines]))
        print(f"  together about {minutes:.1f} min with {options.jobs} at a time", flush=True)
    if minutes <= options.limit or options.yes:
        return True
    print(f"above the limit of {options.limit:g} min: give --yes, a larger --limit, fewer variants or coarser cells", file=sys.stderr)
    return False


def main(arguments: list[str] | None = None) -> int:
    """The study from the command line; 0 where all runs completed, 3 where some did not, 2 for bad input."""
    parser, options = parse(arguments)
    try:
        scene, cells = scene_of(options.experiment), sorted(set(numbers(options.cells, "cells")), reverse=True)
        variants, heights = chosen(scene, options.variants), numbers(options.heights, "heights") or list(HEIGHTS_M)
    except ValueError as error:
        parser.error(str(error))
    if not solver().is_file():
        parser.error(f"there is no solver at {solver()}: build it first (ci/reproduce and ci/test do)")
    mechanics = MECHANICS if options.mechanics == "both" else (options.mechanics,)
    cases = [(one, variant) for one in mechanics for variant in variants if one in mechanics_of(scene, variant)]
    jobs = [job_of(scene, *case, cell, options.settings, options.out.resolve()) for case in cases for cell in cells]
    if not jobs:
        parser.error(f"none of {', '.join(variants)} runs in {options.mechanics}")
    if not affordable(jobs, options):
        return 2
    made = make_all(jobs, options.jobs)
    studies = []
    for k, (one, variant) in enumerate(cases):
        own = [Level(cell, *found) for cell, found in zip(cells, made[k * len(cells) : (k + 1) * len(cells)])]
        studies.append(study_of(scene, one, variant, own, options.settings, heights))
        print(table(studies[-1]))
    target = options.out / scene.stem / NAME
    target.write_text(json.dumps(as_json(scene, options.settings, studies), indent=1) + "\n", encoding="utf-8")
    print(f"\nwritten: {target}")
    return 0 if all(outcome.ok for outcome, _ in made) else 3


if __name__ == "__main__":
    sys.exit(main())
