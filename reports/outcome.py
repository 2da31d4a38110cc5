"""What a run did, told from its events: start, arrests, restarts, end; sentences that say so; and what inertia changes: the same variant in both mechanics."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from reports.figures import words_of
from reports.runs import INTERFACE, Arrays, NotAvailable, Run, interfaces_at, layout_of, output_times, settings_between
from reports.words import Shown, listed, metres, millimetres, mpa, plain
from verification.harness.observables import BY_J, distances_to, path_length, resample
from verification.harness.scenes import MECHANICS

ARREST_PA = 0.05e6  # the rise of inlet pressure without growth that makes an arrest
REACH_CELLS = 4.0  # so far the J rings of a tip reach an interface, and energy decides instead where it may
NEAR_CELLS = 1.5


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

    @property
    def flag(self) -> str:
        """What is to be said of an arrest that rests on J at an interface; nothing where energy decides likewise."""
        return BY_J if self.by_J and not self.confirmed else ""

    @property
    def tells(self) -> bool:
        """Whether it is more than a pause: at an interface, or to the end."""
        return self.interface is not None or self.until_Pa is None


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

    @property
    def longest(self) -> Arrest | None:
        """The arrest over the widest range of inlet pressure: of those that are more than pauses, if there are any."""
        telling = [arrest for arrest in self.arrests if arrest.tells]
        return max(telling or self.arrests, default=None,
                   key=lambda arrest: (self.final_inlet_Pa if arrest.until_Pa is None else arrest.until_Pa) - arrest.from_Pa)


def outcome_of(run: Run, runs: Sequence[Run] = ()) -> Outcome:
    """What the run's events and last row say; an arrest that its bonded twin among the runs shares is a pause."""
    if not run.drawable:
        raise NotAvailable(f"{run.experiment}/{run.variant}: {run.reason or 'no history'}")
    heights, inlet = run.history["height_m"], run.history["inlet_Pa"]
    return Outcome(
        variant=run.variant, status=run.status, start_Pa=event_inlet(run, "start"), reached_Pa=event_inlet(run, "reach_interface"),
        arrests=_confirmed(_own(arrests_of(run), run, runs), run, runs), final_height_m=float(heights[-1]), final_inlet_Pa=float(inlet[-1]),
        grew=float(np.max(heights)) > float(heights[0]) + 0.25 * run.cell_m,
    )


def _own(arrests: tuple[Arrest, ...], run: Run, runs: Sequence[Run]) -> tuple[Arrest, ...]:
    """The arrests; those that last no longer where interfaces are bonded lose their interface: they are pauses."""
    twin = next((other for other in runs if other is not run and other.drawable and _is_twin(other, run)), None)
    theirs = arrests_of(twin) if twin else ()

    def shared(arrest: Arrest) -> bool:
        """Whether the bonded twin stops at the same height for nearly as long."""
        return arrest.until_Pa is not None and any(
            abs(other.height_m - arrest.height_m) < 0.25 * run.cell_m
            and arrest.until_Pa - arrest.from_Pa < (other.until_Pa or other.from_Pa) - other.from_Pa + ARREST_PA for other in theirs)

    return tuple(replace(arrest, interface=None) if shared(arrest) else arrest for arrest in arrests)


def _confirmed(arrests: tuple[Arrest, ...], run: Run, runs: Sequence[Run]) -> tuple[Arrest, ...]:
    """The arrests; those by J at an interface say whether the same variant without inertia is arrested there by energy."""
    other = next((one for one in runs if one.variant == run.variant and one.experiment == run.experiment
                  and one.mechanics != run.mechanics and one.drawable and one.status == "completed"), None)
    if other is None:
        return arrests
    theirs = [arrest.height_m for arrest in arrests_of(other) if not arrest.by_J]
    found = [any(abs(height_m - arrest.height_m) <= NEAR_CELLS * run.cell_m for height_m in theirs) for arrest in arrests]
    return tuple(replace(arrest, confirmed=there) if arrest.by_J else arrest for arrest, there in zip(arrests, found))


def _is_twin(other: Run, run: Run) -> bool:
    """Whether another run has perfect interfaces and else the same settings."""
    perfect = all(name == "perfect" for name in other.scene["strata"].get("interfaces", []))
    return perfect and all(key.startswith(INTERFACE) for key, _, _ in settings_between(other, run))


def event_inlet(run: Run, kind: str) -> float | None:
    """Inlet pressure of the first event of a kind, Pa."""
    return next((float(event["inlet_Pa"]) for event in run.events if event.get("kind") == kind), None)


