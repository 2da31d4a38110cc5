"""What a family of the stability atlas is: scenes that walk across the edge of what a method can do, and what must hold of each.

A family only describes; running, judging and keeping (runner.py) and drawing (reports/stability.py) are elsewhere.
`verification/stability/families/*.py` list theirs as FAMILIES.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

from verification.harness.load import E_prime, Run, half_length, path_key
from verification.harness.paths import ROOT

SCENES = ROOT / "verification" / "stability" / "scenes"

# How a point ended.
STABLE = "stable"  # completed, the check holds, nothing is suspect
MARKED = "marked"  # completed, and the run says itself that it is not to be trusted
REFUSED = "refused"  # exit 2 with its text
FAILED = "failed"  # exit 3 with its reason and the last good state
GARBAGE = "garbage"  # completed, not marked, and the check does not hold (or a run that ended in no such way): must never be
OUTCOMES = (STABLE, MARKED, REFUSED, FAILED, GARBAGE)
SAFE = (STABLE, MARKED, REFUSED, FAILED)  # what a family may declare of its points beyond the edge

KINEMATICS = {"total": "points in their places", "updated": "points that move"}

LEAST_REFUSED = 0.9  # no check may hold for a value that is off by more than this: zero and twice must fail


@cache
def words() -> dict[str, dict[str, str]]:
    """What the page says of sections, by their headings, and of families, by their names."""
    return tomllib.loads((SCENES.parent / "words.toml").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Checked:
    """What a check found: the value, what it is to be, the relative error, whether that is good enough, and words for the table."""

    value: float
    reference: float
    error: float
    holds: bool
    words: str = ""

    def rounded(self) -> Checked:
        """The same with numbers of seven digits."""
        return replace(self, **{name: float(f"{getattr(self, name):.7g}") for name in ("value", "reference", "error")})


Check = Callable[[Run], Checked]  # may raise LoadError: then nothing is known of the run, which is garbage


def close(value: float, reference: float, tolerance: float, words: str = "", scale: float | None = None) -> Checked:
    """A value that is to be within `tolerance` of a reference, relative to it, or to `scale` (same unit, > 0) where that is zero. Raises ValueError
    for a tolerance by which zero would pass."""
    size = abs(reference) if scale is None else scale
    if not 0.0 < tolerance <= LEAST_REFUSED or not size > 0.0:
        raise ValueError(f"a tolerance of {tolerance:g} of {size:g} would let anything pass")
    error = (value - reference) / size
    return Checked(value, reference, error, math.isfinite(error) and abs(error) <= tolerance, words)


def at_most(value: float, bound: float, words: str = "") -> Checked:
    """A size (>= 0) that is to stay below a bound; the error is value / bound, so that 1 is the edge of what passes."""
    return Checked(value, bound, value / bound, math.isfinite(value) and 0.0 <= value <= bound, words)


@dataclass(frozen=True)
class Point:
    """A scene with settings, at a value of the walked parameter. smoke: run in ci/test too; of each family two or three fast ones, on both sides of its
    edge. beyond: whether it is beyond the edge, where that does not follow from the value."""

    label: str  # unique in its family, as in a file name
    value: float
    scene: Path
    settings: tuple[str, ...] = ()
    variant: str = ""
    smoke: bool = False
    beyond: bool | None = None


At = Callable[[float], Point]


def at_values(scene: Path, keys: Callable[[float], tuple[str, ...]], label: str = "{:.5g}", variant: str = "") -> At:
    """The points of a scene at values of the parameter, with the scene keys that each asks for."""
    return lambda value: Point(label.format(value), value, scene, keys(value), variant)


def walked(at: At, values: Iterable[float], smoke: Collection[float] = (), beyond: Callable[[float], bool | None] = lambda _: None) -> tuple[Point, ...]:
    """The points at some values, of which those in `smoke` are run in ci/test too; `beyond` as in Point."""
    return tuple(replace(at(value), smoke=value in smoke, beyond=beyond(value)) for value in values)


@dataclass(frozen=True)
class Edge:
    """Where a family ceases to be sound. predicted: computed by Python or strata-reference without the solver, None where no theory gives it; source:
    whose theory, and how it was computed, a sentence. at: the point at any value, by which the edge is measured: bisection in `bracket` (sound end
    first) until the ends differ by `resolution` of the value. Without it the edge is read from the points' runs by `read`. A difference of more than
    `tolerance` is a failure."""

    source: str
    predicted: Callable[[], float] | None = None
    at: At | None = None
    bracket: tuple[float, float] = (0.0, 0.0)
    resolution: float = 0.005
    tolerance: float = 0.03
    unsound_above: bool = True
    by_check: bool = False  # bisection goes by whether the check holds, marked or not, where marks begin elsewhere
    read: Callable[[Mapping[str, Run]], float] | None = None  # of completed runs by the labels of their points


@dataclass(frozen=True)
class Parameter:
    """What is walked."""

    name: str
    unit: str = ""
    log: bool = False


def tip_is_near(run: Run) -> str:
    """The mark of a run that has a tip too near to something for its J and K: to what."""
    near = sorted({tip["near"] for tip in run.summary.raw["tips"] if tip["near"]})
    return f"a tip is near: {', '.join(near)}; J and K there are not to be trusted" if near else ""


@dataclass(frozen=True)
class Family:
    """A known failure, walked across. beyond: what strata does beyond the edge, any of SAFE; without an edge all points must be so. section: families
    of the same section (of words.toml) share a heading, what is said below it, and a figure. check_name: what is on the figure's vertical axis. flag:
    words for a completed run that is marked otherwise than by `suspect`."""

    name: str  # unique over all families, as in a file name
    title: str
    says: str
    parameter: Parameter
    points: tuple[Point, ...]
    check: Check
    beyond: tuple[str, ...] = (STABLE,)
    edge: Edge | None = None
    section: str = ""
    check_name: str = "relative error"
    flag: Callable[[Run], str] = lambda _: ""
    before: tuple[str, ...] = (STABLE,)  # outcomes of points before the edge, which bisection takes as sound: with MARKED only for a reason

    @property
    def about(self) -> str:
        """What is said below the heading of its section."""
        return words()["section"].get(self.section, "")

    @property
    def remark(self) -> str:
        """What the walk showed."""
        return words()["remark"].get(self.name, "")


def bisected(sound: Callable[[float], bool], good: float, bad: float, resolution: float) -> tuple[float, float]:
    """Where something ceases to hold: the last sound and first unsound value, halving what is between until they differ by `resolution` of the larger
    one. Raises ValueError where the first is not sound or the second one is."""
    if not sound(good) or sound(bad):
        raise ValueError(f"{good:g} and {bad:g} do not enclose the edge")
    while abs(bad - good) > resolution * max(abs(good), abs(bad)):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if sound(middle) else (good, middle)
    return good, bad


# What the families with a pressurised crack share: the scene, where the crack lies, the closed forms it is held against.
CRACK = SCENES / "crack.toml"
NET_PA = 0.3e6  # the scenes' pressure above their closing stress
HALF_LENGTH_M = 5.0
MIDDLE_M = 16.0  # of the scenes' block

AT_REST = ("numerics.mechanics=quasistatic", "stop.time_s=0")
# The same crack settled by damping, near twice the slowest mode that matters.
SETTLING = ("numerics.mechanics=explicit", "numerics.kinematics=total", "numerics.damping_1_s=40", "stop.time_s=0.8", "output.fields_every_s=0.8")


def upright(x_m: float, top_m: float, length_m: float = 2.0 * HALF_LENGTH_M) -> str:
    """A crack along y with its upper tip at a height, as a scene key."""
    return path_key((x_m, top_m - length_m), (x_m, top_m))


def layers_setting(*layers: tuple[str, float | None], interfaces: tuple[str, ...] = ()) -> tuple[str, ...]:
    """The layers (rock, thickness in m; None: the rest) and the interfaces between them, as scene keys."""
    tables = ",".join(f'{{rock="{rock}"' + ("" if size is None else f",thickness_m={size!r}") + "}" for rock, size in layers)
    names = ",".join(f'"{name}"' for name in interfaces)
    return (f"strata.layers=[{tables}]",) + ((f"strata.interfaces=[{names}]",) if interfaces else ())


def parted(below: str, above: str, *interfaces: str) -> tuple[str, ...]:
    """Two rocks that meet in the middle of the block, at an interface where one is named, as scene keys."""
    return layers_setting((below, MIDDLE_M), (above, None), interfaces=interfaces)


def griffith_K(run: Run) -> float:
    """K_I = p sqrt(pi a) of the crack in one rock without end, Pa sqrt(m) (Griffith, Sneddon)."""
    return NET_PA * math.sqrt(math.pi * half_length(run))


def sneddon_opening(run: Run) -> float:
    """Largest opening 4 p a/E' of the crack in one rock without end, m (Sneddon)."""
    return 4.0 * NET_PA * half_length(run) / E_prime(run)


def farthest_off(found: list[float], wanted: float) -> float:
    """Of several values the one that is farthest from what is wanted."""
    return max(found, key=lambda value: abs(value - wanted) if math.isfinite(value) else math.inf)


def worse(*checks: Checked) -> Checked:
    """Of several checks the one that is farthest off its own tolerance: one that fails before one that holds, then the larger error."""
    return max(checks, key=lambda checked: (not checked.holds, abs(checked.error)))
