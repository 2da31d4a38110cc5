"""What reads runs is the module that people install: verification/strata."""

from verification.strata import (  # noqa: F401
    GROWTH_M, OF_SPEEDS, Array, Event, LoadError, Run, Summary, Suspicion, Tip, columns_of, frames, items_below, load, read_summary,
)  # fmt: skip
