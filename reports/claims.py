"""The harness's verdicts as rows of a table, which of the study's claims survive which choice, as a table of plain cells, and what each choice at a point that
the study leaves open moves at most, against the default that it stands for."""

from collections.abc import Sequence

import numpy as np

from reports.outcome import event_inlet, path_distance, shift_Pa
from reports.runs import Run, layout_of, mechanics_in
from reports.words import NONE, Shown, mechanics_name, metres, mpa, number, plain, quantity, split_unit
from verification.harness.claims import NOT_EVALUATED, NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, CaseResult, Choice, ClaimResult, Point, Reading
from verification.harness.scenes import MECHANICS

KINDS: dict[str, str] = {REPRODUCED: "yes", ONLY_UNDER_A_VARIANT: "partly", NOT_REPRODUCED: "no", NOT_EVALUATED: "open"}
HOLDS: dict[bool | None, str] = {True: "yes", False: "no", None: "open"}
SYMBOLS: dict[str, str] = {"yes": "✓", "part": "(✓)", "no": "✗", "open": "?", "none": ""}
_UNIT_SUFFIX: dict[str, str] = {"Pa": "Pa", "m": "m", "degrees": "deg", "deg": "deg", "s": "s", "J/m": "J"}


def claim_rows(claims: Sequence[ClaimResult]) -> list[Shown]:
    """Every claim as a row, in the order of their ids, with the verdict of each mechanics that anything was evaluated in."""
    return [_claim_row([one for one in claims if one.id == id_]) for id_ in sorted({one.id for one in claims})]


def columns_of(rows: Sequence[Shown]) -> list[Shown]:
    """The columns of verdicts, finest cells and no inertia first: key and words."""
    found = dict.fromkeys(one.mechanics for row in rows for one in row.verdicts)
    cells = {key: key.partition("inertia")[2].strip() for key in found}
    ordered = sorted(found, key=lambda key: (not cells[key], not key.startswith(mechanics_name("quasistatic"))))
    return [Shown(key=key, words=f"{cells[key] or '1 m'} cells, {key.removesuffix(cells[key]).strip()}") for key in ordered]


def differing(rows: Sequence[Shown], cells: str) -> list[str] | None:
    """Ids of the claims on which runs with and without inertia in cells of a size (" 0.5 m"; "": the scenes' own) differ; None where these were not judged."""
    pairs = {row.id: [one.verdict for one in row.verdicts if one.mechanics in [mechanics_name(name + cells) for name in MECHANICS]] for row in rows}
    pairs = {id_: found for id_, found in pairs.items() if len(found) == 2}
    return [id_ for id_, found in pairs.items() if found[0] != found[1]] if pairs else None


def by_verdict(rows: Sequence[Shown], mechanics: str) -> dict[str, list[Shown]]:
    """The claims of each verdict in one mechanics."""
    given = {row.id: one.verdict for row in rows for one in row.verdicts if one.mechanics == mechanics}
    return {name: own for name in KINDS if (own := [row for row in rows if given.get(row.id) == name])}


def _claim_row(results: Sequence[ClaimResult]) -> Shown:
    """One claim's row from its results, one a mechanics; each of its readings with what all mechanics that have it found."""
    first = results[0]
    verdicts = [Shown(mechanics=mechanics_name(one.mechanics), verdict=one.verdict, kind=KINDS.get(one.verdict, "open"), flags=one.flags)
                for one in results]
    readings = []
    for name in dict.fromkeys(reading.name for one in results for reading in one.readings):
        own = [(one.mechanics, reading) for one in results for reading in one.readings if reading.name == name]
        readings.append(Shown(name=name, partial=not own[0][1].complete, cases=_case_rows([(mechanics, one.cases) for mechanics, one in own]),
                              holds=tuple((mechanics_name(mechanics), HOLDS[one.holds]) for mechanics, one in own)))
    return Shown(id=first.id, text=first.text, why=first.why, verdicts=verdicts, cases=_case_rows([(one.mechanics, one.cases) for one in results]),
                 readings=readings)


