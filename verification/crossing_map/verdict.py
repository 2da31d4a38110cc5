"""What a fracture did at an interface: crossed it, stopped at it, or made it give way; and maps of that: axes, scenes, and tables as they are kept."""

import csv
import math
import re
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from verification.harness.load import Run, frames
from verification.harness.observables import SLACK_M, interface_height, length_m

CROSSES, STOPS, GIVES_WAY = "crosses", "stops", "gives way"

BEYOND_M = 2.0  # two increments: the tip has left the interface and K is its own again (solver/README.md: past 1 m it no longer counts as on it)
HELD_PA = 0.05e6  # the rise of the inlet that makes an arrest (contract of events)
WAY_M = 2.0  # of slip to one side: twice what one failure takes (failure_length_m 1 m), so it runs on by itself
SLIP_M = 1e-6  # parted or slid: faces that stick move by 1e-8 m (1 MPa over the contact's 1e14 Pa/m), the fracture opens by 1e-3 m


@dataclass(frozen=True)
class Verdict:
    """What it did, and by which numbers: pressure on arrival (Pa; NaN: it never came), rise until it was 2 m beyond (Pa; to the run's end where it never
    was), slid or parted length of the interface to the one side where it is longer, at the last output before it was beyond (m)."""

    verdict: str
    arrival_Pa: float
    rise_Pa: float
    passed: bool
    slid_m: float
    suspect: tuple[str, ...] = ()


def judged(rise_Pa: float, passed: bool, slid_m: float) -> str:
    """The verdict: giving way counts first, whatever the fracture does after it; what neither crosses nor gives way is stopped."""
    if slid_m >= WAY_M - SLACK_M:
        return GIVES_WAY
    return CROSSES if passed and rise_Pa <= HELD_PA else STOPS


def slid_length_m(arrays: dict[str, np.ndarray], number: int, at_m: float) -> float:
    """Length of interface `number` (from 1) that has slid or parted at an output, on the side of a place (x, m) where it is longer, m."""
    place = str(number - 1)
    x = arrays[f"{place}/x_m"]
    moved = np.maximum(np.abs(arrays[f"{place}/slip_m"]), arrays[f"{place}/opening_m"]) > SLIP_M
    return max(length_m(x, moved & side) for side in (x < at_m, x > at_m))


def verdict_of(run: Run) -> Verdict:
    """What a run's fracture did at the scene's last interface."""
    number = len(run.interfaces_m)
    height, tip, inlet = interface_height(run, number), run.history["tip_y_m"], run.history["inlet_Pa"]
    arrived, beyond = (np.flatnonzero(tip >= place - SLACK_M) for place in (height, height + BEYOND_M))
    passed = beyond.size > 0
    end = int(beyond[0]) if passed else len(tip) - 1
    arrival = float(inlet[arrived[0]]) if arrived.size else float("nan")
    rise = float(inlet[end]) - arrival
    before = [arrays for time_s, arrays in frames(run, "interfaces") if not passed or time_s < run.history["time_s"][end] - 1e-9]
    slid = slid_length_m(before[-1], number, float(run.path[-1][0])) if before else 0.0
    return Verdict(judged(rise, passed, slid), arrival, rise, passed, slid, tuple(mark.monitor for mark in run.summary.suspect))


def seen(run: Run) -> dict[str, Any]:
    """The verdict as a row of a sweep, numbers to five digits."""
    row = asdict(verdict_of(run))
    return {name: float(f"{value:.5g}") if isinstance(value, float) else value for name, value in row.items()} | {"suspect": " ".join(row["suspect"])}


HERE = Path(__file__).parent
RECORDS = HERE / "records"
FAILED = "failed"  # no verdict: the run has none


@dataclass(frozen=True)
class Axis:
    """A column of the table, and how it is drawn: its label, what its values are counted in, whether their ratios count."""

    key: str
    label: str
    unit: float = 1.0
    log: bool = False

    def value(self, row: dict[str, str]) -> float:
        """A row's place along the axis; of words (45 degrees) the number that they begin with."""
        return float(f"{float(row[self.key].split()[0]) / self.unit:.6g}")


