"""Flow and rock one after the other: by how much an error grows in a step, from Sneddon's crack and the lubrication equation.

With the rock's answer w = C p, C the compliance of a pressurised crack in the infinite plane, and flow at a given opening, a lagged step
takes w from the last pressure and finds p from (w/M) (p - p_old)/dt + (w(p_old) - w(p_older))/dt = d/ds(w^3/(12 mu) dp/ds). Its linear map of
(p_old, p_older) errors to p has an eigenvalue whose size is the factor by which an error grows in a step.
"""

import numpy as np

Array = np.ndarray

E_PRIME_PA, HALF_LENGTH_M = 10.0e9 / 0.96, 5.0
VISCOSITY_PA_S, BULK_PA = 0.1, 1.0e9


def compliance(cells: int) -> tuple[Array, Array]:
    """Opening at the middles of cells of half the crack per pressure in each of them and its mirror image (m/Pa), and the middles (m). w(x) = 4/(pi
    E') int p(s) arccosh((a^2 - x s)/(a |x - s|)) ds, integrated in closed form over each cell: int G ds = (s - x) G + sqrt(a^2 - x^2) asin(s/a)."""
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


def growth(dt: float, net_Pa: float = 0.3e6, cells: int = 20, lagged: bool = True) -> float:
    """The factor by which the largest error of the pressure grows in a step of dt (s), lagged or solved together."""
    C, x = compliance(cells)
    ds = x[1] - x[0]
    w = C @ np.full(cells, net_Pa)
    L = conductances(w, ds)
    stored = np.diag(w / BULK_PA) * ds / dt
    opened = C * ds / dt
    if not lagged:  # (stored + opened + L) p = (stored + opened) p_old
        return float(np.max(np.abs(np.linalg.eigvals(np.linalg.solve(stored + opened + L, stored + opened)))))
    # (stored + L) p = (stored - opened) p_old + opened p_older
    A = np.linalg.inv(stored + L)
    first, second = A @ (stored - opened), A @ opened
    step = np.block([[first, second], [np.eye(cells), np.zeros((cells, cells))]])
    return float(np.max(np.abs(np.linalg.eigvals(step))))
