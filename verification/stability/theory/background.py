"""J of a crack under fluid pressure and in-situ stress, by a small particle model of its own: from changes of stress, and from total stress.

Linear hat functions, 2 x 2 points a cell, a crack along x = middle that splits the nodes behind its tips, as codes of the study's family have
it. From total stress, total strain and the whole pressure J is a small difference of large terms, of which a ring's points sum each to some per cent
only; from changes of stress and the net pressure these terms are not there.
"""

from functools import cache

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from verification.stability.theory.step_limit import line_weights

Array = np.ndarray

# A block of n x n cells of 1 m under s_h across and s_v along (compression positive), a crack along y on its middle line.
CELLS, POINT_M2 = 40, 0.25
CRACK_X_M, LOW_M, HIGH_M = 20.0, 15.0, 25.0  # and its tips
S_H_PA, S_V_PA = 2.0e6, 3.0e6
E_PA, NU = 10.0e9, 0.2
IN_SITU = np.array([-S_H_PA, -S_V_PA, 0.0])  # tension positive
STIFF = E_PA / ((1 + NU) * (1 - 2 * NU)) * np.array([[1 - NU, NU, 0], [NU, 1 - NU, 0], [0, 0, (1 - 2 * NU) / 2]])


def weights(x: Array, y: Array) -> tuple[Array, Array, Array]:
    """The four nodes around places, their functions and gradients."""
    i, j = np.minimum(x.astype(int), CELLS - 1), np.minimum(y.astype(int), CELLS - 1)
    corners = [(i + a, j + b) for b in (0, 1) for a in (0, 1)]
    hats = [(*line_weights("linear", x - i, 0.0), *line_weights("linear", y - j, 0.0)) for i, j in corners]
    nodes = np.stack([i + (CELLS + 1) * j for i, j in corners], axis=1)
    N = np.stack([N_x * N_y for N_x, _, N_y, _ in hats], axis=1)
    return nodes, N, np.stack([np.stack([d_x * N_y, N_x * d_y], axis=1) for N_x, d_x, N_y, d_y in hats], axis=1)


class Model:
    """Points, nodes with their copies, stiffness."""

    def __init__(self) -> None:
        """Lays out points and copies and sums the stiffness."""
        line = np.concatenate([[i + 0.25, i + 0.75] for i in range(CELLS)])
        self.x, self.y = (a.ravel() for a in np.meshgrid(line, line))
        nodes = np.arange((CELLS + 1) ** 2)
        node_x, node_y = nodes % (CELLS + 1), nodes // (CELLS + 1)
        self.split = (np.abs(node_x - CRACK_X_M) < 1.0 - 1e-9) & (node_y > LOW_M + 1e-9) & (node_y < HIGH_M - 1e-9)
        self.copy = np.full(nodes.size, -1)
        self.copy[self.split] = nodes.size + np.arange(int(self.split.sum()))
        self.records = nodes.size + int(self.split.sum())
        node, _, self.dN = weights(self.x, self.y)
        right = self.x > CRACK_X_M
        record = np.where(right[:, None] & self.split[node], self.copy[node], node)
        self.unknowns = np.stack([2 * record, 2 * record + 1], axis=2).reshape(self.x.size, 8)
        self.B = np.zeros((self.x.size, 3, 8))
        self.B[:, 0, 0::2] = self.B[:, 2, 1::2] = self.dN[:, :, 0]
        self.B[:, 1, 1::2] = self.B[:, 2, 0::2] = self.dN[:, :, 1]

    def stiffness(self) -> coo_matrix:
        """sum V B^T C B."""
        K = POINT_M2 * np.einsum("pai,ab,pbj->pij", self.B, STIFF, self.B)
        rows, columns = np.repeat(self.unknowns, 8, axis=1).ravel(), np.tile(self.unknowns, (1, 8)).ravel()
        return coo_matrix((K.ravel(), (rows, columns)), shape=(2 * self.records,) * 2).tocsr()

    def in_situ(self) -> Array:
        """The forces of the in-situ stress: -sum V B^T s of the points, and of its tractions on the block's edges (whose nodes are never split)."""
        f, k, rows = np.zeros(2 * self.records), np.arange(CELLS + 1), CELLS + 1
        np.add.at(f, self.unknowns, -POINT_M2 * np.einsum("pai,a->pi", self.B, IN_SITU))
        along = np.where((k == 0) | (k == CELLS), 0.5, 1.0)
        for nodes, axis, sign in ((k * rows, 0, -1.0), (k * rows + CELLS, 0, 1.0), (k, 1, -1.0), (k + CELLS * rows, 1, 1.0)):
            f[2 * nodes + axis] += sign * IN_SITU[axis] * along
        return f

    def faces(self) -> tuple[Array, Array, Array]:
        """Two points a cell along the crack: nodes, functions, y."""
        y = np.arange(LOW_M + 0.25, HIGH_M, 0.5)
        node, N, _ = weights(np.full(y.size, CRACK_X_M), y)
        return node, N, y

    def of_pressure(self, P: float) -> Array:
        """The forces of a pressure on both faces."""
        f, (node, N, _) = np.zeros(2 * self.records), self.faces()
        split = self.split[node]
        for nodes, side in ((self.copy[node], 1.0), (node, -1.0)):
            np.add.at(f, 2 * nodes[split], side * (0.5 * P * N)[split])
        return f


