"""All families of the atlas: every module of verification/stability/families/ with its FAMILIES, checked for what the judge relies on."""
from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable

from verification.ladder.catalogue import folder_name
from verification.stability import families as package
from verification.stability.family import MARKED, SAFE, STABLE, STRATA, BadFamily, Family


def families() -> dict[str, Family]:
    """All families by name, in the order of their modules' names and of each module; raises BadFamily."""
    found: dict[str, Family] = {}
    for name in sorted(module.name for module in pkgutil.iter_modules(package.__path__)):
        for family in importlib.import_module(f"{package.__name__}.{name}").FAMILIES:
            if family.name in found:
                raise BadFamily(f"two families are called {family.name}")
            check(family)
            found[family.name] = family
    return found


def check(family: Family) -> None:
    """Labels are unique, scenes are there, smoke points are two or three; raises BadFamily otherwise."""
    labels = [folder_name(point.label) for point in family.points]
    twice = sorted({label for label in labels if labels.count(label) > 1})
    if twice:
        raise BadFamily(f"{family.name}: points of the same label: {', '.join(twice)}")
    if len(family.points) < 2 or not family.says.strip():
        raise BadFamily(f"{family.name}: fewer than two points, or nothing said of it")
    if not family.beyond or set(family.beyond) - set(SAFE):
        raise BadFamily(f"{family.name}: beyond must be any of {', '.join(SAFE)}")
    if not family.before or set(family.before) - {STABLE, MARKED}:
        raise BadFamily(f"{family.name}: before must be {STABLE}, or {MARKED} for a reason")
    if not 1 <= sum(point.smoke for point in family.points) <= 3:
        raise BadFamily(f"{family.name}: one to three points are to be run in ci/test")
    for point in family.points:
        if point.program == STRATA and not point.scene.is_file():
            raise BadFamily(f"{family.name}, {point.label}: no scene {point.scene}")
        if point.program != STRATA and point.program not in family.ways:
            raise BadFamily(f"{family.name}, {point.label}: no way {point.program}")


def choose(known: dict[str, Family], wanted: Iterable[str]) -> dict[str, Family]:
    """The families whose names begin as is asked (all where nothing is); raises BadFamily for a beginning that none has."""
    starts = tuple(wanted)
    strangers = [start for start in starts if not any(name.startswith(start) for name in known)]
    if strangers:
        raise BadFamily(f"no family {', '.join(strangers)}; there are {', '.join(known)}")
    return {name: family for name, family in known.items() if not starts or name.startswith(starts)}