def _case_rows(results: Sequence[tuple[str, Sequence[CaseResult]]]) -> list[Shown]:
    """The cases of a claim or reading, the same ones in each mechanics: what was asked and what each mechanics found, in words."""
    rows = []
    for together in zip(*(cases for _, cases in results)):
        found = [Shown(mechanics=mechanics_name(mechanics), holds=HOLDS[case.holds], measured=_measured(case), note=case.note)
                 for (mechanics, _), case in zip(results, together)]
        asked, suffix = together[0], _UNIT_SUFFIX.get(together[0].unit, "")
        bounds = [f"{sign} {_written(bound, suffix)}" for bound, sign in ((asked.at_least, "≥"), (asked.at_most, "≤")) if bound is not None]
        rows.append(Shown(what=_what(together[0]), asked=" and ".join(bounds), found=found))
    return rows


def _what(case: CaseResult) -> str:
    """What a case is about."""
    against = ""
    if case.against:
        other = (case.against_scene or "").split("_")[0]
        against = f" against {plain(case.against)}" + (f" of {plain(other)}" if other else "")
    parameters = ", ".join(f"{split_unit(key)[0]} {_parameter(key, value)}" for key, value in case.parameters.items())
    return f"{plain(case.variant)}{against}: {split_unit(case.observable)[0]}" + (f" ({parameters})" if parameters else "")


def _parameter(key: str, value: object) -> str:
    """A parameter in words; a height above an interface says which."""
    if isinstance(value, dict) and "interface" in value:
        offset = float(value.get("plus_m", 0.0))
        beyond = "" if offset == 0.0 else f"{quantity('m', abs(offset))} {'above' if offset > 0 else 'below'} "
        return f"{beyond}interface {value['interface']}"
    return quantity(key, value)


def _written(value: float, suffix: str) -> str:
    """A number in the printed unit of its suffix."""
    return quantity(suffix, float(value)) if suffix else number(float(value))


def _measured(result: CaseResult) -> str:
    """What was measured: a number, a bound where the run ended first, or nothing."""
    low, high, suffix = result.low, result.high, _UNIT_SUFFIX.get(result.unit, "")
    if low is not None and high is not None and low != high:
        return f"{_written(low, suffix)} to {_written(high, suffix)}"
    if low is not None and high is None:
        return f"at least {_written(low, suffix)}"
    if high is not None and low is None:
        return f"at most {_written(high, suffix)}"
    return "nothing to measure" if result.value is None else _written(result.value, suffix)


# --- claims against open points
def sensitivity(claims: Sequence[ClaimResult], points: Sequence[Point]) -> Shown:
    """Every claim in every mechanics under the default and under each choice that any claim was evaluated under.

    points: id, words, how many columns; columns: a choice's name, the id of its point and whether it is the first of that; a cell's kind is 'yes',
    'part', 'no', 'open' or 'none', and the same in words; finding: what the table shows in a sentence.
    """
    used = {reading.choice for claim in claims for reading in claim.readings if reading.choice}
    shown = [(point, own) for point in points if (own := [choice for choice in point.choices if choice.id in used])]
    columns = [Shown(name=choice.name, point=point.id, starts=index == 0) for point, own in shown for index, choice in enumerate(own)]
    ids = [choice.id for _, own in shown for choice in own]
    lines: list[Shown] = []
    for id_ in sorted({claim.id for claim in claims}):
        same = [claim for claim in claims if claim.id == id_]
        for index, claim in enumerate(same):
            cells = [_cell(claim, "", ""), *(_choice_cell(claim, choice) for choice in ids)]
            lines.append(Shown(id=id_, text=claim.text, mechanics=mechanics_name(claim.mechanics), first=index == 0, lines=len(same), cells=cells))
    return Shown(points=[(point.id, point.open, len(own)) for point, own in shown], columns=columns, lines=lines, finding=_finding(lines))


def _choice_cell(claim: ClaimResult, choice: str) -> Shown:
    """A claim under a choice."""
    reading = next((one for one in claim.readings if one.choice == choice), None)
    if reading is None:
        return Shown(kind="none", words="not applicable")
    failing = [f"{plain(case.variant)}, {plain(case.observable.rsplit('_', 1)[0])}" for case in reading.cases if case.holds is False]
    variants = ", ".join(dict.fromkeys(plain(case.variant) for case in reading.cases))
    partly = "" if reading.complete else f"holds for {variants}, not run for others"
    return _cell(reading, partly, f": {'; '.join(failing)}")


