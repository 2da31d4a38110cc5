"""Evaluates the claims that scenes hold as data on the runs made of them, for each mechanics.

A claim is reproduced when all its cases hold, "only under a variant" when they do not but those of one of its readings do.
Readings are written in the scene, or follow from a choice of experiments/choices/points.toml by which other variants stand for
those that the cases name.
Beside the runs of the scenes as they are stand those of cells of half the size (`ci/reproduce --cell 0.5`), or what was recorded of
them: experiments/expected/claims_0.5m.json, written by --record.
usage: python3 -m verification.harness.claims [--experiments DIR] [--runs DIR] [--out FILE] [--record]
"""

import math
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from verification.harness import store
from verification.harness.command import command, refuse, twice
from verification.harness.load import OF_SPEEDS, LoadError, Run, load
from verification.harness.observables import OBSERVABLES, measure
from verification.harness.paths import EXPERIMENTS, RUNS
from verification.harness.scenes import MECHANICS, mechanics_of, read_scene, scenes_of, variants_of

REPRODUCED = "reproduced"
NOT_REPRODUCED = "not reproduced"
ONLY_UNDER_A_VARIANT = "only under a variant"
NOT_EVALUATED = "not evaluated"


@dataclass(frozen=True)
class Case:
    """One thing that must hold: an observable of one run, or of one against another, within bounds (its unit)."""

    observable: str
    variant: str
    against: str | None = None
    against_scene: str | None = None
    at_least: float | None = None
    at_most: float | None = None
    parameters: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class CaseResult(Case):
    """A case with what was measured: value in `unit`, its bounds (null: unbounded), whether it holds (null: open)."""

    unit: str
    value: float | None = None
    low: float | None = None
    high: float | None = None
    holds: bool | None = None
    evaluated: bool = True
    note: str = ""
    flags: tuple[str, ...] = ()
    meaning: str = ""


@dataclass(frozen=True)
class Reading:
    """Another way to read what the study leaves open, and whether the claim holds under it. `choice` is the id of the choice it comes from;
    `complete` is false where runs for some of the claim's cases were not made."""

    name: str
    holds: bool | None
    cases: tuple[CaseResult, ...]
    choice: str = ""
    complete: bool = True


@dataclass(frozen=True)
class ClaimResult:
    """A claim with its verdict in one mechanics and the numbers behind it; `holds` is that of the default choices alone."""

    id: str
    experiment: str
    mechanics: str
    text: str
    why: str
    observable: str
    verdict: str
    holds: bool | None
    cases: tuple[CaseResult, ...]
    readings: tuple[Reading, ...]
    flags: tuple[str, ...]


def write_claims(results: list[ClaimResult], path: Path) -> None:
    """Write claims.json."""
    store.write({"claims": results}, path)


def read_claims(path: Path) -> list[ClaimResult]:
    """Read claims.json; none where there is no such file, ValueError where it is not as write_claims leaves it."""
    return (store.read(dict[str, list[ClaimResult]], path) or {"claims": []})["claims"]


FILE = Path("choices") / "points.toml"  # below the folder of the scenes


@dataclass(frozen=True)
class Choice:
    """Another choice at an open point: for each experiment, which variant stands for which."""

    id: str
    title: str  # the open point and the choice
    name: str
    runs: dict[str, dict[str, str]] = field(default_factory=dict)

    def standing_for(self, experiment: str, variant: str) -> str | None:
        """The variant that stands for another under this choice, or None where none was made."""
        return self.runs.get(experiment, {}).get(variant)


@dataclass(frozen=True)
class Point:
    """Something that the study leaves open, what the scenes take, and the other choices."""

    id: str
    open: str
    default: str
    choices: tuple[Choice, ...]


def read_points(experiments: Path) -> list[Point]:
    """The open points of a folder of scenes, none where it has no such file; raises ValueError for names that are not there."""
    path = experiments / FILE
    if not path.is_file():
        return []
    points = []
    for item in tomllib.loads(path.read_text(encoding="utf-8"))["point"]:
        choices = [Choice(one["id"], f"{item['open']}: {one['name']}", one["name"], one["runs"]) for one in item["choice"]]
        points.append(Point(item["id"], item["open"], item["default"], tuple(choices)))
    known = {scene.stem: set(variants_of(scene)) for scene in scenes_of(experiments)}
    every = [choice for point in points for choice in point.choices]
    refuse({"two choices have the same id": twice(choice.id for choice in every)})
    for choice, experiment, pairs in ((choice, *named) for choice in every for named in choice.runs.items()):
        strangers = {*pairs, *pairs.values()} - known.get(experiment, set())
        refuse({f"choice {choice.id}: there is no experiment {experiment}": experiment not in known,
                f"choice {choice.id}: {experiment} has no variant {', '.join(sorted(strangers))}": strangers})  # fmt: skip
    return points


# Where `ci/reproduce --cell 0.5` puts its runs, below the others; what is written of them, below the experiments.
FINER, FINER_RECORD, CELLS = Path("set") / "0.5m", Path("expected") / "claims_0.5m.json", "0.5 m"

