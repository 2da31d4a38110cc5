"""Published criteria of crossing, and closed forms of when an interface starts to slip. Stresses s_v (normal to the interface) and s_h (closing the
fracture) are positive in compression, net_Pa, strengths too; K in Pa sqrt(m).
"""

import math

import numpy as np

Field = tuple[float, float, float]  # stress along the fracture, across it, and shear; tension positive


def tip_field(theta: float) -> Field:
    """The field of mode I over K_I/sqrt(2 pi r), at an angle (rad) from the fracture's direction (Williams 1957)."""
    half, more = 0.5 * theta, 1.5 * theta
    c, s = math.cos(half), math.sin(half)
    return c * (1.0 - s * math.sin(more)), c * (1.0 + s * math.sin(more)), s * c * math.cos(more)


def renshaw_pollard(friction: float, strength_Pa: float, closing_Pa: float) -> float:
    """The least s_v at which a fracture normal to an interface crosses: s_v/(T0 + s_h) = 0.35 (1 + 1/mu)/1.06 (Renshaw & Pollard 1995). Beyond the
    interface the field of the tip and s_h make T0 where the same field does not slide it."""
    return (strength_Pa + closing_Pa) * 0.35 * (1.0 + 1.0 / friction) / 1.06


def blanton(strength_Pa: float, closing_Pa: float) -> float:
    """The least s_v at which a fracture normal to an interface crosses: s_v - s_h = T0, whatever the friction (Blanton 1986, at 90 degrees)."""
    return closing_Pa + strength_Pa


def gu_weng(strength_Pa: float, along_Pa: float, closing_Pa: float, angle: float = 0.5 * math.pi) -> float:
    """The least friction with which a fracture crosses an interface at an angle (rad), infinite where that opens, by the idea of Gu & Weng (2010), written
    anew from it: in-situ stresses along the fracture and closing it, and the field of the tip on the interface, up to where the largest tension on one of
    its halves is T0; no half may then slide. At 90 degrees Renshaw & Pollard's but for the largest tension in place of that across the fracture."""
    halves = (angle, angle - math.pi)

    def stress(theta: float, k: float) -> np.ndarray:
        along, across, shear = (k * part for part in tip_field(theta))
        return np.array([[along - along_Pa, shear], [shear, across - closing_Pa]])

    low, high = 0.0, 1e3 * (strength_Pa + along_Pa + closing_Pa)
    for _ in range(60):  # K/sqrt(2 pi r) at which T0 is met: the largest eigenvalue is convex in it and below T0 without it
        k = 0.5 * (low + high)
        low, high = (low, k) if max(np.linalg.eigvalsh(stress(theta, k))[-1] for theta in halves) > strength_Pa else (k, high)
    normal, way = np.array([-math.sin(angle), math.cos(angle)]), np.array([math.cos(angle), math.sin(angle)])
    on = [(abs(way @ stress(theta, high) @ normal), -(normal @ stress(theta, high) @ normal)) for theta in halves]
    return max(float(shear / pressed) if pressed > 0.0 else math.inf for shear, pressed in on)


def first_slip(friction: float, K: float, distance_m: float) -> float:
    """s_v below which an interface slips somewhere ahead of a tip at a distance: the most that |shear|/mu + tension of the tip's field come to on it.
    K/(s_v sqrt(2 pi d)) = 0.8122 (mu 0.4), 0.8915 (0.6)."""
    angles = np.linspace(0.0, 0.499 * math.pi, 2001)
    fields = [(tip_field(theta), math.sqrt(math.cos(theta))) for theta in angles]
    return max((abs(shear) / friction + along) * root for (along, _, shear), root in fields) * K / math.sqrt(2.0 * math.pi * distance_m)


def griffith_means(half_length_m: float, over_m: float) -> tuple[float, float]:
    """Mean shear, and mean tension along the fracture, on the line normal to a Griffith crack at its tip, over a length from the tip, per net pressure
    (Westergaard 1939: Z = z/sqrt(z^2 - a^2) - 1)."""
    a, steps = half_length_m, 20000
    y = over_m * ((np.arange(steps) + 0.5) / steps) ** 2  # points gather at the tip, weights with them
    weights = 2.0 * ((np.arange(steps) + 0.5) / steps) / steps
    z = a + 1j * y
    Z, slope = z / np.sqrt(z * z - a * a) - 1.0, -a * a / (z * z - a * a) ** 1.5
    return float(np.sum(weights * np.abs(y * slope.real))), float(np.sum(weights * (Z.real - y * slope.imag)))


def mean_slip(friction: float, net_Pa: float, half_length_m: float, over_m: float) -> float:
    """s_v below which the mean shear over a length from a tip on the interface exceeds friction on the mean normal stress, bonded as it stands."""
    shear, tension = griffith_means(half_length_m, over_m)
    return net_Pa * (tension + shear / friction)
