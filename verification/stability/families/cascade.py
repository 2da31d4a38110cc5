"""A weak interface fails at once and its load swings onto another one: what fails with inertia and would not without."""

from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

import numpy as np

from verification.harness.load import LoadError, Run, frames, given
from verification.stability.family import SCENES, STABLE, At, Checked, Edge, Family, Parameter, at_values, close, walked
from verification.stability.theory.swing import Chain, carried, damping_for, most

SCENE = SCENES / "cascade.toml"
FOOT, LAST = 0, 3  # places of the two bonds among the scene's interfaces
LAST_PA = 10.0e3  # strength of the one that is to fail first
BLOCK_KG_M2, SPRING_PA_M = 1.0e4, 0.5e6  # of the lower block: 4 m of 2500 kg/m^3
UPPER = {"": 0.9, "light": 1.0 / 6.0}  # mass and spring of the upper block over those of the lower one, by variant
SWING_S = 1.8  # from the failure to the end of the runs, at least: more than a period of the slowest mode
TOLERANCE = 0.03
DAMPED_RATIO = 1.2
SECTION = "Sudden failure of a weak interface"


@cache
def chain(variant: str) -> Chain:
    """The blocks and springs between the two bonds."""
    share = UPPER[variant]
    return Chain((BLOCK_KG_M2, share * BLOCK_KG_M2), (SPRING_PA_M, share * SPRING_PA_M))


def failed_s(run: Run, interface: int) -> float | None:
    """When an interface failed, all of it at once (s); None where it did not. Raises LoadError where only a part did."""
    times = np.unique(frames(run, "interfaces")[-1][1][f"{interface}/failed_s"])
    if times.size != 1:
        raise LoadError(f"{run.folder}: parts of interface {interface} failed at different times")
    return float(times[0]) if times[0] >= 0.0 else None


def strength(run: Run) -> float:
    """Strength of the foot over that of the last bond."""
    return given(run, "interface.foot.tensile_strength_Pa") / LAST_PA


def damping(run: Run) -> float:
    """Damping of a run, 1/s."""
    return float(run.scene["numerics"].get("damping_1_s", 0.0))


def largest_carried(run: Run) -> float:
    """Largest mean tension of the particles in the cells above and below the foot's bond at any output time, over the last bond's strength."""
    every = [fields for _, fields in frames(run, "particles")]
    return max(float(one["s_yy_Pa"][np.abs(one["y_m"] - one["u_y_m"] - 3.0) < 1.0].mean()) for one in every) / LAST_PA


def swung(run: Run) -> Checked:
    """What the foot came to carry against theory: of one that failed, what theory had let it carry until then against its strength;
    of one that holds, the largest tension against what theory lets it carry at most."""
    own, c = chain(run.summary.variant), damping(run)
    let_go, foot, ratio = failed_s(run, LAST), failed_s(run, FOOT), strength(run)
    if let_go is None or (foot is not None and foot <= let_go):
        raise LoadError(f"{run.folder}: the last bond was not the first to fail")
    if foot is not None:
        reached = float(carried(own, np.linspace(0.0, foot - let_go, 20001), c).max())
        return close(reached, ratio, TOLERANCE, f"the foot fails {foot - let_go:.3f} s later")
    peak = most(own, c, SWING_S)
    return close(largest_carried(run), min(peak, ratio), TOLERANCE, f"the foot holds; theory lets it carry {peak:.3f}")


PULL_M_S2, FROM_PA = 2.0, 5000.0  # without inertia a long pull will do: it costs nothing
SHARE = (1.0 / SPRING_PA_M) / (2.0 / SPRING_PA_M + 1.0 / (UPPER[""] * SPRING_PA_M))  # of the pull, on the bonds below it


def pull_setting(most_m_s2: float, over_s: float) -> str:
    """A pull at the block above the last bond that rises smoothly, as a scene key."""
    rise = f"{most_m_s2!r}*0.5*(1-cos(3.14159265358979*min(1,t/{over_s!r})))"
    return f'body.acceleration_m_s2=["0","Y > 13 ? (Y < 17 ? {rise} : 0) : 0"]'


def weaker_fails(run: Run) -> Checked:
    """Without inertia: the load at which a bond fails is the weaker one's strength, and the other one holds."""
    let_go, foot, ratio = failed_s(run, LAST), failed_s(run, FOOT), strength(run)
    if (let_go is None) == (foot is None):
        raise LoadError(f"{run.folder}: {'neither bond' if foot is None else 'both bonds'} failed")
    pull = BLOCK_KG_M2 * PULL_M_S2 * 0.5 * (1.0 - np.cos(0.5 * np.pi * min(2.0, let_go or foot or 0.0)))
    words = "the foot fails" if foot is not None else "the foot holds"
    return close((FROM_PA + SHARE * float(pull)) / LAST_PA, min(1.0, ratio), 0.01, words)


