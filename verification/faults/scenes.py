"""The scenes that are killed: each mechanics and law of the fluid, each a second or so long."""
from __future__ import annotations

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


_EXP1 = EXPERIMENTS / "exp1_single_interface.toml"

KILLED = (
    Killed(
        "explicit total", _EXP1, "weak",
        ("numerics.cell_m=2", "fracture.increment_m=2", "stop.tip_y_m=40"),
    ),
    Killed(
        "explicit updated", _EXP1, "weak",
        ("numerics.kinematics=updated", "numerics.cell_m=2", "fracture.increment_m=2", "stop.time_s=0.9",
         "fluid.inlet={start_Pa=2.3e6, rate_Pa_s=0.7e6}"),
    ),
    Killed(
        "quasi-static paper", _EXP1, "soft",
        ("numerics.mechanics=quasistatic", "stop.tip_y_m=40"),
    ),
    Killed(
        "quasi-static turning", EXPERIMENTS / "exp5_parallel_interface.toml", "",
        ("numerics.mechanics=quasistatic", "numerics.cell_m=2", "fracture.increment_m=2"),
    ),
    Killed(
        "quasi-static reynolds", ANALYTIC / "kgd.toml", "",
        ("stop.time_s=4",),
    ),
)
