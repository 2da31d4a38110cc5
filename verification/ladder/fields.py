"""Fields of the particles at a run's end beside a reference solution at the same material points, for cases of the ladder."""

import math
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.harness.load import LoadError, Run, given, last, values
from verification.ladder.case import Array, Quantity, Sample

# Names in the fields of a run, units, and names in strata-reference.
DISPLACEMENT = ("u_x_m", "u_y_m")
VELOCITY = ("v_x_m_s", "v_y_m_s")
STRESS = ("s_xx_Pa", "s_yy_Pa", "s_xy_Pa")


@dataclass(frozen=True)
class End:
    """Particles at the last output: time and time step (s), places where they started (m), fields by name, volumes (m^2)."""

    time_s: float
    step_s: float
    X: Array
    Y: Array
    fields: dict[str, Array]


def lattice(places: Array, spacing: float) -> Array:
    """Places (m) moved to the lattice where particles of a uniform grid start, which single precision has left by a little."""
    on = (np.round(places / spacing - 0.5) + 0.5) * spacing
    if np.abs(on - places).max() > 0.02 * spacing:
        raise LoadError("particles do not start on the lattice of a uniform grid")
    return on


def end_of(run: Run) -> End:
    """The particles at the run's last output."""
    time_s, particles = last(run, "particles")
    fields = {name: array.astype(float) for name, array in particles.items()}
    spacing = given(run, "numerics.cell_m") / math.sqrt(given(run, "numerics.particles_per_cell"))
    places = [lattice(fields[f"{axis}_m"] - fields[f"u_{axis}_m"], spacing) for axis in "xy"]
    return End(time_s, time_s / run.summary.steps if run.summary.steps else 0.0, places[0], places[1], fields)


def at_points(name: str, quantities: tuple[str, ...], places: dict[str, Array], settings: dict[str, float | str]) -> list[Array]:
    """Quantities of strata-reference at lists of places by their keys ("y_m"), which go through files: they may be long."""
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for key, numbers in places.items():
            path = Path(folder) / key
            np.savetxt(path, numbers, fmt="%.17g")
            files[key] = f"@{path}"
        return [values(name, quantity, **settings, **files) for quantity in quantities]


Exact = Callable[[Run, End, tuple[str, ...], float], list[Array]]  # of fields by their names at a time, s


def field_quantity(name: str, unit: str, fields: tuple[str, ...], exact: Exact, **further: object) -> Quantity:
    """All components of a field beside the exact ones, in the norm by volume. Velocities of explicit runs are half a step behind the output's time,
    so the exact ones are taken there."""

    def sample(run: Run) -> Sample:
        end = end_of(run)
        behind = 0.5 * end.step_s if fields[0].startswith("v_") else 0.0
        found = np.concatenate([end.fields[field] for field in fields])
        wanted = np.concatenate(exact(run, end, fields, end.time_s - behind))
        return Sample(found, wanted, np.tile(end.fields["volume_m2"], len(fields)))

    return Quantity(name, unit, sample, **further)  # type: ignore[arg-type]
