"""The families of cases: every module of verification/ladder/cases/ with its CASES, checked for what the ladder relies on."""
from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable

from verification.ladder import cases as package
from verification.ladder.case import Case

Families = dict[str, tuple[Case, ...]]


class BadCase(Exception):
    """A case that the ladder cannot judge; the message says which and why."""


def families() -> Families:
    """All families by name; raises BadCase for one that is not as it should be."""
    names = sorted(module.name for module in pkgutil.iter_modules(package.__path__))
    found = {name: tuple(importlib.import_module(f"{package.__name__}.{name}").CASES) for name in names}
    for family, members in found.items():
        check(family, members)
    return found


def about(family: str) -> str:
    """What a family's module says of itself in its first sentences; nothing for one that is not there."""
    try:
        module = importlib.import_module(f"{package.__name__}.{family}")
    except ModuleNotFoundError:
        return ""
    return " ".join((module.__doc__ or "").strip().split("\n\n")[0].split())


def check(family: str, members: Iterable[Case]) -> None:
    """Names are unique, sizes fall from level to level, something is measured; raises BadCase otherwise."""
    members = tuple(members)
    _unique(f"{family}: cases", [case.name for case in members])
    for case in members:
        where = f"{family}/{case.name}"
        _unique(f"{where}: levels", [folder_name(level.label) for level in case.levels])
        _unique(f"{where}: quantities", [quantity.name for quantity in case.quantities])
        labels = {level.label for level in case.levels}
        strangers = {label for quantity in case.quantities for label in quantity.no_order_at} - labels
        if strangers:
            raise BadCase(f"{where}: no_order_at names no level: {', '.join(sorted(strangers))}")
        if not case.levels or not case.quantities:
            raise BadCase(f"{where} has no levels or no quantities")
        if not case.scene.is_file():
            raise BadCase(f"{where}: no scene {case.scene}")
        sizes = [level.size for level in case.levels]
        if not all(coarse > fine > 0.0 for coarse, fine in zip(sizes, [*sizes[1:], 0.5 * sizes[-1]])):
            raise BadCase(f"{where}: sizes {sizes} do not fall from level to level")
        if not 1 <= case.smoke <= len(case.levels):
            raise BadCase(f"{where}: {case.smoke} smoke levels of {len(case.levels)}")


def _unique(what: str, names: list[str]) -> None:
    """Raise BadCase where a name stands twice."""
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise BadCase(f"{what} of the same name: {', '.join(twice)}")


def choose(known: Families, wanted: Iterable[str] = (), names: Iterable[str] = ()) -> Families:
    """The cases of some families (all where none is given) whose names are given (all where none is); raises BadCase."""
    wanted, names = tuple(wanted), tuple(names)
    strangers = [name for name in wanted if name not in known]
    if strangers:
        raise BadCase(f"no family {', '.join(strangers)}; there are {', '.join(known)}")
    chosen = {
        family: tuple(case for case in members if not names or case.name in names)
        for family, members in known.items()
        if not wanted or family in wanted
    }
    missing = set(names) - {case.name for members in chosen.values() for case in members}
    if missing:
        raise BadCase(f"no case {', '.join(sorted(missing))} in {', '.join(chosen)}")
    return {family: members for family, members in chosen.items() if members}


def folder_name(label: str) -> str:
    """A label as the name of a folder: letters, digits, points and signs stay, anything else becomes a line."""
    return "".join(letter if letter.isalnum() or letter in ".+-=" else "_" for letter in label)
