"""Flow along a pressurised crack by both laws, with the rock's opening by Sneddon's compliance C, w = C p (p: net pressure), and along a channel.

Where the inlet's pressure rises, half of the crack in cells, the inlet at its middle, steps given:
    paper     dP/dt = (M/mu) d/ds(k dP/ds), k = w^2/12 of the step's start (lagged), trapezoid between vertices, P given at the inlet
    reynolds  (w/M) dp/dt + dw/dt = d/ds(w^3/(12 mu) dp/ds), backward Euler, w of the step's end (Picard)

A channel of constant opening: dP/dt = kappa d2P/dx2 with kappa = M k/mu, P given at the inlet and no flux at the end, finite volumes around the
vertices (half a volume at the end), eigenvalues -lambda. A step theta of the implicit part multiplies a mode by
    g = (1 - (1 - theta) z)/(1 + theta z), z = lambda dt:
stable while |g| <= 1, free of sign changes while g >= 0 (Hairer & Wanner 1996, IV.2).
"""

from collections.abc import Sequence

import numpy as np

Array = np.ndarray

E_PRIME_PA, HALF_LENGTH_M = 10.0e9 / 0.96, 5.0
VISCOSITY_PA_S, BULK_PA = 0.1, 1.0e9
FLOOR_M = 1e-4  # least opening in the permeability, the scenes' default


def compliance(cells: int) -> tuple[Array, Array]:
    """Opening at the middles of cells of half the crack per pressure in each of them and its mirror image (m/Pa), and the middles (m):

    w(x) = 4/(pi E') int p(s) arccosh((a^2 - x s)/(a |x - s|)) ds, integrated in closed form over each cell:
    int G ds = (s - x) G + sqrt(a^2 - x^2) asin(s/a).
    """
    a = HALF_LENGTH_M
    edges = np.linspace(0.0, a, cells + 1)
    x = 0.5 * (edges[1:] + edges[:-1])

    def primitive(s: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            G = np.arccosh(np.maximum((a**2 - x[:, None] * s) / (a * np.abs(x[:, None] - s)), 1.0))
        return np.where(np.abs(s - x[:, None]) > 0.0, (s - x[:, None]) * G, 0.0) + np.sqrt(a**2 - x[:, None] ** 2) * np.arcsin(s / a)

    right = primitive(edges[1:][None, :]) - primitive(edges[:-1][None, :])
    left = primitive(-edges[:-1][None, :]) - primitive(-edges[1:][None, :])
    return 4.0 / (np.pi * E_PRIME_PA) * (right + left), x


def conductances(w: Array, ds: float) -> Array:
    """-d/ds(w^3/(12 mu) d/ds) ds of cells, the inlet's pressure given at s = 0 and nothing through the tip, m^2/(Pa s)."""
    k = w**3 / (12.0 * VISCOSITY_PA_S)
    between = 2.0 * k[1:] * k[:-1] / (k[1:] + k[:-1]) / ds
    own = np.concatenate([[2.0 * k[0] / ds], between]) + np.concatenate([between, [0.0]])
    return np.diag(own) - np.diag(between, 1) - np.diag(between, -1)


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


def fastest(segments: int) -> tuple[float, Array]:
    """The largest eigenvalue (in units of kappa/dx^2) of the vertices but the inlet, and the row of weights that takes its mode out of the pressures."""
    diffusion = 2.0 * np.eye(segments) - np.eye(segments, k=1) - np.eye(segments, k=-1)  # -d2/dx2
    diffusion[-1, -2] = -2.0
    values, vectors = np.linalg.eig(diffusion.T)
    top = int(np.argmax(values.real))
    return float(values[top].real), vectors[:, top].real


def amplification(z: float, theta: float) -> float:
    """What a step makes of a mode with z = lambda dt."""
    return (1.0 - (1.0 - theta) * z) / (1.0 + theta * z)