def arrests_of(run: Run) -> tuple[Arrest, ...]:
    """Every arrest with the restart that ended it, if one did."""
    events = [event for event in run.events if event.get("kind") in ("arrest", "restart")]
    arrests: list[Arrest] = []
    for event, follower in zip(events, [*events[1:], {"kind": "", "inlet_Pa": 0.0}]):
        if event["kind"] == "arrest":
            until = float(follower["inlet_Pa"]) if follower["kind"] == "restart" else None
            by_J = event.get("by") == "J" and bool(event.get("at_interface"))  # too near to an interface to be trusted
            name, beyond_m = interface_near(run, event, by_J or event.get("by") == "energy")
            arrests.append(Arrest(float(event["tip_y_m"]), float(event["inlet_Pa"]), until, name, beyond_m, by_J))
    return tuple(arrests)


def interface_near(run: Run, event: dict[str, Any], in_reach: bool) -> tuple[str | None, float]:
    """The nearest imperfect interface, if within a cell and a half or in reach of the J rings, and the tip past it, m."""
    layout = layout_of(run)
    at = float(event["tip_y_m"] if layout.along == "y" else event["tip_x_m"])
    nearest = min((place for place in layout.interfaces if place.law != "perfect"), key=lambda place: abs(at - place.at_m), default=None)
    cells = REACH_CELLS + 0.5 if in_reach else NEAR_CELLS  # half a cell: where an increment within the reach may end
    if nearest is None or abs(at - nearest.at_m) > cells * run.cell_m:
        return None, 0.0
    return nearest.name, at - nearest.at_m


def outcomes_of(runs: Sequence[Run]) -> list[Outcome]:
    """The outcomes of those runs that have a history."""
    return [outcome_of(run, runs) for run in runs if run.drawable]


def _phrase(outcome: Outcome) -> tuple[str, str]:
    """What happened as (words shared by like outcomes, words of this one)."""
    end = mpa(outcome.final_inlet_Pa)
    if outcome.status != "completed":
        return "failed" if outcome.status == "failed" else "not finished", f"at {end}"
    if not outcome.grew:
        return "never grew", f"up to {end}"
    arrest = outcome.longest
    if arrest is None or not arrest.tells:
        pause = "" if arrest is None else f" (pausing at {metres(arrest.height_m)})"
        return f"grew to {metres(outcome.final_height_m)}", f"by {end}{pause}"
    until = f"from {arrest.from_Pa / 1e6:.2f} to {end + ', the end' if arrest.until_Pa is None else mpa(arrest.until_Pa)}"
    others = list(dict.fromkeys(metres(other.height_m) for other in outcome.arrests if other is not arrest and other.interface))
    return f"stopped at {metres(arrest.height_m)}{_where(arrest)}", until + (f" (and at {listed(others)})" if others else "")


def _where(arrest: Arrest) -> str:
    """How far an arrest is past or before its interface, where that is not next to nothing."""
    distance = abs(arrest.beyond_m)
    if arrest.interface is None or distance < 0.25:
        return ""
    return f" ({metres(distance)} {'past' if arrest.beyond_m > 0 else 'before'} the {arrest.interface} interface)"


def finding(outcomes: Iterable[Outcome]) -> str:
    """What was found, like outcomes told together."""
    groups: dict[str, dict[str, list[str]]] = {}
    for outcome in outcomes:
        shared, own = _phrase(outcome)
        groups.setdefault(shared, {}).setdefault(own, []).append(plain(outcome.variant))
    parts = []
    for shared, alike in groups.items():
        (own, names), *others = alike.items()
        parts.append(", ".join([f"{listed(names)} {shared} {own}", *(f"{listed(more)} {words}" for words, more in others)]))
    return "; ".join(parts) or "no run to tell of"


def held(run: Run, runs: Sequence[Run]) -> str:
    """The longest arrest of a run among its experiment's in words; empty where there is none."""
    arrest = outcome_of(run, runs).longest
    if arrest is None:
        return ""
    during = f"{mpa(arrest.from_Pa)} to the end" if arrest.until_Pa is None else f"{arrest.from_Pa / 1e6:.2f} to {mpa(arrest.until_Pa)}"
    return f"{metres(arrest.height_m)}, {during}"


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
    acting = float(np.mean(last["split"] > 0))
    if acting == 0.0:
        return "intact"
    slip, gap = (max(float(np.abs(fields[name]).max()) for fields in moved) for name in ("slip_m", "opening_m"))
    whole = "all" if acting == 1.0 else metres(acting * float(np.hypot(np.ptp(last["x_m"]), np.ptp(last["y_m"]))))
    return f"{whole}, slip {millimetres(slip)}, opening {millimetres(gap)}"


