"""The longest stable time step of a small block of points on a grid, from published shape functions alone.

M is the lumped mass sum_p m N_i, K = sum_p V B^T C B (Sulsky, Chen & Schreyer 1994), both put together here from the quadratic B-spline
(Steffen, Kirby & Berzins 2008), hat functions, and hat functions averaged over a point's length (uGIMP, Bardenhagen & Kober 2004). Nodes that keep
their velocities ("total") are a leapfrog: dt = 2/omega_max of M^-1 K. Where points carry them, a step is a linear map of nodal displacement d and
velocity V, with S = M^-1 N^T m N what a transfer to the points and back leaves of a velocity, a = -M^-1 K d:
    FLIP     V' = V + dt S a,                   d' = d + dt (V + dt a)      (Brackbill & Ruppel 1986)
    PIC      V' = S (V + dt a),                 d' as above                  (Harlow 1964)
    XPIC(2)  V' = 2 S V - S S V + dt S a,       d' as above                  (Hammerquist & Nairn 2017)
and dt is the longest for which no eigenvalue of that map is larger than 1. For a mode that M^-1 K and S share these are
(omega dt)^2 <= 4/(2 - S), 2 (1 + S) and (2 + 4 S - 2 S^2)/(1 + S - S^2).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from verification.stability.family import bisected

Array = np.ndarray


@dataclass(frozen=True)
class Block:
    """A square of `cells` x `cells` cells of side 1 with points in a lattice, `across` in each direction, all moved by `shift` (cells)."""

    shape: str
    across: int
    cells: int = 6
    held: bool = False  # edges on rollers, as mirrors; else free
    shift: tuple[float, float] = (0.0, 0.0)


def line_weights(shape: str, distance: Array, half: float) -> tuple[Array, Array]:
    """Weights and derivatives (1/cell) of nodes whose points are at `distance` (cells, point less node)."""
    x, side = np.abs(distance), np.sign(distance)
    if shape == "bspline2":
        near, far = x < 0.5, (x >= 0.5) & (x < 1.5)
        return np.where(near, 0.75 - x**2, np.where(far, 0.5 * (1.5 - x) ** 2, 0.0)), side * np.where(near, -2.0 * x, np.where(far, x - 1.5, 0.0))
    if shape == "linear":
        inside = x < 1.0
        return np.where(inside, 1.0 - x, 0.0), np.where(inside, -side, 0.0)
    low, high = np.clip(distance - half, -1.0, 1.0), np.clip(distance + half, -1.0, 1.0)
    integral = [np.where(y < 0.0, 0.5 * (1.0 + y) ** 2, 1.0 - 0.5 * (1.0 - y) ** 2) for y in (low, high)]  # of the hat from -1
    return (integral[1] - integral[0]) / (2.0 * half), (np.abs(low) - np.abs(high)) / (2.0 * half)


def weights_of(block: Block) -> tuple[Array, Array, Array, Array, Array]:
    """N, N_x, N_y of all points (rows) and nodes, and the points' places, cells."""
    n, across = block.cells, block.across
    nodes = np.arange(-1, n + 2, dtype=float)
    places = (np.arange(n * across) + 0.5) / across
    N_x, D_x = line_weights(block.shape, places[:, None] + block.shift[0] - nodes[None, :], 0.5 / across)
    N_y, D_y = line_weights(block.shape, places[:, None] + block.shift[1] - nodes[None, :], 0.5 / across)
    x, y = np.tile(places, len(places)), np.repeat(places, len(places))
    return np.kron(N_y, N_x), np.kron(N_y, D_x), np.kron(D_y, N_x), x, y


