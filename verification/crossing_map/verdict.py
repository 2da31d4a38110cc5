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
