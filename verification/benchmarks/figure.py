"""A measured figure: its repetitions with the machine's rates beside each, and what is made of them."""

import math
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

# What a cost is divided by the machine's own: multiply-adds of the cores in use, or traffic with memory.
CORE, MEMORY, NONE = "core", "memory", "none"


@dataclass(frozen=True)
class Figure:
    """A cost, the less the better: seconds or bytes a unit of work (`per`), one value a repetition.

    peak_flop_s and stream_B_s: the machine's rates beside each repetition, on as many threads; bound: which of them the cost is
    taken relative to. round_trip_s: what a line of memory takes from one thread's processor to the other's and back, of figures
    on several threads: a virtual machine may find its processors on one cache now and on two later. about: what was run, as words
    and numbers. problem: why there is no value, or no good one.
    """

    name: str
    per: str
    values: tuple[float, ...]
    unit: str = "s"
    threads: int = 1
    bound: str = CORE
    peak_flop_s: tuple[float, ...] = ()
    stream_B_s: tuple[float, ...] = ()
    round_trip_s: tuple[float, ...] = ()
    about: dict[str, Any] = field(default_factory=dict)
    problem: str = ""

    @property
    def median(self) -> float:
        """The median of the repetitions; NaN where there is none."""
        return statistics.median(self.values) if self.values else math.nan

    @property
    def spread(self) -> float:
        """(largest - smallest)/median of the repetitions; NaN where there is none."""
        return (max(self.values) - min(self.values)) / self.median if self.values and self.median > 0.0 else math.nan

    @property
    def calibrated(self) -> float:
        """Median of the cost times the rate beside it: what the machine could have done meanwhile (flop or B); NaN without a rate."""
        rates = {CORE: self.peak_flop_s, MEMORY: self.stream_B_s}.get(self.bound, ())
        if not self.values or len(rates) != len(self.values):
            return math.nan
        return statistics.median(value * rate for value, rate in zip(self.values, rates))

    @property
    def distance(self) -> float:
        """The median round trip between processors (s); NaN of one thread or where none was measured."""
        return statistics.median(self.round_trip_s) if self.threads > 1 and self.round_trip_s else math.nan

    @property
    def share_of_peak(self) -> float | None:
        """Counted flop a second over those of the cores in use; None where none are counted."""
        return self._share("flop_a_unit", self.peak_flop_s)

    @property
    def share_of_stream(self) -> float | None:
        """Counted bytes a second over the memory's; above 1 where data stay in a cache. None where none are counted."""
        return self._share("byte_a_unit", self.stream_B_s)

    def _share(self, key: str, rates: Sequence[float]) -> float | None:
        """A counted amount a second over a rate."""
        amount = float(self.about.get(key, 0.0))
        if amount <= 0.0 or not self.values or len(rates) != len(self.values):
            return None
        return statistics.median(amount / (value * rate) for value, rate in zip(self.values, rates))

    def wrong(self) -> str:
        """Why the figure cannot be one: a problem, nothing measured, a cost that is no positive number, more flop than there are."""
        if self.problem:
            return self.problem
        if not self.values:
            return "nothing was measured"
        if not all(math.isfinite(value) and value > 0.0 for value in self.values):
            return f"a cost of {min(self.values)} {self.unit} is none"
        share = self.share_of_peak
        if share is not None and share > 1.0 and not self.about.get("equivalent"):
            return f"{share:.2f} of the core's peak: it cannot have done the work"
        return ""


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """The slope of log cost against log size by least squares; NaN of fewer than two sizes or where a cost is none."""
    if len(set(sizes)) < 2 or not all(math.isfinite(cost) and cost > 0.0 for cost in costs):
        return math.nan
    x, y = [math.log(size) for size in sizes], [math.log(cost) for cost in costs]
    return statistics.linear_regression(x, y).slope
