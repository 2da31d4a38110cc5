"""A suddenly pressurised crack: K_I(t) before any wave comes back, against a semi-infinite crack (Freund 1990, chapter 2)."""

from functools import lru_cache

import numpy as np
from scipy.integrate import cumulative_trapezoid

from verification.harness.load import E_prime, LoadError, Run, given, net_Pa, value, values
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Array, Case, Quantity, Sample, cell_levels

SCENE = ANALYTIC / "freund.toml"
RETURN_M = 60.0  # the way of a P wave from the other tip, and to the top and back; to the sides and back it is 80 m
SETTLED_CELLS = 10.0  # c_P t in cells from which on K_I is held against the exact one
SETTLED_M = 20.0  # the same for all sizes, which an order needs: 10 of the coarsest cells
COURANT = 0.5
C_P_M_S = 2108.185  # of the rock below; levels are made before there is a strata-reference to ask
ROCK = {"youngs_modulus_Pa": 10e9, "poisson_ratio": 0.2, "density_kg_m3": 2500.0}


@lru_cache(maxsize=None)
def speed(name: str) -> float:
    """Speed of a wave in the scene's rock, m/s: c_P, c_S or c_R."""
    return value("wave_speeds", f"{name}_m_s", **ROCK)


def window(run: Run, K: Array, from_m: float) -> tuple[Array, Array, Array]:
    """Times (s) with c_P t from `from_m` to the first wave's return, and K_I measured and exact at them (Pa sqrt(m))."""
    way = speed("c_P") * run.history["time_s"]
    inside = (way >= from_m) & (way <= RETURN_M)
    if np.count_nonzero(inside) < 20:
        raise LoadError(f"{run.folder}: fewer than 20 rows of history before a wave comes back")
    times, pressure = run.history["time_s"][inside], net_Pa(run, given(run, "fluid.inlet.start_Pa"))
    return times, K[inside], values("freund_step_pressure", "K_I", pressure_Pa=pressure, time_s=times.tolist(), **ROCK)


def settled(run: Run) -> tuple[Array, Array, Array]:
    """The same of the interaction integral, from 10 of the run's cells on."""
    return window(run, run.history["K_I_Pa_sqrt_m"], SETTLED_CELLS * given(run, "numerics.cell_m"))


def farthest(K: Array, exact: Array) -> Sample:
    """The one of many values that is farthest off its own exact one."""
    worst = int(np.argmax(np.abs(K / exact - 1.0)))
    return Sample.of(float(K[worst]), float(exact[worst]))


def mean_farthest_off(run: Run) -> Sample:
    """The running mean of K_I over the time a Rayleigh wave takes through a cell, h/c_R, where it is farthest off."""
    times, K, exact = settled(run)
    length = given(run, "numerics.cell_m") / speed("c_R")
    starts = times[times <= times[-1] - length]

    def means(series: Array) -> Array:
        area = cumulative_trapezoid(series, times, initial=0.0)
        return (np.interp(starts + length, times, area) - np.interp(starts, times, area)) / length

    return farthest(means(K), means(exact))


NO_ORDER = "the grid answers a step with an overshoot at c_P t = 10 to 15 cells, the same at all sizes, only sooner"
QUANTITIES = (
    Quantity("K_I(t), c_P t = 20 to 60 m", "Pa sqrt(m)", lambda run: Sample(*window(run, run.history["K_I_Pa_sqrt_m"], SETTLED_M)[1:])),
    Quantity("K_I(t) by J, c_P t = 20 to 60 m", "Pa sqrt(m)", lambda run: Sample(*window(run, np.sqrt(np.maximum(run.history["J_N_m"], 0.0) * E_prime(run)), SETTLED_M)[1:])),
    Quantity("K_I(t) farthest off, c_P t = 10 cells to 60 m", "Pa sqrt(m)", lambda run: farthest(*settled(run)[1:]), NO_ORDER),
    Quantity("mean over h/c_R farthest off, same time", "Pa sqrt(m)", mean_farthest_off, NO_ORDER),
)


def case(name: str, says: str, *further: str) -> Case:
    """A case that writes history in each second step: a little less than two steps apart."""

    def keys(h: float) -> tuple[str, ...]:
        return f"numerics.courant={COURANT}", f"output.fields_every_s={1.98 * COURANT * h / C_P_M_S:.6g}", *further

    return Case(name, says, SCENE, "explicit", cell_levels(2.0, 1.0, 0.5, of=(keys,)), QUANTITIES)


CASES = (
    case("freund", "K_I(t) of a suddenly pressurised crack until the first wave comes back"),
    case("freund_xpic", "the same with the transfer XPIC(2), which damps what a cell does not resolve", "numerics.transfer=xpic2"),
)
