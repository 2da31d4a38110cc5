"""What the families with a pressurised crack share: the scene, where the crack lies, the closed forms it is held against."""

import math

from verification.harness.given import E_prime, half_length, path_key
from verification.harness.load import Run
from verification.stability.family import SCENES, Checked

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
