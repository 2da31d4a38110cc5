"""The harness's verdicts as rows of a table: each case with what was asked and, mechanics by mechanics, what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reports.words import mechanics_name, number, plain, quantity, split_unit
from verification.harness.claim_data import (
    NOT_EVALUATED, NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, CaseResult, ClaimResult, Reading,
)

KINDS: dict[str, str] = {REPRODUCED: "yes", ONLY_UNDER_A_VARIANT: "partly", NOT_REPRODUCED: "no", NOT_EVALUATED: "open"}
_UNIT_SUFFIX: dict[str, str] = {"Pa": "Pa", "m": "m", "degrees": "deg", "deg": "deg", "s": "s", "J/m": "J"}


@dataclass(frozen=True)
class Found:
    """What one mechanics found of a case, in words; holds is 'yes', 'no' or 'open'."""

    mechanics: str
    holds: str
    measured: str
    note: str


@dataclass(frozen=True)
class CaseRow:
    """One measured thing in words, with what each mechanics found."""

    what: str
    asked: str
    found: tuple[Found, ...]


@dataclass(frozen=True)
class ReadingRow:
    """Another reading of what is open, with its cases and whether it holds in each mechanics."""

    name: str
    partial: bool
    holds: tuple[tuple[str, str], ...]  # mechanics in words, then as in a case
    cases: tuple[CaseRow, ...]


@dataclass(frozen=True)
class Verdict:
    """The verdict of one mechanics; kind is that of its colour."""

    mechanics: str
    verdict: str
    kind: str
    flags: tuple[str, ...]


@dataclass(frozen=True)
class ClaimRow:
    """One claim with a verdict for each mechanics."""

    id: str
    experiment: str
    text: str
    why: str
    verdicts: tuple[Verdict, ...]
    cases: tuple[CaseRow, ...]
    readings: tuple[ReadingRow, ...]


def claim_rows(claims: Sequence[ClaimResult]) -> list[ClaimRow]:
    """Every claim as a row, in the order of their ids, with the verdict of each mechanics that anything was evaluated in."""
    return [_claim_row([one for one in claims if one.id == id_]) for id_ in sorted({one.id for one in claims})]


def mechanics_of_rows(rows: Sequence[ClaimRow]) -> list[str]:
    """The mechanics that verdicts were given in, in words."""
    return list(dict.fromkeys(one.mechanics for row in rows for one in row.verdicts))


def counts(rows: Sequence[ClaimRow]) -> list[tuple[str, list[tuple[str, str, int]]]]:
    """For each mechanics and verdict: the verdict's name, its colour's kind and how many claims have it."""
    return [
        (mechanics, [(name, kind, _count(rows, mechanics, name)) for name, kind in KINDS.items()])
        for mechanics in mechanics_of_rows(rows)
    ]


def _count(rows: Sequence[ClaimRow], mechanics: str, verdict: str) -> int:
    """How many claims have a verdict in one mechanics."""
    return sum((one.mechanics, one.verdict) == (mechanics, verdict) for row in rows for one in row.verdicts)


def _claim_row(results: Sequence[ClaimResult]) -> ClaimRow:
    """One claim's row from its results, one a mechanics."""
    first = results[0]
    verdicts = tuple(
        Verdict(mechanics_name(one.mechanics), one.verdict, KINDS.get(one.verdict, "open"), one.flags) for one in results
    )
    cases = _case_rows([(one.mechanics, one.cases) for one in results])
    return ClaimRow(first.id, first.experiment, first.text, first.why, verdicts, cases, _reading_rows(results))


def _reading_rows(results: Sequence[ClaimResult]) -> tuple[ReadingRow, ...]:
    """The readings of a claim, each with what all mechanics that have it found."""
    names = list(dict.fromkeys(reading.name for one in results for reading in one.readings))
    rows = []
    for name in names:
        own: list[tuple[str, Reading]] = [
            (one.mechanics, reading) for one in results for reading in one.readings if reading.name == name
        ]
        holds = tuple((mechanics_name(mechanics), _holds(reading.holds)) for mechanics, reading in own)
        cases = _case_rows([(mechanics, reading.cases) for mechanics, reading in own])
        rows.append(ReadingRow(name, not own[0][1].complete, holds, cases))
    return tuple(rows)


def _holds(value: bool | None) -> str:
    """A verdict on a case: null is open."""
    return "open" if value is None else "yes" if value else "no"


def _case_rows(results: Sequence[tuple[str, Sequence[CaseResult]]]) -> tuple[CaseRow, ...]:
    """The cases of a claim or reading, the same ones in each mechanics."""
    rows = []
    for together in zip(*(cases for _, cases in results)):
        found = tuple(_found(mechanics, case) for (mechanics, _), case in zip(results, together))
        rows.append(CaseRow(_what(together[0]), _asked(together[0]), found))
    return tuple(rows)


def _found(mechanics: str, result: CaseResult) -> Found:
    """What one mechanics found of a case, in words."""
    return Found(mechanics_name(mechanics), _holds(result.holds), _measured(result), result.note)


def _what(result: CaseResult) -> str:
    """What a case is about."""
    case = result.case
    against = ""
    if case.against:
        other = (case.against_scene or "").split("_")[0]
        against = f" against {plain(case.against)}" + (f" of {plain(other)}" if other else "")
    parameters = ", ".join(f"{split_unit(key)[0]} {_parameter(key, value)}" for key, value in case.parameters.items())
    what = f"{plain(case.variant)}{against}: {split_unit(case.observable)[0]}"
    return what + (f" ({parameters})" if parameters else "")


def _parameter(key: str, value: object) -> str:
    """A parameter in words; a height above an interface says which."""
    if isinstance(value, dict) and "interface" in value:
        offset = float(value.get("plus_m", 0.0))
        beyond = "" if offset == 0.0 else f"{quantity('m', abs(offset))} {'above' if offset > 0 else 'below'} "
        return f"{beyond}interface {value['interface']}"
    return quantity(key, value)


def _suffix(result: CaseResult) -> str:
    """The suffix of keys that stands for a result's unit."""
    return _UNIT_SUFFIX.get(result.unit, "")


def _written(value: float, suffix: str) -> str:
    """A number in the printed unit of its suffix."""
    return quantity(suffix, float(value)) if suffix else number(float(value))


def _measured(result: CaseResult) -> str:
    """What was measured: a number, a bound where the run ended first, or nothing."""
    low, high, suffix = result.low, result.high, _suffix(result)
    if low is not None and high is not None and low != high:
        return f"{_written(low, suffix)} to {_written(high, suffix)}"
    if low is not None and high is None:
        return f"at least {_written(low, suffix)}"
    if high is not None and low is None:
        return f"at most {_written(high, suffix)}"
    return "nothing to measure" if result.value is None else _written(result.value, suffix)


def _asked(result: CaseResult) -> str:
    """The bounds that the claim asks for."""
    pairs = ((result.case.at_least, "≥"), (result.case.at_most, "≤"))
    return " and ".join(f"{sign} {_written(bound, _suffix(result))}" for bound, sign in pairs if bound is not None)