@dataclass(frozen=True)
class Map:
    """A sweep over two axes (maps/NAME.toml) of the scene crossing.toml."""

    name: str
    x: Axis
    y: Axis

    def scene(self, folder: Path, size: int = 0) -> Path:
        """Write the map's scene, with so many values in each range where that is asked for."""
        sweep = (HERE / "maps" / f"{self.name}.toml").read_text(encoding="utf-8")
        path = folder / f"{self.name}.toml"
        path.parent.mkdir(parents=True, exist_ok=True)
        sweep = re.sub(r"count = \d+", f"count = {size}", sweep) if size else sweep
        path.write_text((HERE / "crossing.toml").read_text(encoding="utf-8") + sweep, encoding="utf-8")
        return path


INCLINED_MPa = (1.2, 0.5)  # along and across the inclined fracture


def bears(friction: float, angle_deg: float) -> bool:
    """Whether friction holds the interface of the inclined map under the in-situ stress, by a twentieth."""
    (along, across), turn = INCLINED_MPa, math.radians(angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    return (along - across) * s * c < 0.95 * friction * (along * s * s + across * c * c)


VERTICAL = Axis("in_situ.vertical_Pa", "stress normal to the interface (MPa)", 1e6, log=True)
FRICTION = Axis("interface.friction.coefficient", "friction")
CONTRAST = Axis("rock.beyond.youngs_modulus_Pa", "modulus beyond over that below", 10e9, log=True)
STRENGTH = Axis("interface.weak.shear_strength_Pa", "strength of the interface (MPa)", 1e6)
MAPS = {one.name: one for one in (
    Map("friction", VERTICAL, FRICTION),
    Map("weak", CONTRAST, STRENGTH),
    Map("contrast", CONTRAST, FRICTION),
    Map("strength", VERTICAL, STRENGTH),
    Map("closing", VERTICAL, Axis("in_situ.horizontal_Pa", "closing stress (MPa)", 1e6)),
    Map("increment", VERTICAL, Axis("fracture.increment_m", "increment (m)", log=True)),
    Map("inclined", FRICTION, Axis("title", "angle to the interface (degrees)")),
)}  # fmt: skip

Verdicts = dict[tuple[float, float], Verdict]  # of a map, by x and y


def read_table(one: Map, folder: Path = RECORDS) -> Verdicts:
    """A map's verdicts as they are kept; none where no table is. A run that failed has no verdict but its reason among the marks."""
    path = folder / f"{one.name}.csv"
    found: Verdicts = {}
    for row in csv.DictReader(path.read_text(encoding="utf-8").splitlines()) if path.is_file() else ():
        numbers = {item.name: float(row[item.name] or "nan") for item in fields(Verdict) if item.type is float}
        word, marks = (row["verdict"], tuple(row["suspect"].split())) if row["status"] == "completed" else (FAILED, (row["reason"],))
        found[one.x.value(row), one.y.value(row)] = Verdict(word, passed=row["passed"] == "True", suspect=marks, **numbers)
    return found


# --- published criteria of crossing, and closed forms of when an interface starts to slip
# Stresses s_v (normal to the interface) and s_h (closing the fracture) are positive in compression, net_Pa, strengths too; K in Pa sqrt(m).
Field = tuple[float, float, float]  # stress along the fracture, across it, and shear; tension positive


def tip_field(theta: float) -> Field:
    """The field of mode I over K_I/sqrt(2 pi r), at an angle (rad) from the fracture's direction (Williams 1957)."""
    half, more = 0.5 * theta, 1.5 * theta
    c, s = math.cos(half), math.sin(half)
    return c * (1.0 - s * math.sin(more)), c * (1.0 + s * math.sin(more)), s * c * math.cos(more)


def renshaw_pollard(friction: float, strength_Pa: float, closing_Pa: float) -> float:
    """The least s_v at which a fracture normal to an interface crosses: s_v/(T0 + s_h) = 0.35 (1 + 1/mu)/1.06 (Renshaw & Pollard 1995). Beyond the
    interface the field of the tip and s_h make T0 where the same field does not slide it."""
    return (strength_Pa + closing_Pa) * 0.35 * (1.0 + 1.0 / friction) / 1.06


def blanton(strength_Pa: float, closing_Pa: float) -> float:
    """The least s_v at which a fracture normal to an interface crosses: s_v - s_h = T0, whatever the friction (Blanton 1986, at 90 degrees)."""
    return closing_Pa + strength_Pa


def gu_weng(strength_Pa: float, along_Pa: float, closing_Pa: float, angle: float = 0.5 * math.pi) -> float:
    """The least friction with which a fracture crosses an interface at an angle (rad), infinite where that opens, by the idea of Gu & Weng (2010), written
    anew from it: in-situ stresses along the fracture and closing it, and the field of the tip on the interface, up to where the largest tension on one of
    its halves is T0; no half may then slide. At 90 degrees Renshaw & Pollard's but for the largest tension in place of that across the fracture."""
    halves = (angle, angle - math.pi)

    def stress(theta: float, k: float) -> np.ndarray:
        along, across, shear = (k * part for part in tip_field(theta))
        return np.array([[along - along_Pa, shear], [shear, across - closing_Pa]])

    low, high = 0.0, 1e3 * (strength_Pa + along_Pa + closing_Pa)
    for _ in range(60):  # K/sqrt(2 pi r) at which T0 is met: the largest eigenvalue is convex in it and below T0 without it
        k = 0.5 * (low + high)
        low, high = (low, k) if max(np.linalg.eigvalsh(stress(theta, k))[-1] for theta in halves) > strength_Pa else (k, high)
    normal, way = np.array([-math.sin(angle), math.cos(angle)]), np.array([math.cos(angle), math.sin(angle)])
    on = [(abs(way @ stress(theta, high) @ normal), -(normal @ stress(theta, high) @ normal)) for theta in halves]
    return max(float(shear / pressed) if pressed > 0.0 else math.inf for shear, pressed in on)


def first_slip(friction: float, K: float, distance_m: float) -> float:
    """s_v below which an interface slips somewhere ahead of a tip at a distance: the most that |shear|/mu + tension of the tip's field come to on it.
    K/(s_v sqrt(2 pi d)) = 0.8122 (mu 0.4), 0.8915 (0.6)."""
    angles = np.linspace(0.0, 0.499 * math.pi, 2001)
    fields = [(tip_field(theta), math.sqrt(math.cos(theta))) for theta in angles]
    return max((abs(shear) / friction + along) * root for (along, _, shear), root in fields) * K / math.sqrt(2.0 * math.pi * distance_m)


def griffith_means(half_length_m: float, over_m: float) -> tuple[float, float]:
    """Mean shear, and mean tension along the fracture, on the line normal to a Griffith crack at its tip, over a length from the tip, per net pressure
    (Westergaard 1939: Z = z/sqrt(z^2 - a^2) - 1)."""
    a, steps = half_length_m, 20000
    y = over_m * ((np.arange(steps) + 0.5) / steps) ** 2  # points gather at the tip, weights with them
    weights = 2.0 * ((np.arange(steps) + 0.5) / steps) / steps
    z = a + 1j * y
    Z, slope = z / np.sqrt(z * z - a * a) - 1.0, -a * a / (z * z - a * a) ** 1.5
    return float(np.sum(weights * np.abs(y * slope.real))), float(np.sum(weights * (Z.real - y * slope.imag)))


def mean_slip(friction: float, net_Pa: float, half_length_m: float, over_m: float) -> float:
    """s_v below which the mean shear over a length from a tip on the interface exceeds friction on the mean normal stress, bonded as it stands."""
    shear, tension = griffith_means(half_length_m, over_m)
    return net_Pa * (tension + shear / friction)
