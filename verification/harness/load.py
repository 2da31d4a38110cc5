"""What reads runs is the module that people install, verification/strata; the harness adds the fields of all output times."""

import h5py

from verification.strata import (  # noqa: F401
    GROWTH_M, Array, Event, LoadError, Run, Summary, Suspicion, Tip, columns_of, items_below, load, opened, read_history, read_summary,
)  # fmt: skip

# The monitor that says that speeds of growth are no result: no verdict is about speeds.
OF_SPEEDS = "surface_energy_share"


def frames(run: Run, group: str) -> list[tuple[float, dict[str, Array]]]:
    """Output times (s) of a group of result.h5, such as 'fracture', with the arrays stored at each, by their names."""
    with opened(run) as store:
        times = store["times"][()]
        return [(float(times[int(name)]), arrays_of(item)) for name, item in sorted(store[group].items()) if name.isdigit()]


def arrays_of(group: h5py.Group) -> dict[str, Array]:
    """All data sets below a group, by their names from it."""
    return {name: item[()] for name, item in items_below(group) if isinstance(item, h5py.Dataset)}
