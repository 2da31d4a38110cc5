"""J of a crack under fluid pressure and in-situ stress, by a small particle model of its own: from changes of stress, and from total stress.

Linear hat functions, 2 x 2 points a cell, a crack along x = middle that splits the nodes behind its tips, as codes of the study's family have
it. From total stress, total strain and the whole pressure J is a small difference of large terms, of which a ring's points sum each to some per cent
only; from changes of stress and the net pressure these terms are not there.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from verification.stability.theory.step_limit import line_weights

Array = np.ndarray


@dataclass(frozen=True)
class Setup:
    """A block of n x n cells of 1 m under s_h across and s_v along (Pa, compression positive), a crack of 2a cells along y, x off a grid line."""

    cells: int = 40
    half_length: int = 5
    offset_m: float = 0.0
    s_h_Pa: float = 2.0e6
    s_v_Pa: float = 3.0e6
    E_Pa: float = 10.0e9
    nu: float = 0.2

    @property
    def crack_x(self) -> float:
        """Where the crack is, m."""
        return self.cells // 2 + self.offset_m

    @property
    def ends(self) -> tuple[float, float]:
        """y of both tips, m."""
        return self.cells / 2 - self.half_length, self.cells / 2 + self.half_length


class Model:
    """Points, nodes with their copies, stiffness."""

    def __init__(self, setup: Setup) -> None:
        """Lays out points and copies and sums the stiffness."""
        self.setup = setup
        n, (low, high) = setup.cells, setup.ends
        line = np.concatenate([[i + 0.25, i + 0.75] for i in range(n)])
        self.x, self.y = (a.ravel() for a in np.meshgrid(line, line))
        self.V = 0.25
        nodes = np.arange((n + 1) ** 2)
        node_x, node_y = nodes % (n + 1), nodes // (n + 1)
        self.split = (np.abs(node_x - setup.crack_x) < 1.0 - 1e-9) & (node_y > low + 1e-9) & (node_y < high - 1e-9)
        self.copy = np.full(nodes.size, -1)
        self.copy[self.split] = nodes.size + np.arange(int(self.split.sum()))
        self.records = nodes.size + int(self.split.sum())
        E, nu = setup.E_Pa, setup.nu
        self.C = E / ((1 + nu) * (1 - 2 * nu)) * np.array([[1 - nu, nu, 0], [nu, 1 - nu, 0], [0, 0, (1 - 2 * nu) / 2]])
        self.node, self.N, self.dN = self.weights(self.x, self.y)
        right = self.x > setup.crack_x
        self.record = np.where(right[:, None] & self.split[self.node], self.copy[self.node], self.node)
        self.B = np.zeros((self.x.size, 3, 8))
        self.B[:, 0, 0::2] = self.B[:, 2, 1::2] = self.dN[:, :, 0]
        self.B[:, 1, 1::2] = self.B[:, 2, 0::2] = self.dN[:, :, 1]

    def weights(self, x: Array, y: Array) -> tuple[Array, Array, Array]:
        """The four nodes around places, their functions and gradients."""
        n = self.setup.cells
        i, j = np.minimum(x.astype(int), n - 1), np.minimum(y.astype(int), n - 1)
        corners = [(i + a, j + b) for b in (0, 1) for a in (0, 1)]
        hats = [(*line_weights("linear", x - i, 0.0), *line_weights("linear", y - j, 0.0)) for i, j in corners]
        nodes = np.stack([i + (n + 1) * j for i, j in corners], axis=1)
        N = np.stack([N_x * N_y for N_x, _, N_y, _ in hats], axis=1)
        return nodes, N, np.stack([np.stack([d_x * N_y, N_x * d_y], axis=1) for N_x, d_x, N_y, d_y in hats], axis=1)

    def unknowns(self) -> Array:
        """Unknowns of each point's nodes."""
        return np.stack([2 * self.record, 2 * self.record + 1], axis=2).reshape(self.x.size, 8)

    def stiffness(self) -> coo_matrix:
        """sum V B^T C B."""
        K = self.V * np.einsum("pai,ab,pbj->pij", self.B, self.C, self.B)
        dof = self.unknowns()
        rows, columns = np.repeat(dof, 8, axis=1).ravel(), np.tile(dof, (1, 8)).ravel()
        return coo_matrix((K.ravel(), (rows, columns)), shape=(2 * self.records,) * 2).tocsr()

    def of_stress(self, stress: Array) -> Array:
        """-sum V B^T s of a uniform stress, tension positive."""
        f = np.zeros(2 * self.records)
        np.add.at(f, self.unknowns(), -self.V * np.einsum("pai,a->pi", self.B, stress))
        return f

    def faces(self) -> tuple[Array, Array, Array]:
        """Two points a cell along the crack: nodes, functions, y."""
        low, high = self.setup.ends
        y = np.arange(low + 0.25, high, 0.5)
        node, N, _ = self.weights(np.full(y.size, self.setup.crack_x), y)
        return node, N, y

    def of_pressure(self, P: float) -> Array:
        """The forces of a pressure on both faces."""
        f, (node, N, _) = np.zeros(2 * self.records), self.faces()
        split = self.split[node]
        for nodes, side in ((self.copy[node], 1.0), (node, -1.0)):
            np.add.at(f, 2 * nodes[split], side * (0.5 * P * N)[split])
        return f

    def of_edges(self, stress: Array) -> Array:
        """The forces of the in-situ tractions on the block's edges (its nodes there are never split)."""
        n, f = self.setup.cells, np.zeros(2 * self.records)
        k = np.arange(n + 1)
        along = np.where((k == 0) | (k == n), 0.5, 1.0)
        for nodes, axis, sign in ((k * (n + 1), 0, -1.0), (k * (n + 1) + n, 0, 1.0), (k, 1, -1.0), (k + n * (n + 1), 1, 1.0)):
            f[2 * nodes + axis] += sign * stress[axis] * along
        return f


