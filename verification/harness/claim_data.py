"""Claims and what became of them as plain data, and claims.json written from it and read back."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from verification.harness import store

REPRODUCED = "reproduced"
NOT_REPRODUCED = "not reproduced"
ONLY_UNDER_A_VARIANT = "only under a variant"
NOT_EVALUATED = "not evaluated"

# The flag of an arrest or plateau that rests on J where an interface is too near for it to be trusted.
BY_J = "J at interface"


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


Plain = dict[str, Any]


def _with_cases(holder: Plain, changed: Callable[[Plain], Plain]) -> Plain:
    """A claim, or a reading of one, with each of its cases changed."""
    readings = {"readings": [_with_cases(one, changed) for one in holder["readings"]]} if "readings" in holder else {}
    return {**holder, "cases": [changed(case) for case in holder["cases"]], **readings}


def write_claims(results: list[ClaimResult], path: Path) -> None:
    """Write claims.json; a case's keys stand beside what was measured."""
    claims = [_with_cases(claim, lambda case: {**case["case"], **{key: case[key] for key in case if key != "case"}}) for claim in store.plain(results)]
    store.write({"claims": claims}, path)


def read_claims(path: Path) -> list[ClaimResult]:
    """Read claims.json; none where there is no such file, ValueError where it is not as write_claims leaves it."""
    own = {item.name for item in fields(Case)}

    def nest(case: Plain) -> Plain:
        return {"case": {key: case[key] for key in case if key in own}, **{key: case[key] for key in case if key not in own}}

    if not path.is_file():
        return []
    try:
        return store.built(list[ClaimResult], [_with_cases(claim, nest) for claim in json.loads(path.read_text(encoding="utf-8"))["claims"]])
    except (KeyError, TypeError) as error:
        raise ValueError(f"{path}: {error}") from error
