"""All families of the atlas: every module here with its FAMILIES, checked for what the judge relies on."""

import sys

from verification.harness.command import folder_name, listed, refuse, twice
from verification.stability.family import MARKED, SAFE, STABLE, Family


def families() -> dict[str, Family]:
    """All families by name, in the order of their modules' names and of each module; raises ValueError."""
    found = [family for members in listed(sys.modules[__name__], "FAMILIES").values() for family in members]
    for family in found:
        check(family)
    double = twice(family.name for family in found)
    refuse({f"two families are called {', '.join(double)}": double})
    return {family.name: family for family in found}


def check(family: Family) -> None:
    """Labels are unique, scenes are there, smoke points are two or three; raises ValueError otherwise."""
    double = twice(folder_name(point.label) for point in family.points)
    wrong = {
        f"points of the same label: {', '.join(double)}": double,
        "fewer than two points, or nothing said of it": len(family.points) < 2 or not family.says.strip(),
        f"beyond must be any of {', '.join(SAFE)}": not family.beyond or set(family.beyond) - set(SAFE),
        f"before must be {STABLE}, or {MARKED} for a reason": not family.before or set(family.before) - {STABLE, MARKED},
        "an edge needs points at any value, or a reader": family.edge is not None and not (family.edge.at or family.edge.read),
        f"words.toml says nothing of {family.section!r}": family.section and not family.about,
        "one to three points are to be run in ci/test": not 1 <= sum(point.smoke for point in family.points) <= 3,
    }
    for point in family.points:
        wrong[f"{point.label}: no scene {point.scene}"] = not point.scene.is_file()
    refuse({f"{family.name}: {words}": is_so for words, is_so in wrong.items()})
