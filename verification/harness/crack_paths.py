"""Paths of Experiments 5 and 6 by boundary elements in the infinite plane, and paths of runs in the same frame."""

import numpy as np

from verification.harness.load import Array, LoadError, Run, Setting, values
from verification.harness.observables import distances_to

INTERFACE_M = 5.0  # to the right of the first crack
FIRST_TIP_M = 5.0
_STIFF: dict[str, float] = {"youngs_modulus_Pa": 10e9, "toughness_Pa_sqrt_m": 1.45e6}
_SOFT: dict[str, float] = {"youngs_modulus_Pa": 5e9, "toughness_Pa_sqrt_m": 1.25e6}
_ACROSS_PA = -2e6  # in-situ stress across the fracture
_ALONG_PA = {5: -3e6, 6: -1e6}  # and along it


def path_settings(experiment: int, increment_m: float, turning: str, growth_m: float) -> dict[str, Setting]:
    """The settings of crack_path for Experiment 5 or 6."""
    crack, beyond = (_SOFT, _STIFF) if experiment == 5 else (_STIFF, _SOFT)
    return {
        **crack, "beyond_youngs_modulus_Pa": beyond["youngs_modulus_Pa"], "interface_x_m": INTERFACE_M, "s_xx_Pa": _ACROSS_PA,
        "s_yy_Pa": _ALONG_PA[experiment], "half_length_m": FIRST_TIP_M, "increment_m": increment_m, "turning": turning,
        "stop_growth_m": growth_m, "stop_height_m": 1000.0,
    }  # fmt: skip


def exact_path(experiment: int, increment_m: float, turning: str, growth_m: float) -> Array:
    """Tips of Experiment 5 or 6 by strata-reference crack_path over a length of growth, "corrected" or "forward" turning. Perfect interface, pressure
    everywhere that of the start of growth; x from the first crack; shape (n, 2), m."""
    settings = path_settings(experiment, increment_m, turning, growth_m)
    return np.column_stack([values("crack_path", axis, **settings) for axis in ("x_m", "y_m")])


def first_kink_deg(experiment: int) -> float:
    """Direction of maximum hoop stress of the first crack when it starts to grow, degrees anticlockwise from its own."""
    return float(values("crack_path", "kink_deg", **path_settings(experiment, 1.0, "forward", 1.0))[0])


def grown(run: Run) -> Array:
    """Tips of a run from the first on, x from the first crack, shape (n, 2), m; LoadError if it grew less than twice."""
    path = run.path[1:] - np.array([run.path[0, 0], 0.0])
    if len(path) < 3:
        raise LoadError(f"{run.folder}: the fracture grew less than two increments")
    return path


def rise_at(path: Array, x_m: float) -> float:
    """Height above the first tip at which a path first is x_m to the right, m; LoadError if it never is."""
    beyond = np.nonzero(path[:, 0] >= x_m)[0]
    if len(beyond) == 0:
        raise LoadError(f"the path never gets {x_m:g} m to the right")
    k = int(beyond[0])
    part = (x_m - path[k - 1, 0]) / (path[k, 0] - path[k - 1, 0])
    return float(path[k - 1, 1] + part * (path[k, 1] - path[k - 1, 1]) - path[0, 1])


def farthest(path: Array, other: Array) -> float:
    """Largest distance of a path's points from a polyline (m), over the height and width that both have."""
    near = np.hypot(*(path - path[0]).T) <= np.hypot(*(other[-1] - other[0]))
    return float(np.max(distances_to(path[near], other)))
