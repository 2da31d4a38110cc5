"""The harness's verdicts as rows of a table: each case with what was measured and what was asked."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from reports.words import number, plain, quantity, split_unit

VERDICTS: dict[str, str] = {
    "reproduced": "yes",
    "only under a variant": "partly",
    "not reproduced": "no",
    "not evaluated": "open",
}
_UNIT_SUFFIX: dict[str, str] = {"Pa": "Pa", "m": "m", "degrees": "deg", "deg": "deg", "s": "s", "J/m": "J"}


@dataclass(frozen=True)
class CaseRow:
    """One measured thing in words; holds is 'yes', 'no' or 'open'."""

    holds: str
    what: str
    measured: str
    asked: str
    note: str


@dataclass(frozen=True)
class ReadingRow:
    """Another reading of what is open, with its cases; holds as in a case."""

    name: str
    holds: str
    cases: tuple[CaseRow, ...]


@dataclass(frozen=True)
class ClaimRow:
    """One claim with its verdict; kind is that of the verdict's colour."""

    id: str
    experiment: str
    text: str
    verdict: str
    kind: str
    cases: tuple[CaseRow, ...]
    readings: tuple[ReadingRow, ...]
    flags: tuple[str, ...]
    why: str


def claim_rows(claims: list[dict[str, Any]]) -> list[ClaimRow]:
    """Every claim as a row, in the order of their ids."""
    return sorted((_claim_row(claim) for claim in claims), key=lambda row: row.id)


def counts(rows: list[ClaimRow]) -> list[tuple[str, str, int]]:
    """For each verdict its name, its colour's kind and how many claims have it."""
    return [(name, kind, sum(row.verdict == name for row in rows)) for name, kind in VERDICTS.items()]


def _claim_row(claim: dict[str, Any]) -> ClaimRow:
    """One claim's row."""
    verdict = str(claim.get("verdict", "not evaluated"))
    flags = [*(claim.get("flags") or []), *(claim.get("notes") or [])]
    readings = tuple(
        ReadingRow(str(reading.get("name", "")), _holds(reading.get("holds")), _cases(reading.get("cases")))
        for reading in claim.get("readings") or []
    )
    return ClaimRow(
        id=str(claim.get("id", "?")),
        experiment=str(claim.get("experiment", "")),
        text=str(claim.get("text", "")),
        verdict=verdict,
        kind=VERDICTS.get(verdict, "open"),
        cases=_cases(claim.get("cases")) or _numbers(claim.get("numbers")),
        readings=readings,
        flags=tuple(str(flag) for flag in flags),
        why=str(claim.get("why", "")),
    )


def _holds(value: Any) -> str:
    """A verdict on a case: null is open."""
    return "open" if value is None else "yes" if value else "no"


def _cases(cases: Any) -> tuple[CaseRow, ...]:
    """The cases of a claim or reading."""
    return tuple(_case_row(case) for case in cases or [])


def _numbers(numbers: Any) -> tuple[CaseRow, ...]:
    """Plain named numbers as cases that ask for nothing."""
    pairs = numbers.items() if isinstance(numbers, dict) else []
    return tuple(CaseRow("", split_unit(key)[0] or plain(key), quantity(key, value), "", "") for key, value in pairs)


def _case_row(case: dict[str, Any]) -> CaseRow:
    """One case in words."""
    name = str(case.get("observable", ""))
    suffix = _UNIT_SUFFIX.get(str(case.get("unit", "")), "")
    against = ""
    if case.get("against"):
        other = str(case.get("against_scene") or "").split("_")[0]
        against = f" against {plain(str(case['against']))}" + (f" of {plain(other)}" if other else "")
    parameters = ", ".join(
        f"{split_unit(key)[0]} {quantity(key, value)}" for key, value in (case.get("parameters") or {}).items()
    )
    what = f"{plain(str(case.get('variant', '')))}{against}: {split_unit(name)[0]}"
    return CaseRow(
        holds=_holds(case.get("holds")),
        what=what + (f" ({parameters})" if parameters else ""),
        measured=_measured(case, suffix),
        asked=_asked(case, suffix),
        note="; ".join([str(case["note"])] if case.get("note") else []),
    )


def _written(value: float, suffix: str) -> str:
    """A number in the printed unit of its suffix."""
    return quantity(suffix, float(value)) if suffix else number(float(value))


def _measured(case: dict[str, Any], suffix: str) -> str:
    """What was measured: a number, a bound where the run ended first, or nothing."""
    low, high, value = case.get("low"), case.get("high"), case.get("value")
    if low is not None and high is not None and low != high:
        return f"{_written(low, suffix)} to {_written(high, suffix)}"
    if low is not None and high is None:
        return f"at least {_written(low, suffix)}"
    if high is not None and low is None:
        return f"at most {_written(high, suffix)}"
    return "nothing to measure" if value is None else _written(value, suffix)


def _asked(case: dict[str, Any], suffix: str) -> str:
    """The bounds that the claim asks for."""
    bounds = [
        f"{sign} {_written(case[key], suffix)}"
        for key, sign in (("at_least", "≥"), ("at_most", "≤"))
        if case.get(key) is not None
    ]
    return " and ".join(bounds)