def matrices(block: Block, poisson: float) -> tuple[Array, Array]:
    """M^-1 K (in units of (c_P/h)^2) and S of a block of a rock with a Poisson's ratio, of the motions that its edges leave free."""
    N, G_x, G_y, _, _ = weights_of(block)
    shear = (1.0 - 2.0 * poisson) / (2.0 * (1.0 - poisson))  # mu/(lambda + 2 mu), which is (c_S/c_P)^2
    V, coupling, zero = 1.0 / block.across**2, 1.0 - 2.0 * shear, np.zeros_like(N)  # density 1 and P wave speed 1
    B = np.block([[G_x, zero], [zero, G_y], [G_y, G_x]])
    C = np.kron(np.array([[1.0, coupling, 0.0], [coupling, 1.0, 0.0], [0.0, 0.0, shear]]), np.eye(N.shape[0]))
    NN = np.kron(np.eye(2), N)
    keep = free_motions(block.cells, block.held)
    m = V * np.abs(keep).T @ NN.sum(axis=0)  # a mirror adds its mass to the node that it mirrors, in both directions
    B, NN = B @ keep, NN @ keep
    used = m > 1e-14
    B, NN, m = B[:, used], NN[:, used], m[used]
    return (V * B.T @ C @ B) / m[:, None], (V * NN.T @ NN) / m[:, None]


def free_motions(cells: int, held: bool) -> Array:
    """Motions of all nodes (x, then y) by those of the free ones: beyond a held edge a mirror, on it nothing normal to it."""
    count = cells + 3
    if not held:
        return np.eye(2 * count**2)
    even, odd = np.eye(count), np.eye(count)
    for ghost, inside, edge in ((0, 2, 1), (count - 1, count - 3, count - 2)):
        even[ghost], odd[ghost] = even[inside], -odd[inside]
        odd[edge] = 0.0
    even, odd = even[:, 1:-1], odd[:, 2:-2]
    return block_diag(np.kron(even, odd), np.kron(odd, even))


def courant_limit(block: Block, transfer: str, poisson: float) -> float:
    """The largest stable c_P dt/h; transfer: flip, pic, xpic2, or total for nodes that keep their velocities."""
    A, S = matrices(block, poisson)
    leapfrog, one = 2.0 / math.sqrt(float(np.max(np.linalg.eigvals(A).real))), np.eye(len(A))
    if transfer == "total":
        return leapfrog
    keep = {"flip": one, "pic": S, "xpic2": 2.0 * S - S @ S}[transfer]

    def growth(dt: float) -> float:
        """The largest size of an eigenvalue of a step, which maps (d, V)."""
        return float(np.max(np.abs(np.linalg.eigvals(np.block([[one - dt**2 * A, dt * one], [-dt * S @ A, keep]])))))

    return bisected(lambda dt: growth(dt) < 1.0 + 1e-7, 0.2 * leapfrog, 2.0 * leapfrog, 2e-4)[0]


def damped_limit(undamped: float, damping: float) -> float:
    """The largest stable c_P dt/h of a leapfrog whose velocity keeps 1 - damping dt a step (damping in c_P/h): (omega dt)^2 <= 4 - 2 damping dt."""
    half = 0.25 * damping * undamped**2
    return math.sqrt(half**2 + undamped**2) - half


def plane_mode(block: Block, poisson: float, mode: int) -> tuple[float, float]:
    """(omega h/c_P)^2 and S of the motion sin(mode pi x/L) along x in a held block, which it is a mode of."""
    (stiffness, smoothing), n = matrices(block, poisson), block.cells
    along = np.sin(mode * math.pi * np.arange(1, n) / n)
    motion = np.concatenate([np.tile(along, n + 1), np.zeros((n + 1) * (n - 1))])
    return float(motion @ stiffness @ motion / (motion @ motion)), float(motion @ smoothing @ motion / (motion @ motion))


def amplitude_factor(transfer: str, z: float, S: float) -> float:
    """What a step makes of a mode's amplitude, z = (omega dt)^2: the root of the determinant of its 2 x 2 map, whose eigenvalues are a pair."""
    determinant = {"total": 1.0, "flip": 1.0 - (1.0 - S) * z, "pic": S, "xpic2": 2.0 * S - S**2 - z * (S - S**2)}[transfer]
    return math.sqrt(determinant)


def null_share(block: Block, start: Callable[[Array, Array], tuple[Array, Array]]) -> float:
    """Share of the points' kinetic energy, of velocities start(x, y), that no velocity of the nodes makes: v less its projection on N."""
    N, _, _, x, y = weights_of(block)
    NN = np.kron(np.eye(2), N) @ free_motions(block.cells, block.held)
    v = np.concatenate(start(x, y))
    rest = v - NN @ np.linalg.lstsq(NN, v, rcond=None)[0]
    return float(rest @ rest) / float(v @ v)
