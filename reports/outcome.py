"""What a run did, told from its events: start, arrests, restarts, end; and sentences that say so."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reports.layout import INTERFACE, layout_of, settings_between
from reports.runs import Arrays, NotAvailable, Run, interfaces_at, output_times
from reports.words import listed, metres, mpa, number, plain
from verification.harness.claim_data import BY_J

ARREST_PA = 0.05e6  # the rise of inlet pressure without growth that makes an arrest


@dataclass(frozen=True)
class Arrest:
    """A tip that stays: its height in m, inlet pressures in Pa from and until (None: to the end)."""

    height_m: float
    from_Pa: float
    until_Pa: float | None
    interface: str | None  # the interface it is at: within a cell and a half, or within reach of the J rings
    beyond_m: float  # how far past that interface, negative before it
    by_J: bool  # the criterion there was J alone, which is not to be trusted at an interface
    confirmed: bool | None = None  # whether the quasi-static run of the variant is arrested there by energy; None: not known


@dataclass(frozen=True)
class Outcome:
    """A run in short; m and Pa."""

    variant: str
    status: str
    start_Pa: float | None
    reached_Pa: float | None
    arrests: tuple[Arrest, ...]
    final_height_m: float
    final_inlet_Pa: float
    grew: bool


def outcome_of(run: Run, runs: Sequence[Run] = ()) -> Outcome:
    """What the run's events and last row say; an arrest that its bonded twin among the runs shares is a pause."""
    if not run.drawable:
        raise NotAvailable(f"{run.experiment}/{run.variant}: {run.reason or 'no history'}")
    heights, inlet = run.history["height_m"], run.history["inlet_Pa"]
    return Outcome(
        variant=run.variant,
        status=run.status,
        start_Pa=event_inlet(run, "start"),
        reached_Pa=event_inlet(run, "reach_interface"),
        arrests=_confirmed(_own(arrests_of(run), run, runs), run, runs),
        final_height_m=float(heights[-1]),
        final_inlet_Pa=float(inlet[-1]),
        grew=float(np.max(heights)) > float(heights[0]) + 0.25 * run.cell_m,
    )


def _own(arrests: tuple[Arrest, ...], run: Run, runs: Sequence[Run]) -> tuple[Arrest, ...]:
    """The arrests; those that last no longer where interfaces are bonded lose their interface: they are pauses."""
    twin = next((other for other in runs if other is not run and other.drawable and _is_twin(other, run)), None)
    theirs = arrests_of(twin) if twin else ()

    def shared(arrest: Arrest) -> bool:
        """Whether the bonded twin stops at the same height for nearly as long."""
        if arrest.until_Pa is None:
            return False
        for other in theirs:
            near = abs(other.height_m - arrest.height_m) < 0.25 * run.cell_m
            theirs_Pa = (other.until_Pa or other.from_Pa) - other.from_Pa
            if near and arrest.until_Pa - arrest.from_Pa < theirs_Pa + ARREST_PA:
                return True
        return False

    return tuple(replace(arrest, interface=None) if shared(arrest) else arrest for arrest in arrests)


def _confirmed(arrests: tuple[Arrest, ...], run: Run, runs: Sequence[Run]) -> tuple[Arrest, ...]:
    """The arrests; those by J at an interface say whether the same variant without inertia is arrested there by energy."""
    other = next((one for one in runs if one.variant == run.variant and one.experiment == run.experiment
                  and one.mechanics != run.mechanics and one.drawable and one.status == "completed"), None)
    if other is None:
        return arrests
    theirs = [arrest for arrest in arrests_of(other) if not arrest.by_J]

    def found(arrest: Arrest) -> bool:
        """Whether the other run is arrested within a cell and a half of the same height."""
        return any(abs(one.height_m - arrest.height_m) <= 1.5 * run.cell_m for one in theirs)

    return tuple(replace(arrest, confirmed=found(arrest)) if arrest.by_J else arrest for arrest in arrests)


