"""Maps: two axes of scene keys, a run at each of their points, and the verdicts as a table."""

import csv
import math
import threading
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from functools import partial
from pathlib import Path

import numpy as np

from verification.crossing_map.verdict import Verdict, verdict_of
from verification.harness import store
from verification.harness.paths import RUNS
from verification.harness.plan import make
from verification.harness.run import Job
from verification.harness.side_by_side import Task, side_by_side

HERE = Path(__file__).parent
SCENE, RECORDS = HERE / "crossing.toml", HERE / "records"
FAILED = "failed"  # no verdict: the run has none
LIMIT_S = 120.0  # a hundred times what a run takes


@dataclass(frozen=True)
class Axis:
    """Values of a run: their column (with the unit) and label, the settings of a value, first and last value, even steps or ratios."""

    column: str
    label: str
    settings: Callable[[float], tuple[str, ...]]
    first: float
    last: float
    log: bool = False

    def values(self, count: int) -> list[float]:
        """So many values from the first to the last, to four digits."""
        steps = np.geomspace if self.log else np.linspace
        return [float(f"{value:.4g}") for value in steps(self.first, self.last, count)]


@dataclass(frozen=True)
class Map:
    """A variant of the scene over two axes, so many values of each; further settings of all its runs; whether the interface bears the in-situ stress:
    where it does not nothing is run."""

    name: str
    variant: str
    x: Axis
    y: Axis
    size: tuple[int, int] = (20, 20)
    settings: tuple[str, ...] = ()
    at_rest: Callable[[float, float], bool] = lambda x, y: True


Verdicts = dict[tuple[float, float], Verdict]  # of a map, by x and y


def key(name: str, scale: float = 1.0) -> Callable[[float], tuple[str, ...]]:
    """The settings that give a key a value."""
    return lambda value: (f"{name}={value * scale!r}",)


def strength(value: float) -> tuple[str, ...]:
    """Both strengths of the weak interface, MPa."""
    return tuple(f"interface.weak.{kind}_strength_Pa={value * 1e6!r}" for kind in ("shear", "tensile"))


def closing(value: float) -> tuple[str, ...]:
    """The stress that closes the fracture, MPa; the ramp starts there and ends 1.5 MPa above."""
    return (f"in_situ.horizontal_Pa={value * 1e6!r}", f"fluid.inlet.start_Pa={value * 1e6!r}", f"stop.inlet_Pa={(value + 1.5) * 1e6!r}")


def increment(value: float) -> tuple[str, ...]:
    """An increment of growth, m, which is the failure length too; the fracture starts one below the interface."""
    return (f"fracture.increment_m={value!r}", f"fracture.path_m=[[40,0],[40,{10.0 - value!r}]]")


