"""Evaluates the claims that scenes hold as data on the runs made of them.

A claim is reproduced when all its cases hold, "only under a variant" when they do not but those of one of its readings do.
usage: python3 -m verification.harness.claims [--experiments DIR] [--runs DIR] [--out FILE]
"""
from __future__ import annotations

import argparse
import json
import math
import sys
import tomllib
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from verification.harness.load import LoadError, Run, load
from verification.harness.observables import OBSERVABLES, Measured, measure
from verification.harness.paths import EXPERIMENTS, ROOT

REPRODUCED = "reproduced"
NOT_REPRODUCED = "not reproduced"
ONLY_UNDER_A_VARIANT = "only under a variant"
NOT_EVALUATED = "not evaluated"

# Keys of a case that are not parameters of its observable.
CASE_KEYS = ("observable", "variant", "against", "against_scene", "at_least", "at_most")


class BadClaim(Exception):
    """A claim that cannot be evaluated as it is written."""


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


@dataclass(frozen=True)
class CaseResult:
    """A case with what was measured: value in `unit`, its bounds (null: unbounded), whether it holds (null: open)."""

    case: Case
    unit: str
    value: float | None
    low: float | None
    high: float | None
    holds: bool | None
    evaluated: bool
    note: str
    flags: tuple[str, ...]


@dataclass(frozen=True)
class Reading:
    """Another way to read what the study leaves open, and whether the claim holds under it."""

    name: str
    holds: bool | None
    cases: tuple[CaseResult, ...]


@dataclass(frozen=True)
class ClaimResult:
    """A claim with its verdict and the numbers behind it."""

    id: str
    experiment: str
    text: str
    why: str
    observable: str
    verdict: str
    cases: tuple[CaseResult, ...]
    readings: tuple[Reading, ...]
    flags: tuple[str, ...]


def case_of(content: dict[str, Any], default_observable: str, where: str) -> Case:
    """A case from its TOML table; raises BadClaim for one that could not fail."""
    name = str(content.get("observable", default_observable))
    if name not in OBSERVABLES:
        raise BadClaim(f"{where}: no observable {name}; there are {', '.join(sorted(OBSERVABLES))}")
    if "at_least" not in content and "at_most" not in content:
        raise BadClaim(f"{where}: {name} has neither at_least nor at_most, so it could not fail")
    if OBSERVABLES[name].compares != ("against" in content):
        raise BadClaim(f"{where}: {name} {'needs' if OBSERVABLES[name].compares else 'takes no'} key against")
    parameters = {key: value for key, value in content.items() if key not in CASE_KEYS}
    known = {key: content[key] for key in CASE_KEYS if key in content and key != "observable"}
    return Case(observable=name, parameters=parameters, **known)