MODEL = cache(Model)  # nothing changes it


def solve(P: float, prestress: bool) -> Array:
    """Displacements (m) under a pressure P (Pa) on the faces. prestress: the in-situ state carries itself, what acts is P - s_h. Without it, total
    stresses balance total loads."""
    m = MODEL()
    f = m.of_pressure(P - S_H_PA) if prestress else m.in_situ() + m.of_pressure(P)
    held = np.array([0, 1, 2 * CELLS + 1])  # rigid motion: one corner, and the other one along y
    u, free = np.zeros(2 * m.records), np.setdiff1d(np.arange(2 * m.records), held)
    u[free] = spsolve(m.stiffness()[free][:, free].tocsc(), f[free])
    return u


def J_integral(u: Array, P: float, radius: float, prestress: bool) -> float:
    """J of the upper tip (N/m) by the domain integral over a plateau of radius/2 that falls to nothing at `radius` (m), with the face term. Without
    prestress from total stress, total strain and the whole pressure."""
    m, own = MODEL(), u[MODEL().unknowns]
    grad = np.einsum("pna,pnb->pba", m.dN, own.reshape(-1, 4, 2))  # [p][i][j] = du_i/dx_j
    strain, net = np.einsum("pai,pi->pa", m.B, own), P - S_H_PA
    if not prestress:
        initial = np.linalg.solve(STIFF, IN_SITU)
        strain, grad, net = strain + initial, grad + np.diag(initial[:2]), P
    stress = strain @ STIFF
    tensor = np.stack([stress[:, [0, 2]], stress[:, [2, 1]]], axis=1)
    W = 0.5 * np.sum(stress * strain, axis=1)
    offset = np.stack([m.x, m.y], axis=1) - np.array([CRACK_X_M, HIGH_M])
    r = np.maximum(np.hypot(*offset.T), 1e-12)
    slope = np.where((r > 0.5 * radius) & (r < radius), -2.0 / radius, 0.0)[:, None] * offset / r[:, None]
    flux = np.einsum("pij,pi->pj", tensor, grad[:, :, 1])  # crack along y: derivative along y
    flux[:, 1] -= W
    J = POINT_M2 * float(np.sum(flux * slope))
    node, N, y = m.faces()
    w = np.sum(N * np.where(m.split[node], u[2 * m.copy[node]] - u[2 * node], 0.0), axis=1)
    back = HIGH_M - y
    rise = np.where((back > 0.5 * radius) & (back < radius), 2.0 / radius, 0.0)
    return J + float(np.sum(0.5 * net * w * rise))
