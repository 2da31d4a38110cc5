"""Claims, what the study leaves open with the variants that show another choice (experiments/choices/points.toml), and what became of the claims, as plain data;
claims.json written from it and read back."""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from verification.harness import store
from verification.harness.command import refuse, twice
from verification.harness.scenes import scenes_of, variants_of

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
