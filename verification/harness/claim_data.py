"""Claims and what became of them as plain data, and claims.json written from it and read back."""
from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

REPRODUCED = "reproduced"
NOT_REPRODUCED = "not reproduced"
ONLY_UNDER_A_VARIANT = "only under a variant"
NOT_EVALUATED = "not evaluated"

# An arrest or plateau that rests on J where an interface is too near for it to be trusted, and what becomes of the flag
# where a quasi-static run decides the same case by energy.
BY_J = "J at interface"
CONFIRMED = "J at interface, as energy decides"
CONTRADICTED = "J at interface, energy decides otherwise"


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
    meaning: str = ""


@dataclass(frozen=True)
class Reading:
    """Another way to read what the study leaves open, and whether the claim holds under it.

    `choice` is the id of the choice it comes from; `complete` is false where runs for some of the claim's cases were not made.
    """

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
    """Write claims.json; a case's keys stand beside what was measured."""

    def flat(result: CaseResult) -> dict[str, Any]:
        content = asdict(result)
        return {**content.pop("case"), **content}

    claims = []
    for result in results:
        readings = [{**asdict(reading), "cases": [flat(case) for case in reading.cases]} for reading in result.readings]
        claims.append({**asdict(result), "cases": [flat(case) for case in result.cases], "readings": readings})
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"claims": claims}, indent=1, allow_nan=False) + "\n", encoding="utf-8")


def read_claims(path: Path) -> list[ClaimResult]:
    """Read claims.json; none where there is no such file, ValueError where it is not as write_claims leaves it."""
    if not path.is_file():
        return []
    try:
        return [_claim(content) for content in json.loads(path.read_text(encoding="utf-8"))["claims"]]
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from error


def _claim(content: dict[str, Any]) -> ClaimResult:
    """A claim from its JSON object."""
    own = {item.name: content[item.name] for item in fields(ClaimResult)}
    readings = tuple(
        Reading(**{**reading, "cases": tuple(map(_case, reading["cases"]))}) for reading in content["readings"]
    )
    cases = tuple(map(_case, content["cases"]))
    return ClaimResult(**{**own, "cases": cases, "readings": readings, "flags": tuple(content["flags"])})


def _case(content: dict[str, Any]) -> CaseResult:
    """A case from its JSON object."""
    names = {item.name for item in fields(Case)}
    case = Case(**{key: value for key, value in content.items() if key in names})
    rest = {key: value for key, value in content.items() if key not in names}
    return CaseResult(case=case, **{**rest, "flags": tuple(rest["flags"])})
