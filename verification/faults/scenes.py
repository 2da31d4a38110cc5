"""The scenes that are killed: each mechanics and law of the fluid, each a second or so long."""

from dataclasses import dataclass
from pathlib import Path

from verification.harness.paths import ANALYTIC, EXPERIMENTS


@dataclass(frozen=True)
class Killed:
    """A scene with a variant and settings."""

    name: str
    scene: Path
    variant: str
    settings: tuple[str, ...]


QUASISTATIC, COARSE = "numerics.mechanics=quasistatic", ("numerics.cell_m=2", "fracture.increment_m=2")
EXP1, EXP5 = EXPERIMENTS / "exp1_single_interface.toml", EXPERIMENTS / "exp5_parallel_interface.toml"
KILLED = (
    Killed("explicit total", EXP1, "weak", (*COARSE, "stop.tip_y_m=40")),
    Killed("explicit updated", EXP1, "weak",
           ("numerics.kinematics=updated", *COARSE, "stop.time_s=0.9", "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}")),
    Killed("quasi-static paper", EXP1, "soft", (QUASISTATIC, "stop.tip_y_m=40")),
    Killed("quasi-static turning", EXP5, "", (QUASISTATIC, *COARSE)),
    Killed("quasi-static reynolds", ANALYTIC / "kgd.toml", "", ("stop.time_s=4",)),
)  # fmt: skip
