"""Measures error and wall time of every method and setting: the data of the work-precision chart.

usage: ci/chart [--only block,crossing] [--methods qs_graded,ex_total] [--quick] [--once] [--list] [--force] [--fresh] [--out DIR]

One run at a time on an idle machine: where others are at work it waits a while and then refuses, unless --force is given; points
beside which something ran are marked as disturbed. What was measured before with the same scene, settings, program and machine is not measured
again (--fresh does). Points are written as they come to verification/precision/data/PROBLEM.json, so that a campaign that was stopped
goes on where it was. --quick measures coarse sizes of a few methods once, into runs/precision/quick. --list says what is to be
measured, what is known and how long it will take.
Exit status: 0 done (failures of methods are results), 2 wrong use or no idle machine.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from verification.benchmarks import machine
from verification.harness.command import beginnings, choose, command, ends_for_bad_input
from verification.harness.paths import reference_program, solver
from verification.harness.run import about_s
from verification.harness.scenes import content_of
from verification.ladder.case import Level
from verification.precision.measure import LONG_S, REPEATS, RUNS, SOME, WARM_S, key_of, measured
from verification.precision.problem import DATA, Method, Point, Problem, Sheet, read_sheet, write_sheet
from verification.precision.problems import PROBLEMS

QUICK = RUNS / "quick"


@dataclass(frozen=True)
class Task:
    """A point of a problem that is to be measured, with what is known of it (of another program or machine too)."""

    problem: Problem
    method: Method
    level: Level
    known: Point | None
    fresh: bool  # what is known is of this scene, program and machine

    def expected_s(self) -> float:
        """How long one run may take, s: as before, or by what such runs cost elsewhere."""
        if self.known is not None and self.known.wall_s:
            return self.known.time_s
        if self.method.setting is None:
            return 0.1
        if self.method.setting.mechanics == "quasistatic":
            return self.problem.about_s * (self.method.levels[-1].size / self.level.size) ** 2
        return min(about_s(content_of(Path(self.method.source), self.level.variant, self.level.settings)), self.problem.limit_s)

    def left_s(self, once: bool) -> float:
        """How long all its runs may still take, s; one that failed before ends at its first."""
        one = self.expected_s()
        alone = once or one > LONG_S or (self.known is not None and not self.known.ok)
        return 0.0 if self.fresh else one * (1 if alone else SOME if one > WARM_S else REPEATS + 1)


def chosen(only: str, methods: str, quick: bool) -> list[Problem]:
    """The problems and methods that are asked for; raises ValueError for names that are not there."""
    # To try the chart out, those methods and coarse levels alone that are enough.
    thin = [replace(one, methods=tuple(replace(method, levels=method.levels[: method.quick]) for method in one.methods if method.quick > 0)) for one in PROBLEMS]
    found = choose({one.name: one for one in (thin if quick else PROBLEMS)}, beginnings(only), "problem")
    named = choose({method.name: method for one in found.values() for method in one.methods}, beginnings(methods), "method")
    return [replace(one, methods=tuple(method for method in one.methods if method.name in named)) for one in found.values()]


def tasks_of(problem: Problem, sheet: Sheet | None, same: bool, fresh: bool) -> list[Task]:
    """All points of a problem, with what is known of them; `same`: by this machine."""
    tasks = []
    for method, level in ((method, level) for method in problem.methods for level in method.levels):
        known = sheet.point(method.name, level.label) if sheet is not None else None
        tasks.append(Task(problem, method, level, known, same and not fresh and known is not None and known.key == key_of(method, level)))
    return tasks


def show(tasks: Sequence[Task], once: bool) -> None:
    """Print what is to be measured, and how long it will take."""

    def left(own: Sequence[Task]) -> str:
        """Points, those to be measured, and their time."""
        minutes = sum(task.left_s(once) for task in own) / 60.0
        return f"{len(own)} points, {sum(not task.fresh for task in own)} to measure, in about {minutes:.1f} min"

    for name in dict.fromkeys(task.problem.name for task in tasks):
        own = [task for task in tasks if task.problem.name == name]
        print(f"{name}: {own[0].problem.says}: {left(own)}")
        for task in own:
            about = "measured" if task.fresh else f"about {task.expected_s():.2g} s a run"
            was = f" ({task.known.status})" if task.known is not None and not task.known.ok else ""
            print(f"  {task.method.label}, {task.level.label}: {about}{was}")
    print(left(tasks))


def words(point: Point) -> str:
    """A point in a line."""
    if not point.ok:
        return f"{point.status}: {point.reason[:140]}"
    told = [f"{name} {found.failure[:90] or (f'{100.0 * found.error:+.4g} %' if found.error is not None else found.value)}"
            for name, found in point.found.items()]  # fmt: skip
    return f"{point.time_s:.4g} s{' (disturbed)' if point.disturbed else ''}; {', '.join(told)}"


def measure_all(tasks: Sequence[Task], sheets: dict[str, Sheet], folder: Path, runs: Path, once: bool) -> None:
    """Measure the points that are not known, and write each as it comes."""
    left = [task for task in tasks if not task.fresh]
    order = {problem.name: [method.name for method in problem.methods] for problem in PROBLEMS}
    for k, task in enumerate(left, 1):
        name = task.problem.name
        point = measured(task.problem, task.method, task.level, runs, once)
        sheets[name] = sheets[name].with_point(point)
        write_sheet(sheets[name], folder, order[name])
        minutes = sum(one.left_s(once) for one in left[k:]) / 60.0
        print(f"[{k:3d}/{len(left)}, {minutes:.1f} min left] {name}/{task.method.name} {task.level.label}: {words(point)}", flush=True)


def main(arguments: list[str] | None = None) -> int:
    """Measure what is asked for."""
    parser = command("ci/chart", __doc__, "list", "out")
    parser.add_argument("--only", default="", help="problems, comma-separated (default: all)")
    parser.add_argument("--methods", default="", help="methods by the beginnings of their names, comma-separated (default: all)")
    parser.add_argument("--quick", action="store_true", help="coarse sizes of a few methods, once each, to try it out")
    parser.add_argument("--once", action="store_true", help="run each point once, without a warm-up")
    parser.add_argument("--force", action="store_true", help="measure even if the machine is not idle")
    parser.add_argument("--fresh", action="store_true", help="measure again what is known")
    options = parser.parse_args(arguments)
    with ends_for_bad_input(parser):
        problems = chosen(options.only, options.methods, options.quick)
    for program in (solver(), reference_program()):
        if not program.is_file():
            parser.error(f"there is no {program}: build it first (ci/chart does)")
    folder = options.out or (QUICK / "data" if options.quick else DATA)
    runs = options.out / "runs" if options.out else QUICK if options.quick else RUNS
    once, here = options.quick or options.once, machine.described()
    known = {problem.name: read_sheet(problem.name, folder) for problem in problems}
    same = {name: sheet is not None and machine.made_here(sheet.machine, here) for name, sheet in known.items()}
    tasks = [task for problem in problems for task in tasks_of(problem, known[problem.name], same[problem.name], options.fresh)]
    if options.list:
        show(tasks, once)
        return 0
    if not (options.force or options.quick or machine.becomes_idle()):
        print("others are at work on this machine; --force measures all the same", file=sys.stderr)
        return 2
    points = {(problem.name, method.name, level.label) for problem in PROBLEMS for method in problem.methods for level in method.levels}
    sheets = {}  # what is known from this machine, without methods that are gone
    for name, sheet in known.items():
        kept = sheet.points if sheet is not None and same[name] else ()
        sheets[name] = Sheet(name, here, tuple(point for point in kept if (name, point.method, point.level) in points))
    measure_all(tasks, sheets, folder, runs, once)
    print(f"{len(tasks)} points of {len(problems)} problems are in {folder}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