# Keys of a case that are not parameters of its observable.
CASE_KEYS = ("observable", "variant", "against", "against_scene", "at_least", "at_most")


def case_of(content: dict[str, Any], default_observable: str, where: str) -> Case:
    """A case from its TOML table; raises ValueError for one that could not fail."""
    name = str(content.get("observable", default_observable))
    if name not in OBSERVABLES:
        raise ValueError(f"{where}: no observable {name}; there are {', '.join(sorted(OBSERVABLES))}")
    if "at_least" not in content and "at_most" not in content:
        raise ValueError(f"{where}: {name} has neither at_least nor at_most, so it could not fail")
    if OBSERVABLES[name].compares != ("against" in content):
        raise ValueError(f"{where}: {name} {'needs' if OBSERVABLES[name].compares else 'takes no'} key against")
    parameters = {key: value for key, value in content.items() if key not in CASE_KEYS}
    known = {key: content[key] for key in CASE_KEYS if key in content}
    return Case(**{**known, "observable": name}, parameters=parameters)


@dataclass(frozen=True, eq=False)
class Runs:
    """The runs of one mechanics below a folder."""

    folder: Path
    mechanics: str = MECHANICS[0]

    @cache
    def get(self, experiment: str, variant: str) -> tuple[Run | None, str]:
        """A run, loaded once; None with the reason for one that is missing or failed."""
        folder = self.folder / experiment / variant
        if not folder.is_dir():
            return None, f"{experiment}/{variant} has not been run"
        try:
            run = load(folder)
        except LoadError as error:
            return None, str(error)
        if run.summary.status != "completed":
            return None, f"{experiment}/{variant} failed: {run.summary.reason}"
        return run, ""


def runs_of(case: Case, experiment: str) -> list[tuple[str, str]]:
    """Experiment and variant of each run that a case is about."""
    return [(experiment, case.variant)] + ([(case.against_scene or experiment, case.against)] if case.against is not None else [])


def evaluate_case(case: Case, experiment: str, runs: Runs) -> CaseResult:
    """Measure a case on the runs; marks that the runs' own monitors have set on them are flags."""
    observable = OBSERVABLES[case.observable]
    found = [runs.get(*names) for names in runs_of(case, experiment)]
    known = [run for run, _ in found if run is not None]
    if problem := next((problem for _, problem in found if problem), ""):
        return CaseResult(**vars(case), unit=observable.unit, evaluated=False, note=problem, meaning=observable.meaning)
    measured = measure(case.observable, case.parameters, known[0], known[1] if len(known) > 1 else None)
    marks = [f"suspect run {run.name}: {mark.why}" for run in known for mark in run.summary.suspect if mark.monitor != OF_SPEEDS]
    flags = (*measured.flags, *(() if measured.exact else ("bound only",)), *marks)
    low, high = (bound if math.isfinite(bound) else None for bound in (measured.low, measured.high))
    own = {"value": measured.value, "low": low, "high": high, "holds": measured.holds(case.at_least, case.at_most), "note": measured.note}
    return CaseResult(**vars(case), **own, unit=observable.unit, flags=flags, meaning=observable.meaning)


def all_hold(cases: Sequence[CaseResult]) -> bool | None:
    """Whether all cases hold: False as soon as one does not, None where some are open."""
    if any(case.holds is False for case in cases):
        return False
    return True if all(case.holds for case in cases) else None


def under(choice: Choice, cases: Sequence[Case], experiment: str) -> list[Case]:
    """The cases with the variants that stand for theirs under a choice; none where the choice changes no case."""
    found, changed = [], False
    for case in cases:
        variant = choice.standing_for(experiment, case.variant)
        against = choice.standing_for(case.against_scene or experiment, case.against) if case.against else None
        if variant is None or (case.against and against is None):
            continue
        changed = changed or variant != case.variant or against != case.against
        found.append(replace(case, variant=variant, against=against))
    return found if changed else []


def readings_of(
    claim: dict[str, Any], cases: Sequence[Case], experiment: str, runs: Runs, choices: Sequence[Choice], experiments: Path
) -> tuple[Reading, ...]:
    """The readings that the scene writes, then those that follow from choices; one written for a choice stands for it. A choice is none where the
    mechanics cannot run all variants that stand for others."""
    where = f"{experiment}, claim {claim['id']}"
    titles = {choice.id: choice.title for choice in choices}
    written: list[tuple[str, str, list[Case], bool]] = []  # name, choice, cases, whether these are all
    for reading in claim.get("reading", []):
        asked = [case_of(content, claim["observable"], where) for content in reading["case"]]
        choice_id = str(reading.get("choice", ""))
        if choice_id and choices and choice_id not in titles:
            raise ValueError(f"{where}: there is no choice {choice_id}")
        written.append((str(reading.get("name", choice_id)), choice_id, asked, not choice_id or len(asked) >= len(cases)))
    spoken_for = {choice_id for _, choice_id, _, _ in written}
    for choice in choices:
        asked = under(choice, cases, experiment) if choice.id not in spoken_for else []
        named = [names for case in asked for names in runs_of(case, experiment)]
        if named and all(runs.mechanics in mechanics_of(experiments / f"{stem}.toml", variant) for stem, variant in named):
            written.append(("", choice.id, asked, len(asked) == len(cases)))
    found = []
    for name, choice_id, asked, complete in written:
        results = tuple(evaluate_case(case, experiment, runs) for case in asked)
        found.append(Reading(titles.get(choice_id, name), all_hold(results), results, choice_id, complete))
    return tuple(found)


