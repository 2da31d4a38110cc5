"""A run's layers as strata-reference layered_height takes them, and the pressures at which a tip passes heights."""

from typing import Any

import numpy as np

from verification.harness.given import given
from verification.harness.load import LoadError, Run

EDGE_M = 2.0  # the lower tip is held so far from the rock's fine cells


def column(run: Run) -> dict[str, Any]:
    """Borders, stresses and toughness of a run's layers and its crack, as layered_height takes them; mirrored where the bottom is a mirror."""
    layers = run.scene["strata"]["layers"]
    stress = [float(layer.get("horizontal_Pa", run.scene["in_situ"]["horizontal_Pa"])) for layer in layers]
    toughness = [float(run.scene["rock"][layer["rock"]]["toughness_Pa_sqrt_m"]) for layer in layers]
    border = np.cumsum([layer["thickness_m"] for layer in layers[:-1]]).tolist()
    (_, bottom), (_, top) = run.scene["fracture"]["path_m"]
    height = given(run, "domain.height_m")
    limits = {"lower_limit_m": EDGE_M, "upper_limit_m": height}
    if run.scene["domain"]["bottom"] == "symmetry":
        border, stress, toughness = [-y for y in border[::-1]] + border, stress[:0:-1] + stress, toughness[:0:-1] + toughness
        bottom, limits["lower_limit_m"] = -top, -height
    return {"border_m": border, "stress_Pa": stress, "toughness_Pa_sqrt_m": toughness, "bottom_m": bottom, "top_m": top, **limits}


def pressure_beyond(run: Run, y: float) -> float:
    """Inlet pressure at which the tip leaves a height, Pa: that of the first row with a higher one."""
    higher = np.flatnonzero(run.history["tip_y_m"] > y + 1e-6)
    if not higher.size:
        raise LoadError(f"{run.folder}: the tip did not pass {y} m")
    return float(run.history["inlet_Pa"][higher[0]])