def solve(model: Model, P: float, prestress: bool) -> Array:
    """Displacements (m) under a pressure P (Pa) on the faces.

    prestress: the in-situ state carries itself, what acts is P - s_h. Without it, total stresses balance total loads.
    """
    s = model.setup
    if prestress:
        f = model.of_pressure(P - s.s_h_Pa)
    else:
        stress = np.array([-s.s_h_Pa, -s.s_v_Pa, 0.0])
        f = model.of_stress(stress) + model.of_edges(stress) + model.of_pressure(P)
    held = np.array([0, 1, 2 * s.cells + 1])  # rigid motion: one corner, and the other one along y
    u, free = np.zeros(2 * model.records), np.setdiff1d(np.arange(2 * model.records), held)
    u[free] = spsolve(model.stiffness()[free][:, free].tocsc(), f[free])
    return u


def J_integral(model: Model, u: Array, P: float, radius: float, prestress: bool) -> float:
    """J of the upper tip (N/m) by the domain integral over a plateau of radius/2 that falls to nothing at `radius` (m), with the face term.

    Without prestress from total stress, total strain and the whole pressure.
    """
    s, own = model.setup, u[model.unknowns()]
    tip = np.array([s.crack_x, s.ends[1]])
    grad = np.einsum("pna,pnb->pba", model.dN, own.reshape(-1, 4, 2))  # [p][i][j] = du_i/dx_j
    strain, net = np.einsum("pai,pi->pa", model.B, own), P - s.s_h_Pa
    if not prestress:
        initial = np.linalg.solve(model.C, np.array([-s.s_h_Pa, -s.s_v_Pa, 0.0]))
        strain, grad, net = strain + initial, grad + np.diag(initial[:2]), P
    stress = strain @ model.C
    tensor = np.stack([stress[:, [0, 2]], stress[:, [2, 1]]], axis=1)
    W = 0.5 * np.sum(stress * strain, axis=1)
    offset = np.stack([model.x, model.y], axis=1) - tip
    r = np.maximum(np.hypot(*offset.T), 1e-12)
    slope = np.where((r > 0.5 * radius) & (r < radius), -2.0 / radius, 0.0)[:, None] * offset / r[:, None]
    flux = np.einsum("pij,pi->pj", tensor, grad[:, :, 1])  # crack along y: derivative along y
    flux[:, 1] -= W
    J = model.V * float(np.sum(flux * slope))
    node, N, y = model.faces()
    w = np.sum(N * np.where(model.split[node], u[2 * model.copy[node]] - u[2 * node], 0.0), axis=1)
    back = s.ends[1] - y
    rise = np.where((back > 0.5 * radius) & (back < radius), 2.0 / radius, 0.0)
    return J + float(np.sum(0.5 * net * w * rise))
