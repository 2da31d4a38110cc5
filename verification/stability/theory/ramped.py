"""A pressurised crack whose inlet's pressure rises: the fluid along it by both laws, with the rock's opening by Sneddon's compliance.

Half of the crack in cells, the inlet at its middle (staggered.py has the compliance C, w = C p with p the net pressure):
paper     dP/dt = (M/mu) d/ds(k dP/ds), k = w^2/12 of the step's start (lagged), trapezoid between vertices, P given at the inlet
reynolds  (w/M) dp/dt + dw/dt = d/ds(w^3/(12 mu) dp/ds), backward Euler, w of the step's end (Picard)
Steps are given: short ones for the solution, long ones for what becomes of it where permeability lags.
"""

from collections.abc import Sequence

import numpy as np

from verification.stability.theory.staggered import BULK_PA, compliance, conductances

Array = np.ndarray

FLOOR_M = 1e-4  # least opening in the permeability, the scenes' default


def diffused(P: Array, w: Array, ds: float, dt: float, viscosity_Pa_s: float, inlet_Pa: tuple[float, float]) -> Array:
    """Pressures (Pa) of the vertices after a step dt (s) at openings w (m) of the cells between them, the inlet's rising from one value to another."""
    kappa = BULK_PA / viscosity_Pa_s * np.maximum(w, FLOOR_M) ** 2 / 12.0
    n = w.size
    below, above = kappa / ds / np.append(np.full(n - 1, ds), 0.5 * ds), np.append(kappa[1:] / ds / ds, 0.0)  # at all vertices but the inlet
    A = np.diag(np.append(0.0, -below - above)) + np.diag(below, -1) + np.diag(np.append(0.0, above[:-1]), 1)
    parts = max(1, int(np.ceil(dt * float(kappa.max()) / (2.0 * ds * ds))))  # or the trapezoid rings
    h = dt / parts
    left = np.eye(n + 1) - 0.5 * h * A
    onward = np.linalg.solve(left, np.eye(n + 1) + 0.5 * h * A)
    first = np.linalg.solve(left, np.eye(n + 1)[0])
    out = P.copy()
    for k in range(1, parts + 1):
        inlet = inlet_Pa[0] + (inlet_Pa[1] - inlet_Pa[0]) * k / parts
        out = onward @ out + first * (inlet - out[0])
    return out


def paper(steps_s: Sequence[float], start_Pa: float, rate_Pa_s: float, viscosity_Pa_s: float, cells: int = 10) -> Array:
    """Net pressures (Pa) of the vertices from the inlet to the tip after these steps, from start_Pa everywhere."""
    C, x = compliance(cells)
    p, time = np.full(cells + 1, start_Pa), 0.0
    for dt in steps_s:
        w = C @ (0.5 * (p[1:] + p[:-1]))
        p = diffused(p, w, float(x[1] - x[0]), dt, viscosity_Pa_s, (start_Pa + rate_Pa_s * time, start_Pa + rate_Pa_s * (time + dt)))
        time += dt
    return p


def reynolds(steps_s: Sequence[float], start_Pa: float, rate_Pa_s: float, cells: int = 10) -> tuple[Array, Array]:
    """Net pressures (Pa) and openings (m) of the cells from the inlet to the tip after these steps, from start_Pa everywhere."""
    C, x = compliance(cells)
    ds = float(x[1] - x[0])
    p, time = np.full(cells, start_Pa), 0.0
    for dt in steps_s:
        time += dt
        inlet, before, w_before, change = start_Pa + rate_Pa_s * time, p, C @ p, np.inf
        for _ in range(200):
            w = C @ p
            L = conductances(w, ds)
            stored = np.diag(w) * ds / (BULK_PA * dt)
            source = np.zeros(cells)
            source[0] = L[0].sum() * inlet
            new = np.linalg.solve(stored + C * ds / dt + L, stored @ before + w_before * ds / dt + source)
            change, p = float(np.max(np.abs(new - p))), new
            if change < 1e-9 * inlet:
                break
        else:
            raise ArithmeticError(f"no pressures found at {time:g} s: the last change was {change:g} Pa")
    return p, C @ p


def doubling(time_s: float, every_s: float, first_s: float = 1e-3) -> list[float]:
    """Steps that begin with first_s, each twice the one before, cut off at every output time: those of a run that nothing else holds back."""
    steps: list[float] = []
    t, dt, output = 0.0, first_s, every_s
    while t < time_s * (1.0 - 1e-12):
        steps.append(min(dt, output - t))
        t += steps[-1]
        dt = 2.0 * steps[-1]
        if t >= output * (1.0 - 1e-12):
            output = min(output + every_s, time_s)
    return steps