def flag_of(arrest: Arrest) -> str:
    """What is to be said of an arrest that rests on J at an interface; nothing where energy decides likewise."""
    if not arrest.by_J or arrest.confirmed:
        return ""
    return BY_J


def _is_twin(other: Run, run: Run) -> bool:
    """Whether another run has perfect interfaces and else the same settings."""
    perfect = all(name == "perfect" for name in other.scene["strata"].get("interfaces", []))
    return perfect and all(key.startswith(INTERFACE) for key, _, _ in settings_between(other, run))


def event_inlet(run: Run, kind: str) -> float | None:
    """Inlet pressure of the first event of a kind, Pa."""
    for event in run.events:
        if event.get("kind") == kind:
            return float(event["inlet_Pa"])
    return None


def arrests_of(run: Run) -> tuple[Arrest, ...]:
    """Every arrest with the restart that ended it, if one did."""
    events = [event for event in run.events if event.get("kind") in ("arrest", "restart")]
    arrests: list[Arrest] = []
    for index, event in enumerate(events):
        if event["kind"] != "arrest":
            continue
        follower = events[index + 1] if index + 1 < len(events) else None
        until = float(follower["inlet_Pa"]) if follower and follower["kind"] == "restart" else None
        by_J = decided_by_J(run, event)
        name, beyond_m = interface_near(run, event, by_J or event.get("by") == "energy")
        arrests.append(Arrest(float(event["tip_y_m"]), float(event["inlet_Pa"]), until, name, beyond_m, by_J))
    return tuple(arrests)


def decided_by_J(run: Run, event: dict[str, Any]) -> bool:
    """Whether an event at a tip rests on a J too near to an interface to be trusted."""
    if event.get("by") == "J":
        return bool(event.get("at_interface"))
    if event.get("by"):
        return False
    if crossing_of(run) != "J":
        return False
    if "at_interface" in event:
        return bool(event["at_interface"])
    return interface_near(run, event)[0] is not None


def crossing_of(run: Run) -> str:
    """The criterion by which the run decides growth near an interface: 'J' or 'energy'."""
    named = run.scene.get("fracture", {}).get("crossing")
    return str(named or ("J" if run.scene.get("numerics", {}).get("mechanics") == "explicit" else "energy"))


REACH_CELLS = 4.0  # so far the J rings of a tip reach an interface, and energy decides instead where it may
NEAR_CELLS = 1.5


def interface_near(run: Run, event: dict[str, Any], in_reach: bool = False) -> tuple[str | None, float]:
    """The nearest imperfect interface, if within a cell and a half or in reach of the J rings, and the tip past it, m."""
    layout = layout_of(run)
    at = float(event["tip_y_m"] if layout.along == "y" else event["tip_x_m"])
    places = [place for place in layout.interfaces if place.law != "perfect"]
    nearest = min(places, key=lambda place: abs(at - place.at_m), default=None)
    cells = REACH_CELLS + 0.5 if in_reach else NEAR_CELLS  # half a cell: where an increment within the reach may end
    if nearest is None or abs(at - nearest.at_m) > cells * run.cell_m:
        return None, 0.0
    return nearest.name, at - nearest.at_m


def outcomes_of(runs: Sequence[Run]) -> list[Outcome]:
    """The outcomes of those runs that have a history."""
    return [outcome_of(run, runs) for run in runs if run.drawable]


def longest(outcome: Outcome) -> Arrest | None:
    """The arrest over the widest range of inlet pressure: of those at interfaces, or to the end, if there are any."""

    def width(arrest: Arrest) -> float:
        """Its range of inlet pressure, Pa."""
        until = outcome.final_inlet_Pa if arrest.until_Pa is None else arrest.until_Pa
        return until - arrest.from_Pa

    telling = [arrest for arrest in outcome.arrests if arrest.interface is not None or arrest.until_Pa is None]
    return max(telling or outcome.arrests, key=width, default=None)


