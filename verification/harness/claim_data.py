"""Claims and what became of them as plain data, and claims.json written from it and read back."""

from dataclasses import dataclass, field
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


@dataclass(frozen=True)
class Claims:
    """What claims.json holds."""

    claims: list[ClaimResult]


def write_claims(results: list[ClaimResult], path: Path) -> None:
    """Write claims.json."""
    store.write(Claims(results), path)


def read_claims(path: Path) -> list[ClaimResult]:
    """Read claims.json; none where there is no such file, ValueError where it is not as write_claims leaves it."""
    found = store.read(Claims, path)
    return found.claims if found is not None else []
