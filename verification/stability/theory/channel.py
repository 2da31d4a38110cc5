"""Diffusion of pressure along a channel of constant opening between vertices, as a system of ordinary differential equations.

dP/dt = kappa d2P/dx2 with kappa = M k/mu, P given at the inlet and no flux at the end: finite volumes around the vertices (half a volume
at the end), eigenvalues -lambda. A step theta of the implicit part multiplies a mode by
    g = (1 - (1 - theta) z)/(1 + theta z), z = lambda dt:
stable while |g| <= 1, free of sign changes while g >= 0 (Hairer & Wanner 1996, IV.2).
"""

import numpy as np

Array = np.ndarray


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
