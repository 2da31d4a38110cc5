"""The families of cases: every module of verification/ladder/cases/ with its CASES, checked for what the ladder relies on."""

import importlib
from collections.abc import Iterable

from verification.harness import choose
from verification.harness.choose import folder_name
from verification.ladder import cases as package
from verification.ladder.case import Case

Families = dict[str, tuple[Case, ...]]


class BadCase(ValueError):
    """A case that the ladder cannot judge; the message says which and why."""


def families() -> Families:
    """All families by name; raises BadCase for one that is not as it should be."""
    found = {name: tuple(cases) for name, cases in choose.listed(package, "CASES").items()}
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
        where, labels, sizes = f"{family}/{case.name}", [level.label for level in case.levels], [level.size for level in case.levels]
        _unique(f"{where}: levels", [folder_name(label) for label in labels])
        _unique(f"{where}: quantities", [quantity.name for quantity in case.quantities])
        strangers = {label for quantity in case.quantities for label in quantity.no_order_at} - set(labels)
        if strangers:
            raise BadCase(f"{where}: no_order_at names no level: {', '.join(sorted(strangers))}")
        if not case.levels or not case.quantities:
            raise BadCase(f"{where} has no levels or no quantities")
        if not case.scene.is_file():
            raise BadCase(f"{where}: no scene {case.scene}")
        if not all(coarse > fine > 0.0 for coarse, fine in zip(sizes, [*sizes[1:], 0.5 * sizes[-1]])):
            raise BadCase(f"{where}: sizes {sizes} do not fall from level to level")
        if not 1 <= case.smoke <= len(case.levels):
            raise BadCase(f"{where}: {case.smoke} smoke levels of {len(case.levels)}")


def _unique(what: str, names: list[str]) -> None:
    """Raise BadCase where a name stands twice."""
    if choose.twice(names):
        raise BadCase(f"{what} of the same name: {', '.join(choose.twice(names))}")


def chosen(known: Families, wanted: Iterable[str] = (), names: Iterable[str] = ()) -> Families:
    """The cases whose families and names begin as is asked (all where nothing is); raises ValueError for a beginning that none has."""
    own = choose.choose(known, wanted)
    kept = choose.choose({case.name: case for members in own.values() for case in members}, names, "case")
    found = {family: tuple(case for case in members if case.name in kept) for family, members in own.items()}
    return {family: members for family, members in found.items() if members}
