"""The six experiments at smoke size in each mechanics, and the values of them that the regression keeps.

usage: ci/accept [--only exp1] [--mechanics explicit|quasistatic|both] [--dry-run]

Rewrites experiments/expected/MECHANICS/*.json from runs at smoke size, and prints what differs from what was expected so far.
"""

import json
import os
import sys
import threading
from functools import partial
from pathlib import Path
from typing import Any

from verification.harness import store
from verification.harness.command import command
from verification.harness.load import Run
from verification.harness.observables import path_length, resample
from verification.harness.paths import EXPERIMENTS, RUNS
from verification.harness.run import Job, Task, make, side_by_side
from verification.harness.scenes import MECHANICS, mechanics_of

EXPECTED = EXPERIMENTS / "expected"
SMOKE_RUNS = RUNS / "smoke"

# Cells and increments of 2 m: an eighth of the work of the 1 m runs, in the same block with the same events.
SETTINGS = ("numerics.cell_m=2.0", "fracture.increment_m=2.0")

# What of each experiment is run: the perfect case and one with an interface that acts.
VARIANTS: dict[str, tuple[str, ...]] = {
    "exp1_single_interface": ("perfect", "weak"),
    "exp2_soft_above": ("perfect", "soft"),
    "exp3_two_interfaces": ("weak_soft",),
    "exp4_soft_between": ("friction",),
    "exp5_parallel_interface": ("perfect", "soft"),
    "exp6_stress_reversal": ("perfect", "weak"),
}

# Results are the same to the last digit on one machine; another compiler or processor may round differently, and a growth event then
# falls into another step. Pressures: with inertia the rise over three crossings of the block by a P wave; without, where the solver
# looks for the pressure of an event, a quarter of that. Lengths: half an increment.
PRESSURE_TOLERANCE_PA = {"explicit": 4.0e4, "quasistatic": 1.0e4}
LENGTH_TOLERANCE_M = 1.0

# 0.05 MPa of rise make an arrest; one with less than this may be none on another machine.
SURE_ARREST_PA = 6.0e4

Values = dict[str, dict[str, Any]]
Case = tuple[str, str, str]  # mechanics, experiment, variant


def cases(mechanics: tuple[str, ...] = MECHANICS) -> list[Case]:
    """All mechanics, experiments and variants of the regression."""
    every = [(one, experiment, variant) for one in mechanics for experiment, variants in VARIANTS.items() for variant in variants]
    return [case for case in every if case[0] in mechanics_of(EXPERIMENTS / f"{case[1]}.toml", case[2])]


def settings_of(mechanics: str) -> tuple[str, ...]:
    """The settings of a run at smoke size."""
    return (f"numerics.mechanics={mechanics}", *SETTINGS)


def measured_values(found: Run) -> Values:
    """Start, arrests and restarts (named by the tip's height), final height and points of the path, each with unit and tolerance."""
    def pressure(value: float, sure: bool = True) -> dict[str, Any]:
        item = {"value": round(value, 3), "unit": "Pa", "tolerance": PRESSURE_TOLERANCE_PA[found.summary.mechanics]}
        return item if sure else {**item, "optional": True}

    values: Values = {}
    events = [event for event in found.summary.events if event.kind in ("arrest", "restart")]
    for event, after in [pair for pair in zip(events, [*events[1:], None]) if pair[0].kind == "arrest"]:
        sure = (after.inlet_Pa if after else found.summary.inlet_Pa) - event.inlet_Pa >= SURE_ARREST_PA
        values[f"arrest_at_{round(event.tip_y_m)}m_Pa"] = pressure(event.inlet_Pa, sure)
        if after is not None:
            values[f"restart_from_{round(event.tip_y_m)}m_Pa"] = pressure(after.inlet_Pa, sure)
    values |= {"start_Pa": pressure(event.inlet_Pa) for event in reversed(found.summary.events) if event.kind == "start"}
    quarter = path_length(found.path) / 4.0
    places = {f"path_{k}_{axis}_m": at for k, point in enumerate(resample(found.path, quarter)[1:5] if quarter > 0.0 else [], 1) for axis, at in zip("xy", point)}
    lengths = {"final_height_m": found.history["tip_y_m"].max(), **places}
    return values | {name: {"value": round(float(at), 6), "unit": "m", "tolerance": LENGTH_TOLERANCE_M} for name, at in lengths.items()}


