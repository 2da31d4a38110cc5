"""What the study leaves open, and which variants show another choice: experiments/choices/points.toml as plain data."""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from verification.harness.command import refuse, twice
from verification.harness.scenes import scenes_of, variants_of

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