def in_situ(angle_deg: float) -> tuple[float, float, float]:
    """Stress normal to the interface, along it, and shear on it (tension positive), MPa, of INCLINED_MPa along and across a fracture at an angle to it."""
    (along, across), turn = INCLINED_MPa, math.radians(angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    return along * s * s + across * c * c, along * c * c + across * s * s, (across - along) * s * c


def angle(value: float) -> tuple[str, ...]:
    """A fracture of two tips, 18 m long, at an angle (degrees) to the interface at 50 m, 1 m along its way below it; along and across it are the
    principal stresses. Its lower tip is in rock too tough to grow in."""
    normal, along, shear = in_situ(value)
    c, s = math.cos(math.radians(value)), math.sin(math.radians(value))
    stresses = (f"in_situ.{name}_Pa={stress * 1e6!r}" for name, stress in (("vertical", normal), ("horizontal", along), ("shear", shear)))
    start = INCLINED_MPa[1] * 1e6
    return (
        *stresses, f"fracture.path_m=[[{40 - 19 * c!r},{50 - 19 * s!r}],[{40 - c!r},{50 - s!r}]]", f"fluid.inlet.start_Pa={start!r}",
        f"stop={{tip_y_m=53,inlet_Pa={start + 1.5e6!r}}}", 'domain.bottom="traction"', 'strata.interfaces=["perfect","friction"]',
        'rock.tough={youngs_modulus_Pa=10e9,poisson_ratio=0.2,density_kg_m3=2500,toughness_Pa_sqrt_m=50e6}',
        'strata.layers=[{rock="tough",thickness_m=45},{rock="below",thickness_m=5},{rock="beyond"}]',
    )  # fmt: skip


def bears(friction: float, angle_deg: float) -> bool:
    """Whether friction holds the interface under the in-situ stress, by a twentieth."""
    normal, _, shear = in_situ(angle_deg)
    return abs(shear) < 0.95 * friction * normal


INCLINED_MPa = (1.2, 0.5)  # along and across the inclined fracture
VERTICAL = Axis("vertical_MPa", "stress normal to the interface (MPa)", key("in_situ.vertical_Pa", 1e6), 0.1, 10.0, log=True)
FRICTION, RATIO = key("interface.friction.coefficient"), key("rock.beyond.youngs_modulus_Pa", 10e9)
MAPS = {one.name: one for one in (
    Map("friction", "", VERTICAL, Axis("friction", "friction", FRICTION, 0.05, 1.0)),
    Map("weak", "weak", Axis("modulus_ratio", "modulus beyond over that below", RATIO, 0.1, 10.0, log=True),
        Axis("strength_MPa", "strength of the interface (MPa)", strength, 0.05, 1.0)),
    # Why strata and the criteria part, at friction 0.4: the closing stress, and the length over which slip and growth are judged.
    Map("closing", "", VERTICAL, Axis("closing_MPa", "closing stress (MPa)", closing, 1.0, 4.0), (20, 3)),
    Map("increment", "", VERTICAL, Axis("increment_m", "increment (m)", increment, 0.5, 2.0, log=True), (20, 3), ("numerics.cell_m=0.25",)),
    Map("inclined", "", Axis("friction", "friction", FRICTION, 0.2, 1.0), Axis("angle_deg", "angle to the interface (degrees)", angle, 45.0, 90.0), (9, 4), (),
        bears),
)}  # fmt: skip


def jobs_of(one: Map, size: tuple[int, int], runs: Path) -> dict[tuple[float, float], Job]:
    """The runs of a map by their points."""
    return {(x, y): Job(SCENE, one.variant, runs / "crossing_map" / one.name / f"{x:g}_{y:g}", (*one.settings, *one.x.settings(x), *one.y.settings(y)))
            for y in one.y.values(size[1]) for x in one.x.values(size[0]) if one.at_rest(x, y)}  # fmt: skip


def found(job: Job, stop: threading.Event) -> Verdict:
    """Make a run, unless it is there, and judge it. Its fields, some MB, go once its verdict is kept beside its summary."""
    kept = job.out / "verdict.json"
    outcome, run = make(job, stop, limit_s=LIMIT_S)
    if outcome.skipped and (before := store.read(Verdict, kept)) is not None:
        return before
    if run is None or not outcome.ok:
        return Verdict(FAILED, float("nan"), float("nan"), False, float("nan"), (outcome.reason[:80].replace(",", ";"),))
    store.write(verdict := verdict_of(run), kept)
    for name in ("result.h5", "result.xdmf"):
        (job.out / name).unlink(missing_ok=True)
    return verdict


def swept(one: Map, size: tuple[int, int], at_a_time: int, runs: Path = RUNS) -> Verdicts:
    """All runs of a map; what is there for the same scene and solver is not run again."""
    jobs = jobs_of(one, size, runs)
    tasks = [Task(f"{one.name} {x:g} {y:g}", partial(found, job), lambda verdict: verdict.verdict) for (x, y), job in jobs.items()]
    return dict(zip(jobs, side_by_side(tasks, at_a_time)))


def write_table(one: Map, verdicts: Verdicts, folder: Path = RECORDS) -> Path:
    """Keep a map's table: a line a run, numbers to five digits."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{one.name}.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow([one.x.column, one.y.column, *(item.name for item in fields(Verdict))])
        for at, found_there in verdicts.items():
            values = asdict(found_there) | {"passed": int(found_there.passed), "suspect": " ".join(found_there.suspect)}
            lines.writerow([f"{value:.5g}" if isinstance(value, float) else value for value in (*at, *values.values())])
    return path


def read_table(one: Map, folder: Path = RECORDS) -> Verdicts:
    """A map's table as it is kept; empty where none is."""
    path = folder / f"{one.name}.csv"
    rows = csv.reader(path.read_text(encoding="utf-8").splitlines()[1:] if path.is_file() else [])
    return {(float(x), float(y)): Verdict(word, float(arrival), float(rise), passed == "1", float(slid), tuple(marks.split()))
            for x, y, word, arrival, rise, passed, slid, marks in rows}  # fmt: skip