class Runs:
    """The runs below a folder, each loaded once; a run that is missing or failed is None with the reason."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.get = lru_cache(maxsize=None)(self._get)

    def _get(self, experiment: str, variant: str) -> tuple[Run | None, str]:
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


def finite(number: float) -> float | None:
    """A number for JSON, where what is not finite becomes null."""
    return number if math.isfinite(number) else None


def evaluate_case(case: Case, experiment: str, runs: Runs) -> CaseResult:
    """Measure a case on the runs."""
    run, problem = runs.get(experiment, case.variant)
    against: Run | None = None
    if run is not None and case.against is not None:
        against, problem = runs.get(case.against_scene or experiment, case.against)
    unit = OBSERVABLES[case.observable].unit
    if problem:
        return CaseResult(case, unit, None, None, None, None, False, problem, ())
    assert run is not None
    found: Measured = measure(case.observable, case.parameters, run, against)
    holds = found.holds(case.at_least, case.at_most)
    flags = found.flags if found.exact else (*found.flags, "bound only")
    return CaseResult(case, unit, found.value, finite(found.low), finite(found.high), holds, True, found.note, flags)


def all_hold(cases: tuple[CaseResult, ...]) -> bool | None:
    """Whether all cases hold: False as soon as one does not, None where some are open."""
    if any(case.holds is False for case in cases):
        return False
    return True if all(case.holds for case in cases) else None


def verdict_of(cases: tuple[CaseResult, ...], readings: tuple[Reading, ...]) -> str:
    """The verdict on a claim from its cases and readings."""
    holds = all_hold(cases)
    if holds:
        return REPRODUCED
    if any(reading.holds for reading in readings):
        return ONLY_UNDER_A_VARIANT
    if holds is None and not all(case.evaluated for case in cases):
        return NOT_EVALUATED
    return NOT_REPRODUCED


def evaluate(claim: dict[str, Any], experiment: str, runs: Runs) -> ClaimResult:
    """Evaluate one claim of a scene."""
    where = f"{experiment}, claim {claim.get('id')}"
    for key in ("id", "text", "observable", "case", "why"):
        if not claim.get(key):
            raise BadClaim(f"{where}: no {key}")

    def evaluated(contents: list[dict[str, Any]]) -> tuple[CaseResult, ...]:
        return tuple(evaluate_case(case_of(content, claim["observable"], where), experiment, runs) for content in contents)

    cases = evaluated(claim["case"])
    others = [(str(reading["name"]), evaluated(reading["case"])) for reading in claim.get("reading", [])]
    readings = tuple(Reading(name, all_hold(results), results) for name, results in others)
    verdict = verdict_of(cases, readings)
    flags = list(dict.fromkeys(flag for case in cases for flag in case.flags))
    if verdict == NOT_REPRODUCED and all_hold(cases) is None:
        flags.append("undecided: a run ended before it could show this")
    if verdict == REPRODUCED:
        flags += [f"does not hold under: {reading.name}" for reading in readings if reading.holds is False]
    return ClaimResult(
        claim["id"], experiment, claim["text"], claim["why"], claim["observable"], verdict, cases, readings, tuple(flags)
    )


def claims_of(scene: Path) -> list[dict[str, Any]]:
    """The claims of a scene file."""
    return list(tomllib.loads(scene.read_text(encoding="utf-8")).get("claim", []))


def evaluate_all(experiments: Path, runs_folder: Path) -> list[ClaimResult]:
    """Evaluate the claims of all scenes of a folder."""
    runs = Runs(runs_folder)
    return [evaluate(claim, scene.stem, runs) for scene in sorted(experiments.glob("*.toml")) for claim in claims_of(scene)]


def as_json(results: list[ClaimResult]) -> str:
    """The results as the text of claims.json; a case's keys stand beside what was measured."""

    def flat(result: CaseResult) -> dict[str, Any]:
        content = asdict(result)
        meaning = OBSERVABLES[result.case.observable].meaning
        return {**content.pop("case"), "meaning": meaning, **content}

    claims = []
    for result in results:
        readings = [
            {"name": reading.name, "holds": reading.holds, "cases": [flat(case) for case in reading.cases]}
            for reading in result.readings
        ]
        claims.append({**asdict(result), "cases": [flat(case) for case in result.cases], "readings": readings})
    return json.dumps({"claims": claims}, indent=1, allow_nan=False) + "\n"


def main(arguments: list[str] | None = None) -> int:
    """Evaluate from the command line, print a line a claim and write the JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--experiments", type=Path, default=EXPERIMENTS)
    parser.add_argument("--runs", type=Path, default=ROOT / "runs")
    parser.add_argument("--out", type=Path, help="default: claims.json among the runs")
    options = parser.parse_args(arguments)
    results = evaluate_all(options.experiments, options.runs)
    out = options.out or options.runs / "claims.json"
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(as_json(results), encoding="utf-8")
    for result in results:
        flags = f"  [{'; '.join(result.flags)}]" if result.flags else ""
        print(f"{result.id}  {result.verdict}{flags}")
    print(f"claims: {out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