def _cell(result: ClaimResult | Reading, partly: str, failing: str) -> Shown:
    """What became of a claim under the default or a choice; in these words where it holds only for some cases, or does not hold."""
    if result.holds is None:
        lacks = dict.fromkeys(case.note for case in result.cases if not case.evaluated)
        return Shown(kind="open", words="; ".join(lacks) or "a run ended before it could show this")
    if not result.holds:
        return Shown(kind="no", words=f"not reproduced{failing}")
    return Shown(kind="part", words=partly) if partly else Shown(kind="yes", words="reproduced")


def _finding(lines: Sequence[Shown]) -> str:
    """Which claims no choice overturns, and which depend on one; a choice that was run for some of the cases decides none."""
    found: dict[frozenset[str], list[str]] = {}
    for id_ in dict.fromkeys(line.id for line in lines):
        known = {cell.kind for line in lines if line.id == id_ for cell in line.cells} & {"yes", "no"}
        found.setdefault(frozenset(known), []).append(id_)
    firm, turned, never = (", ".join(found.get(frozenset(kinds), [])) or "none" for kinds in (("yes",), ("yes", "no"), ("no",)))
    return f"Reproduced under every choice and mechanics that was run: {firm}; reproduced under some and not under others: {turned}; under none: {never}."


SAME_PA = 500.0  # half of the last digit that tables show
Twins = Sequence[tuple[Run, Run]]  # a run of a choice with its default


def choice_rows(points: Sequence[Point], runs: Sequence[Run]) -> list[tuple[str, str, str, str]]:
    """A row a choice: open point, default, choice, and its largest effects in the mechanics that leads."""
    of = {(run.mechanics, run.experiment, run.variant): run for run in runs if run.drawable}
    return [(point.open, point.default, choice.name, _effect_words(_twins(choice, of))) for point in points for choice in point.choices]


def _twins(choice: Choice, of: dict[tuple[str, str, str], Run]) -> list[tuple[Run, Run]]:
    """The runs of a choice that there are, each with its default."""
    pairs = [((mechanics, experiment, name), (mechanics, experiment, kind)) for mechanics in dict.fromkeys(key[0] for key in of)
             for experiment, names in choice.runs.items() for kind, name in names.items() if name != kind]
    return [(of[one], of[other]) for one, other in pairs if one in of and other in of]


def _effect_words(twins: Twins) -> str:
    """The largest effects on start, climb and path, with the run they are seen in; a dash where nothing was run."""
    lead = mechanics_in(run for run, _ in twins)[-1:]
    starts, climbs, paths, ends = [], [], [], []
    for run, default in [(run, default) for run, default in twins if run.mechanics in lead]:
        name = f"{plain(default.variant)}, Experiment {run.number}"
        if layout_of(run).along == "x":
            distance = path_distance(run, default)
            paths += [] if distance is None else [(distance, name)]
            continue
        here, there = event_inlet(run, "start"), event_inlet(default, "start")
        starts += [] if here is None or there is None else [(here - there, name)]
        climbs += [(shift_Pa(run, default), name)]
        top, usual = (float(np.max(one.history["height_m"])) for one in (run, default))
        ends += [(top - usual, f"ends at {metres(top)} instead of {metres(usual)}", name)] if abs(top - usual) > 1.5 else []
    parts: list[tuple[str, str]] = []
    if starts:
        shift, name = max(starts, key=lambda item: abs(item[0]))
        parts.append(("the same start", "") if abs(shift) < SAME_PA else (f"start {mpa(shift, 3, '+')}", name))
    if climbs and max(climbs)[0] >= SAME_PA:
        parts.append((f"climb up to {mpa(max(climbs)[0], 3)} apart", max(climbs)[1]))
    if ends:
        parts.append(max(ends, key=lambda item: abs(item[0]))[1:])
    if paths:
        parts.append((f"path {number(max(paths)[0], 2)}\u00a0m away", max(paths)[1]))
    told = ", ".join(f"{words} ({name})" if name else words for words, name in parts)
    return f"{told}; {mechanics_name(lead[0])}" if told else NONE
