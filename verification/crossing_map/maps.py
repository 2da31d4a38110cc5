"""Maps: what their axes are called, their scenes, and their tables as they are kept."""

import csv
import math
import re
from dataclasses import dataclass, fields
from pathlib import Path

from verification.crossing_map.verdict import Verdict

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
