"""What a bond at the foot of a chain of blocks and springs carries after the bond at its other end has let go.

Two blocks m_1 (lower), m_2 on massless springs k_1, k_2, all per area and in even tension s until the bond above m_2 fails suddenly. The
foot then carries s phi(t), phi = sum A_i cos(w_i t): m u'' = -K u from the stretched state u_0 = s (1/k_1, 1/k_1 + 1/k_2) at rest, and
phi = k_1 u_1/s. As m_1 is in balance at first, A_1 w_1^2 + A_2 w_2^2 = 0, and with A_1 + A_2 = 1

    A_1 = R/(R - 1), A_2 = -1/(R - 1), R = (w_2/w_1)^2, |phi| <= (R + 1)/(R - 1),

which is reached after one period of the slow mode where w_2/w_1 is an odd number over two. One block alone: phi = cos(w t), a bar of one
rock: a square wave between 1 and -1; neither ever exceeds what the foot carried before. Quasi-statically phi is zero from then on.
With damping a = f/m - c v each mode decays as
    e^(-c t/2) (cos(w' t) + c/(2 w') sin(w' t)), w'^2 = w^2 - c^2/4
(Meirovitch 2001, Fundamentals of Vibrations, 2.2 and 7.4).
"""

from dataclasses import dataclass

import numpy as np

from verification.stability.family import bisected

Array = np.ndarray


@dataclass(frozen=True)
class Chain:
    """Masses (kg/m^2) and springs (Pa/m) from the foot upwards."""

    masses: tuple[float, ...]
    springs: tuple[float, ...]

    def modes(self) -> tuple[Array, Array]:
        """Frequencies w_i (rad/s) from the slowest one, and shares A_i of them in what the foot carries."""
        k = np.array(self.springs)
        K = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
        root = np.sqrt(np.array(self.masses))
        squares, vectors = np.linalg.eigh(K / np.outer(root, root))
        stretched = np.cumsum(1.0 / k)
        return np.sqrt(squares), k[0] * vectors[0] / root[0] * (vectors.T @ (root * stretched))


def carried(chain: Chain, time_s: Array, damping_1_s: float = 0.0) -> Array:
    """phi at times since the bond failed: tension on the foot over that before."""
    frequencies, shares = chain.modes()
    t = np.asarray(time_s, dtype=float)
    total = np.zeros(t.shape, dtype=complex)
    for w, share in zip(frequencies, shares):
        half = 0.5 * damping_1_s
        own = np.sqrt(complex(w * w - half * half))
        own = own if own != 0.0 else 1e-9 * w  # critical damping is the limit of both kinds
        total += share * np.exp(-half * t) * (np.cos(own * t) + half / own * np.sin(own * t))
    return total.real


def most(chain: Chain, damping_1_s: float, within_s: float) -> float:
    """Largest phi within a time, 1 at least, which it starts from (at times 0.1 ms apart)."""
    return float(carried(chain, np.arange(0.0, within_s, 1e-4), damping_1_s).max())


def damping_for(chain: Chain, strength: float, within_s: float, largest_1_s: float = 100.0) -> float:
    """The damping (1/s) at which phi just reaches a strength; raises ValueError where it does not without damping, or does with the largest."""
    return 0.5 * sum(bisected(lambda c: most(chain, c, within_s) >= strength, 0.0, largest_1_s, 1e-5))
