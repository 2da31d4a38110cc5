"""What the families with a pressurised crack share: the scene, where the crack lies, the closed forms it is held against."""
from __future__ import annotations

import math

from verification.harness.load import LoadError, Run, Tip
from verification.harness.paths import ROOT

SCENES = ROOT / "verification" / "stability" / "scenes"
CRACK = SCENES / "crack.toml"

NET_PA = 0.3e6  # the scenes' pressure above their closing stress
HALF_LENGTH_M = 5.0
MIDDLE_M = 16.0  # of the scenes' block

AT_REST = ("numerics.mechanics=quasistatic", "stop.time_s=0")
# The same crack settled by damping, near twice the slowest mode that matters.
SETTLING = (
    "numerics.mechanics=explicit", "numerics.kinematics=total", "numerics.damping_1_s=40", "stop.time_s=0.8", "output.fields_every_s=0.8",
)  # fmt: skip


def path_setting(*points: tuple[float, float]) -> str:
    """The crack along these points (m), as a scene key."""
    return "fracture.path_m=[" + ",".join(f"[{x!r},{y!r}]" for x, y in points) + "]"


def layers_setting(*layers: tuple[str, float | None], interfaces: tuple[str, ...] = ()) -> tuple[str, ...]:
    """The layers (rock, thickness in m; None: the rest) and the interfaces between them, as scene keys."""
    tables = ",".join(f'{{rock="{rock}"' + ("" if size is None else f",thickness_m={size!r}") + "}" for rock, size in layers)
    names = ",".join(f'"{name}"' for name in interfaces)
    return (f"strata.layers=[{tables}]",) + ((f"strata.interfaces=[{names}]",) if interfaces else ())


def crack_ends(run: Run) -> tuple[tuple[float, float], tuple[float, float]]:
    """Both ends of the scene's crack, m."""
    points = run.scene["fracture"]["path_m"]
    return (float(points[0][0]), float(points[0][1])), (float(points[-1][0]), float(points[-1][1]))


def half_length(run: Run) -> float:
    """Half the length of a straight crack with two tips, m."""
    return 0.5 * math.dist(*crack_ends(run))


def griffith_K(run: Run) -> float:
    """K_I = p sqrt(pi a) of the crack in one rock without end, Pa sqrt(m) (Griffith, Sneddon)."""
    return NET_PA * math.sqrt(math.pi * half_length(run))


def E_prime(run: Run, rock: str = "stiff") -> float:
    """E/(1 - nu^2) of a rock, Pa."""
    given = run.scene["rock"][rock]
    return float(given["youngs_modulus_Pa"]) / (1.0 - float(given["poisson_ratio"]) ** 2)


def sneddon_opening(run: Run) -> float:
    """Largest opening 4 p a/E' of the crack in one rock without end, m (Sneddon)."""
    return 4.0 * NET_PA * half_length(run) / E_prime(run)


def upper_tip(run: Run) -> Tip:
    """The tip with the largest y."""
    if not run.summary.tips:
        raise LoadError(f"{run.folder}: no tip")
    return max(run.summary.tips, key=lambda tip: tip.y_m)


def farthest_off(found: list[float], wanted: float) -> float:
    """Of several values the one that is farthest from what is wanted."""
    return max(found, key=lambda value: abs(value - wanted) if math.isfinite(value) else math.inf)