def turns(value: Callable[[Run], float], runs: Mapping[str, Run]) -> float:
    """The value between the last run whose foot failed and the first one whose foot held; raises LoadError where they are mixed."""
    fail, hold = ([value(run) for run in runs.values() if (failed_s(run, FOOT) is not None) == failed] for failed in (True, False))
    if not fail or not hold or max(fail) >= min(hold):
        raise LoadError("feet that fail and feet that hold are not on two sides of one value")
    return 0.5 * (max(fail) + min(hold))


def foot_setting(ratio: float) -> str:
    """The foot's strength over the last bond's, as a scene key."""
    return f"interface.foot.tensile_strength_Pa={ratio * LAST_PA:.8g}"


def over_strength(variant: str = "", *more: str) -> At:
    """Runs over the foot's strength."""
    return at_values(SCENE, lambda ratio: (foot_setting(ratio), *more), "{:g}", variant)


STRENGTH = Parameter("strength of the foot over that of the bond above")
TWO_MODES = "(w_2^2 + w_1^2)/(w_2^2 - w_1^2) of two blocks on springs, reached after one period of the slow mode as w_2/w_1 is"
STILL = ("numerics.mechanics=quasistatic", f"in_situ.vertical_Pa={-FROM_PA!r}", pull_setting(PULL_M_S2, 2.0), "stop.time_s=2")


def family(name: str, title: str, says: str, *rest: Any, check_name: str = "tension at the foot less that of theory", **more: Any) -> Family:
    """A family of the section."""
    return Family(f"cascade{name}", f"A bond fails: {title}", says, *rest, section=SECTION, check_name=check_name, **more)


def edge(source: str, predicted: Callable[[], float], value: Callable[[Run], float] = strength) -> Edge:
    """Where the foot ceases to fail."""
    return Edge(source, predicted, read=partial(turns, value), unsound_above=False)


FAMILIES = (
    family("", "blocks alike, with inertia", "With inertia the foot fails too unless it is stronger by the swing of two like blocks.", STRENGTH,
           walked(over_strength(), (1.05, 1.2, 1.3, 1.36, 1.375, 1.385, 1.4, 1.45, 1.7), smoke=(1.3, 1.45)), swung,
           edge=edge(f"With inertia: {TWO_MODES} 5/2, or 3/2 for the light block.", lambda: most(chain(""), 0.0, SWING_S))),
    family("_light", "a light block on a heavy one, with inertia", "A light block tuned to a heavy one throws 2.6 times the load that was there onto the foot.",
           STRENGTH, walked(over_strength("light"), (1.1, 1.5, 2.0, 2.4, 2.54, 2.58, 2.62, 2.7, 3.0), smoke=(2.0,)), swung,
           edge=edge("", lambda: most(chain("light"), 0.0, SWING_S))),
    family("_still", "without inertia", "Without inertia the weaker bond fails at its strength, and the other one holds.", STRENGTH,
           walked(over_strength("", *STILL), (0.6, 0.8, 0.95, 0.99, 1.01, 1.05, 1.2, 1.4), smoke=(0.95, 1.05)), weaker_fails,
           check_name="load at the failure less the weaker strength",
           edge=edge("Without inertia: equilibrium of a chain, whose weakest link fails and unloads all others.", lambda: 1.0)),
    family("_damped", "damping, with inertia",
           f"Damping brings the answer with inertia to the other one: a foot that is {DAMPED_RATIO:g} times as strong holds beyond the edge.",
           Parameter("damping", "1/s"),
           walked(at_values(SCENE, lambda c: (foot_setting(DAMPED_RATIO), f"numerics.damping_1_s={c!r}"), "{:g}"),
                  (0.0, 0.1, 0.15, 0.19, 0.197, 0.202, 0.21, 0.3, 0.5, 1.0), smoke=(0.1, 0.3)), swung,
           edge=edge(f"With damping: modes decay as e^(-c t/2); the c at which what the foot carries just reaches {DAMPED_RATIO:g}.",
                     lambda: damping_for(chain(""), DAMPED_RATIO, SWING_S), damping)),
    family("_slow", "how slowly it was loaded", "Slower loading does not make the failure slower: the foot's swing is the same.",
           Parameter("time of the pull", "s"), walked(at_values(  # pulled over so long a time, the foot never fails
               SCENE, lambda over_s: (foot_setting(9.0), pull_setting(0.12, over_s), f"stop.time_s={0.65 * over_s + SWING_S!r}"), "{:g} s"), (1.5, 2.0, 4.0, 8.0), smoke=(2.0,)), swung, (STABLE,)),
)  # fmt: skip