LEAST_STRAIN = 0.01  # of its largest: with less strain energy than that, no ratio to it is taken


def comparisons(runs: Sequence[Run]) -> list[Shown]:
    """Every variant that can be drawn in both mechanics, in the order of the runs: in what they are unlike, and the largest ratio of kinetic to strain energy."""
    of = {(run.experiment, run.variant, run.mechanics): run for run in runs if run.drawable}
    pairs = [[of.get((*name, mechanics)) for mechanics in MECHANICS] for name in dict.fromkeys((run.experiment, run.variant) for run in runs)]
    return [_comparison(static, moving, runs) for moving, static in pairs if moving is not None and static is not None]


def _comparison(static: Run, moving: Run, runs: Sequence[Run]) -> Shown:
    """One variant without (static) and with inertia."""
    own = [run for run in runs if run.experiment == static.experiment]
    without, with_ = outcome_of(static, own), outcome_of(moving, own)
    stays = [arrest if (arrest := one.longest) is not None and arrest.tells else None for one in (without, with_)]
    return Shown(number=static.number, variant=static.variant, kinetic_ratio=kinetic_ratio(moving), unlike=_unlike(*stays, without, with_, static.cell_m))


def _unlike(first: Arrest | None, other: Arrest | None, without: Outcome, with_: Outcome, cell_m: float) -> tuple[str, ...]:
    """In what the two do not do the same thing."""
    found = []
    if (first is None) != (other is None):
        found.append(f"arrested only {'without' if other is None else 'with'} inertia")
    elif first is not None and other is not None and abs(first.height_m - other.height_m) > 1.5 * cell_m:
        found.append("arrested elsewhere")
    elif first is not None and other is not None and (first.until_Pa is None) != (other.until_Pa is None):
        found.append(f"driven on only {'with' if first.until_Pa is None else 'without'} inertia")
    if abs(without.final_height_m - with_.final_height_m) > 1.5 * cell_m:
        found.append("ends at another height")
    return tuple(found)


def path_distance(run: Run, other: Run) -> float | None:
    """Root mean square distance between two paths over the length both have, m; None where one has not grown."""
    paths = (run.path_m, other.path_m)
    if any(len(path) < 3 for path in paths):
        return None
    common = min(path_length(path) for path in paths)
    points = resample(paths[0], 0.25)[: int(common / 0.25) + 1]
    return float(np.sqrt(np.mean(distances_to(points, paths[1]) ** 2)))


def shift_Pa(run: Run, other: Run) -> float:
    """Largest distance between the inlet pressures of two runs at which the tip first comes to whole metres that both reach, Pa."""
    tops = [float(np.max(one.history["height_m"])) for one in (run, other)]
    foot = max(float(one.history["height_m"][0]) for one in (run, other))
    heights = np.arange(np.floor(foot) + 1.0, min(tops) + 1e-6) - 0.05  # so near counts as there
    if heights.size == 0:
        return 0.0
    first, second = (one.history["inlet_Pa"][np.searchsorted(np.maximum.accumulate(one.history["height_m"]), heights)] for one in (run, other))
    return float(np.max(np.abs(first - second)))


def kinetic_ratio(run: Run) -> float | None:
    """Largest ratio of kinetic to strain energy, over rows with at least a hundredth of the largest strain energy."""
    if not {"kinetic_J", "strain_J"} <= run.history.keys():
        return None
    kinetic, strain = run.history["kinetic_J"], run.history["strain_J"]
    enough = np.isfinite(kinetic) & np.isfinite(strain) & (strain > LEAST_STRAIN * np.nanmax(np.abs(strain)))
    return float(np.max(kinetic[enough] / strain[enough])) if enough.any() else None


def inertia_words(rows: Sequence[Shown]) -> str:
    """Whether inertia mattered, in a sentence or two; nothing where no variant was run in both mechanics."""
    known = [row for row in rows if row.kinetic_ratio is not None]
    if not known:
        return ""
    worst = max(known, key=lambda row: row.kinetic_ratio)
    return words_of("inertia", rows=rows, unlike=[row for row in rows if row.unlike], half=float(np.median([row.kinetic_ratio for row in known])), worst=worst)
