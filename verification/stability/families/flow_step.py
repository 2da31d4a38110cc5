"""The time rules of the study's flow beyond their limits: explicit steps, trapezoid ringing, backward Euler; and closing channels."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from verification.harness.load import LoadError, Run, frames, given
from verification.stability.family import FAILED, SCENES, STABLE, At, Checked, Edge, Family, Parameter, at_values, close, walked
from verification.stability.theory.flow import amplification, fastest

SEGMENTS = 10  # of half a cell each, along 5 m
PER_NUMBER = 0.001  # viscosity (Pa s) times dt kappa/dx^2: kappa = 1.2e9 Pa (1e-4 m)^2/12/mu, dt = 0.25 ms, dx = 0.5 m
RULES = {"explicit": 0.0, "trapezoid": 0.5, "backward-euler": 1.0}  # their share of the new state


def measured_factor(run: Run) -> float:
    """What a step makes of the fastest mode, from the pressures of the first steps; raises LoadError where they do not tell."""
    _, weights = fastest(SEGMENTS)
    pressures = np.array([fields["pressure_Pa"] for _, fields in frames(run, "fracture")])
    if pressures.shape[1] != SEGMENTS + 1 or not np.all(np.isfinite(pressures)):
        raise LoadError(f"{run.folder}: pressures of shape {pressures.shape}, or not finite")
    change = np.diff(pressures[:, 1:] @ weights, n=2)[:3]  # free of what the ramp itself does
    return float(np.dot(change[1:], change[:-1]) / np.dot(change[:-1], change[:-1]))


def number_of(run: Run) -> float:
    """dt kappa/dx^2 of a run, by its scene."""
    return PER_NUMBER / given(run, "fluid.viscosity_Pa_s")


def check(run: Run) -> Checked:
    """The factor of the fastest mode against theory."""
    expected = amplification(number_of(run) * fastest(SEGMENTS)[0], RULES[str(run.scene["fluid"]["time_rule"])])
    found = measured_factor(run)
    sign = "changes sign" if found < 0.0 else "keeps its sign"
    return close(found, expected, 0.03, f"the fastest mode {sign}: times {found:.3f} a step", scale=1.0)


def first_sign_change(runs: Mapping[str, Run]) -> float:
    """dt kappa/dx^2 at which the measured factor passes zero, between the two runs beside it, in z of which (1 - g)/(1 + g) is linear."""
    found = sorted((number_of(run), measured_factor(run)) for run in runs.values())
    for (low, before), (high, after) in zip(found, found[1:]):
        if before > 0.0 >= after:
            a, b = (1.0 - before) / (1.0 + before), (1.0 - after) / (1.0 + after)
            return low + (high - low) * (1.0 - a) / (b - a)
    raise LoadError("the factor does not pass zero")


def limit() -> float:
    """dt kappa/dx^2 at dt lambda_max = 2."""
    return 2.0 / fastest(SEGMENTS)[0]


def at(rule: str) -> At:
    """A run at dt kappa/dx^2 under a rule."""
    return at_values(SCENES / "flow_step.toml", lambda number: (f"fluid.time_rule={rule}", f"fluid.viscosity_Pa_s={PER_NUMBER / number:.8g}"))


def family(rule: str, says: str, numbers: tuple[float, ...], smoke: tuple[float, ...], beyond: str = STABLE, **more: Any) -> Family:
    """The walk of a rule over the length of its steps."""
    return Family(f"flow_{rule.replace('-', '_')}", f"Steps of the flow: {rule.replace('-e', ' E')}", says, Parameter("dt kappa/dx^2", log=True),
                  walked(at(rule), numbers, smoke), check, (beyond,), section="Steps of the flow",
                  check_name="factor of the fastest mode less that of theory", **more)  # fmt: skip


FAMILIES = (
    family("explicit", "Explicit flow steps beyond their limit must not run.", (0.1, 0.2, 0.3, 0.4, 0.48, 0.52, 0.6, 1.0, 4.0), (0.4, 0.6), FAILED,
           edge=Edge("2/lambda_max of the channel's matrix, by Python.", limit, at("explicit"), (0.3, 0.8), 0.002)),
    family("trapezoid", "The trapezoid's fastest mode changes sign at every step beyond dt lambda = 2, and does not grow.",
           (0.1, 0.25, 0.4, 0.6, 1.0, 4.0, 16.0), (0.25, 1.0),
           edge=Edge("Here an edge of ringing, not of stability: the factor (1 - z/2)/(1 + z/2) is zero at z = dt lambda_max = 2.", limit,
                     read=first_sign_change)),
    family("backward-euler", "Backward Euler keeps every mode's sign at any step.", (0.1, 0.4, 1.0, 4.0, 16.0, 64.0), (0.4, 16.0)),
)  # fmt: skip