def evaluate(claim: dict[str, Any], experiment: str, runs: Runs, choices: Sequence[Choice] = (), experiments: Path = EXPERIMENTS) -> ClaimResult:
    """Evaluate one claim of a scene."""
    where = f"{experiment}, claim {claim.get('id')}"
    for key in ("id", "text", "observable", "case", "why"):
        if not claim.get(key):
            raise ValueError(f"{where}: no {key}")
    asked = [case_of(content, claim["observable"], where) for content in claim["case"]]
    cases = tuple(evaluate_case(case, experiment, runs) for case in asked)
    readings = readings_of(claim, asked, experiment, runs, choices, experiments)
    holds, flags, verdict = all_hold(cases), list(dict.fromkeys(flag for case in cases for flag in case.flags)), NOT_REPRODUCED
    if holds:
        verdict = REPRODUCED
    elif any(reading.holds and reading.complete for reading in readings):
        verdict = ONLY_UNDER_A_VARIANT
    elif holds is None and not all(case.evaluated for case in cases):
        verdict = NOT_EVALUATED
    if verdict == NOT_REPRODUCED and holds is None:
        flags.append("undecided: a run ended before it could show this")
    if verdict == REPRODUCED:
        flags += [f"does not hold under: {reading.name}" for reading in readings if reading.holds is False]
    own = (claim["id"], experiment, runs.mechanics, claim["text"], claim["why"], claim["observable"])
    return ClaimResult(*own, verdict, holds, cases, readings, tuple(flags))


def claims_of(scene: Path) -> list[dict[str, Any]]:
    """The claims of a scene file."""
    return list(read_scene(scene).get("claim", []))


def evaluate_all(experiments: Path, runs_folder: Path, mechanics: str = MECHANICS[0]) -> list[ClaimResult]:
    """Evaluate the claims of all scenes of a folder on the runs of one mechanics, which are below runs_folder/EXPERIMENT/."""
    runs = Runs(runs_folder, mechanics)
    choices = [choice for point in read_points(experiments) for choice in point.choices]
    return [evaluate(claim, scene.stem, runs, choices, experiments) for scene in scenes_of(experiments) for claim in claims_of(scene)]


def evaluate_each(experiments: Path, root: Path) -> list[ClaimResult]:
    """Evaluate the claims in each mechanics that has runs below root/MECHANICS/ (in the first where none has)."""
    present = [mechanics for mechanics in MECHANICS if (root / mechanics).is_dir()] or [MECHANICS[0]]
    finer = finer_of(experiments, root) or read_claims(experiments / FINER_RECORD)
    return [result for mechanics in present for result in evaluate_all(experiments, root / mechanics, mechanics)] + finer


def finer_of(experiments: Path, root: Path) -> list[ClaimResult]:
    """The claims evaluated on runs with cells of 0.5 m, without readings; what was not run is left out."""
    found = [
        replace(result, mechanics=f"{mechanics} {CELLS}", readings=())
        for mechanics in MECHANICS if (root / FINER / mechanics).is_dir()
        for result in evaluate_all(experiments, root / FINER / mechanics, mechanics)
    ]
    return [result for result in found if result.verdict != NOT_EVALUATED]


def record_finer(experiments: Path, root: Path) -> Path:
    """Write what runs with cells of 0.5 m make of the claims; each says which version of the solver ran."""
    versions = sorted({load(path.parent).summary.version for path in (root / FINER).glob("*/*/*/summary.json")})
    words = f"recorded by strata {' and '.join(versions)}"
    results = [replace(result, flags=(words, *result.flags)) for result in finer_of(experiments, root)]
    write_claims(results, experiments / FINER_RECORD)
    return experiments / FINER_RECORD


def main(arguments: list[str] | None = None) -> int:
    """Evaluate from the command line, print a line a claim and write the JSON."""
    parser = command(Path(__file__).name, __doc__, "runs", "out", runs=RUNS)
    parser.add_argument("--experiments", type=Path, default=EXPERIMENTS)
    parser.add_argument("--record", action="store_true", help=f"write EXPERIMENTS/{FINER_RECORD} from the runs with cells of 0.5 m")
    options = parser.parse_args(arguments)
    if options.record:
        print(f"recorded: {record_finer(options.experiments, options.runs)}")
    results = evaluate_each(options.experiments, options.runs)
    out = options.out or options.runs / "claims.json"
    write_claims(results, out)
    for result in results:
        flags = f"  [{'; '.join(result.flags)}]" if result.flags else ""
        print(f"{result.mechanics:17} {result.id}  {result.verdict}{flags}")
    print(f"claims: {out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