def _phrase(outcome: Outcome) -> tuple[str, str]:
    """What happened as (words shared by like outcomes, words of this one)."""
    end = mpa(outcome.final_inlet_Pa)
    if outcome.status not in ("completed", "failed"):
        return "not finished", f"at {end}"
    if outcome.status == "failed":
        return "failed", f"at {end}"
    if not outcome.grew:
        return "never grew", f"up to {end}"
    arrest = longest(outcome)
    if arrest is None or (arrest.interface is None and arrest.until_Pa is not None):
        pause = "" if arrest is None else f" (pausing at {metres(arrest.height_m)})"
        return f"grew to {metres(outcome.final_height_m)}", f"by {end}{pause}"
    held = f"to the end at {end}" if arrest.until_Pa is None else f"until {mpa(arrest.until_Pa)}"
    return f"stopped at {metres(arrest.height_m)}{_where(arrest)}", held + _others(outcome, arrest)


def _where(arrest: Arrest) -> str:
    """How far an arrest is past or before its interface, where that is not next to nothing."""
    distance = abs(arrest.beyond_m)
    if arrest.interface is None or distance < 0.25:
        return ""
    return f" ({metres(distance)} {'past' if arrest.beyond_m > 0 else 'before'} the {arrest.interface} interface)"


def _others(outcome: Outcome, told: Arrest) -> str:
    """Where else an interface stopped the fracture, besides the arrest that is told."""
    places = [metres(arrest.height_m) for arrest in outcome.arrests if arrest is not told and arrest.interface]
    return f" (and at {listed(list(dict.fromkeys(places)))})" if places else ""


def finding(outcomes: Iterable[Outcome]) -> str:
    """One sentence on what was found, like outcomes told together."""
    groups: dict[str, list[tuple[str, str]]] = {}
    for outcome in outcomes:
        shared, own = _phrase(outcome)
        groups.setdefault(shared, []).append((plain(outcome.variant), own))
    parts: list[str] = []
    for shared, members in groups.items():
        alike: dict[str, list[str]] = {}
        for name, own in members:
            alike.setdefault(own, []).append(name)
        told = [(listed(names), own) for own, names in alike.items()]
        parts.append(", ".join([f"{told[0][0]} {shared} {told[0][1]}", *(f"{names} {own}" for names, own in told[1:])]))
    sentence = "; ".join(parts)
    return sentence[:1].upper() + sentence[1:] if sentence else "No run to tell of"


def interface_states(run: Run) -> list[str]:
    """For each interface that has a law, the length over which it acts at the end and its largest slip in the run."""
    try:
        count = output_times(run).size
        last = interfaces_at(run, count - 1)
        moved = [interfaces_at(run, index, ("slip_m", "opening_m")) for index in range(count)]
    except NotAvailable:
        return []
    return [_state(fields, [places[k] for places in moved]) for k, fields in enumerate(last)]


def _state(last: Arrays, moved: list[Arrays]) -> str:
    """One interface from its fields at the end and how far its faces have moved at all output times."""
    length = float(np.hypot(np.ptp(last["x_m"]), np.ptp(last["y_m"])))
    acting = float(np.mean(last["split"] > 0)) if "split" in last else 1.0
    slip = max((float(np.abs(fields["slip_m"]).max()) for fields in moved if "slip_m" in fields), default=0.0)
    gap = max((float(fields["opening_m"].max()) for fields in moved if "opening_m" in fields), default=0.0)
    if acting == 0.0:
        return "intact"
    whole = "all" if acting == 1.0 else metres(acting * length)
    return f"{whole}, slip {_millimetres(slip)}, opening {_millimetres(gap)}"


def _millimetres(length_m: float) -> str:
    """A small length in mm; what is under a hundredth is told as such."""
    return f"{number(1e3 * length_m, 2)}\u00a0mm" if length_m >= 1e-5 else "under 0.01\u00a0mm"