def differences(found: Values, expected: Values) -> list[str]:
    """What is not as expected, a line a value; of arrests too short to be sure of, one that is there on one side only is none. Raises ValueError for
    an expectation so loose that zero or twice the value would pass."""
    lines = []
    for name, item in sorted((expected | found).items()):
        if not (name in expected and name in found):
            lines += [] if item.get("optional") else [f"{name}: {'not expected' if name in found else 'not there'}"]
            continue
        value, wanted, tolerance = found[name]["value"], expected[name]["value"], expected[name]["tolerance"]
        if not 0.0 <= tolerance < abs(wanted):
            raise ValueError(f"{name}: a tolerance of {tolerance} would let zero or twice {wanted} pass")
        if not abs(value - wanted) <= tolerance:
            lines.append(f"{name}: {value:.6g} against {wanted:.6g} {item['unit']}, allowed {tolerance:.3g}")
    return lines


def expected_file(mechanics: str, experiment: str) -> Path:
    """The file with an experiment's expected values in one mechanics."""
    return EXPECTED / mechanics / f"{experiment}.json"


def read_expected(mechanics: str, experiment: str) -> dict[str, Values]:
    """Expected values of an experiment, a table a variant; empty where there is no file."""
    path = expected_file(mechanics, experiment)
    return json.loads(path.read_text(encoding="utf-8"))["variants"] if path.is_file() else {}


def write_expected(mechanics: str, experiment: str, variants: dict[str, Values]) -> None:
    """Write the expected values of an experiment with the settings they belong to."""
    content = {"experiment": experiment, "settings": settings_of(mechanics), "variants": variants}
    store.write(content, expected_file(mechanics, experiment))


def measure_case(case: Case, stop: threading.Event | None = None) -> Values:
    """Run a case, unless it is there, and measure it; raises RuntimeError for a run that failed or was made in another mechanics."""
    mechanics, experiment, variant = case
    folder = SMOKE_RUNS.joinpath(*case)
    outcome, found = make(Job(EXPERIMENTS / f"{experiment}.toml", variant, folder, settings_of(mechanics)), stop)
    if not outcome.ok or found is None:
        raise RuntimeError(f"{'/'.join(case)}: {outcome.reason}")
    if found.summary.mechanics != mechanics:
        raise RuntimeError(f"{'/'.join(case)}: the solver ran {found.summary.mechanics}")
    return measured_values(found)


def changes(before: Values, now: Values) -> list[str]:
    """A line for each value that is new, gone or changed."""
    lines = []
    for name in sorted(before.keys() | now.keys()):
        old, new = before.get(name, {}).get("value"), now.get(name, {}).get("value")
        if old != new:
            outside = old is not None and new is not None and abs(new - old) > before[name]["tolerance"]
            unit = (now.get(name) or before[name])["unit"]
            lines.append(f"  {name}: {old} -> {new} {unit}{' (outside its tolerance)' if outside else ''}")
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Run, print the changes and, unless asked not to, write."""
    parser = command("ci/accept", __doc__, "mechanics", "jobs", jobs=os.cpu_count() or 1)
    parser.add_argument("--only", default="", help="experiments whose name begins so")
    parser.add_argument("--dry-run", action="store_true", help="print the differences, write nothing")
    options = parser.parse_args(arguments)
    every = [case for case in cases(MECHANICS if options.mechanics == "both" else (options.mechanics,)) if case[1].startswith(options.only)]
    tasks = [Task("/".join(case), partial(measure_case, case), lambda values: f"{len(values)} values") for case in every]
    measured = dict(zip(every, side_by_side(tasks, options.jobs)))
    count = 0
    for mechanics, experiment in dict.fromkeys(case[:2] for case in every):
        before = read_expected(mechanics, experiment)
        now = {case[2]: values for case, values in measured.items() if case[:2] == (mechanics, experiment)}
        for variant in dict.fromkeys([*before, *now]):
            lines = changes(before.get(variant, {}), now.get(variant, {}))
            count += len(lines)
            print("\n".join([f"{mechanics} {experiment} {variant}: {f'{len(lines)} differences' if lines else 'no difference'}", *lines]))
        if not options.dry_run:
            write_expected(mechanics, experiment, now)
    print(f"ci/accept: {count} differences, {'nothing written' if options.dry_run else f'written to {EXPECTED}'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
