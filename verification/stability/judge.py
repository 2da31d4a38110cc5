"""Judges what was found of a family: no garbage, the edge where theory says, and beyond it what the family declares."""

import math

from verification.stability.family import GARBAGE, Family, Point
from verification.stability.store import Record


def side(family: Family, point: Point, record: Record) -> bool | None:
    """Whether a point is beyond the family's edge; None where it is so near (the edge's tolerance, or between its bounds) that it may be either.
    Without an edge all points are beyond: what is declared must hold everywhere."""
    if point.beyond is not None:
        return point.beyond
    if family.edge is None or record.edge is None:
        return True
    place = record.edge.measured if record.edge.predicted is None else record.edge.predicted
    if place is None:
        return None
    if abs(point.value - place) <= family.edge.tolerance * abs(place):
        return None
    return (point.value > place) == family.edge.unsound_above


def problem_of_point(family: Family, point: Point, record: Record) -> str:
    """What is wrong with a point's outcome, or nothing."""
    found = record.point(point.label)
    if found is None:
        return "not measured"
    if found.outcome == GARBAGE:
        return f"garbage: {found.reason or (found.checked.words if found.checked else '')}"
    beyond = side(family, point, record)
    allowed = {True: family.beyond, False: family.before, None: (*family.before, *family.beyond)}[beyond]
    if found.outcome in allowed:
        return ""
    where = {True: "beyond the edge", False: "before the edge", None: "at the edge"}[beyond]
    return f"{found.outcome} {where}, where it is to be {' or '.join(allowed)}"


def problems_of_edge(family: Family, record: Record) -> list[str]:
    """What is wrong with a family's edge."""
    edge, found = family.edge, record.edge
    if edge is None:
        return [] if found is None else ["an edge was measured that the family does not have"]
    if found is None or found.measured is None:
        return ["the edge was not found"]
    if edge.predicted is not None and found.difference is None:
        return ["the predicted edge was not computed"]
    if found.difference is not None and not abs(found.difference) <= edge.tolerance:
        return [f"the edge is {100.0 * found.difference:+.1f} % off what theory says ({found.measured:.4g} for {found.predicted:.4g})"]
    sides = {side(family, point, record) for point in family.points}
    return [] if True in sides and len(sides) > 1 else ["no points on both sides of the edge"]


def problems(family: Family, record: Record | None, smoke: bool = False) -> list[str]:
    """All that is wrong with a family; of a smoke run its smoke points alone, by the edge of `record`."""
    if record is None:
        return ["never measured: ci/atlas --accept"]
    told = {point.label: problem_of_point(family, point, record) for point in family.points if point.smoke or not smoke}
    labels = {point.label for point in family.points}
    gone = [f"{found.label}: no point of the family any more" for found in record.points if found.label not in labels]
    return [f"{label}: {problem}" for label, problem in told.items() if problem] + gone + ([] if smoke else problems_of_edge(family, record))


def changes(before: Record | None, now: Record) -> list[str]:
    """What is not as it was accepted: outcomes, errors by more than a fifth, edges by more than a hundredth."""
    if before is None:
        return [f"{now.family}: new"]
    told = []
    for point in now.points:
        old = before.point(point.label)
        if old is None:
            told.append(f"{now.family}, {point.label}: new, {point.outcome}")
        elif old.outcome != point.outcome:
            told.append(f"{now.family}, {point.label}: {old.outcome} before, {point.outcome} now")
        elif old.checked and point.checked and differs(old.checked.error, point.checked.error):
            told.append(f"{now.family}, {point.label}: error {old.checked.error:.3g} before, {point.checked.error:.3g} now")
    if before.edge and now.edge and before.edge.measured and now.edge.measured:
        if abs(now.edge.measured / before.edge.measured - 1.0) > 0.01:
            told.append(f"{now.family}: edge {before.edge.measured:.5g} before, {now.edge.measured:.5g} now")
    return told


def differs(before: float, now: float, share: float = 0.2, floor: float = 1e-6) -> bool:
    """Whether an error has changed by more than a share of itself and more than rounding makes of it; nan stays nan where a run tells no number."""
    if math.isnan(before) and math.isnan(now):
        return False
    return not abs(now - before) <= share * abs(before) + floor
