"""A pressurised crack that ends on the middle of a finite one with friction: traction, slip and opening along the latter.

The reference are curves of another code (Phan, Napier, Gray & Kaplan 2003), digitised by others; their noise is about 0.3 MPa and 0.3 mm.
"""

from collections.abc import Callable

import numpy as np

from verification.harness.load import Array, Run, given, last
from verification.harness.paths import ANALYTIC
from verification.ladder.case import Quantity, Sample, case_of, cell_levels

MARK_PA, MARK_M = 3e6, 1.5e-3  # what differences may reach: 2.5 % of the traction far away, 2 % of the largest slip
DIGITISED = "the reference is read off a figure"


def curve(name: str) -> tuple[Array, Array]:
    """Places along the crack (m) and values (MPa, mm) of a digitised curve."""
    table = np.loadtxt(ANALYTIC / f"phan2003_{name}.txt")
    return table[:, 0], table[:, 1]


def spline(distance_cells: Array) -> Array:
    """Quadratic B-spline of the distance from its node, in cells."""
    s = np.abs(distance_cells)
    return np.where(s < 0.5, 0.75 - s**2, np.where(s < 1.5, 0.5 * (1.5 - s) ** 2, 0.0))


def along(run: Run) -> tuple[Array, dict[str, Array], float]:
    """Places along the crack with friction (m), its fields and its length."""
    fields, place = last(run, "interfaces")[1], run.scene["strata"]["interfaces"][0]
    return fields["0/x_m"] - place["from_m"], fields, place["to_m"] - place["from_m"]


def traction(run: Run) -> Sample:
    """Compression by the force on each node of the grid, over the length that is its own: what single points carry beside a part that opens is
    not determined, what nodes carry is. The curve is weighted alike. Nodes more than a cell from junction and ends, in uniform cells."""
    x, fields, length = along(run)
    h, far = given(run, "numerics.cell_m"), 0.5 * (x[1:] + x[:-1])
    A = np.diff(np.concatenate(([0.0], far, [length])))
    nodes = np.arange(2.0 * h, length - 1.5 * h, h)
    nodes = nodes[np.abs(nodes - 0.5 * length) > 1.5 * h]
    weights = spline((x - nodes[:, None]) / h) * A
    filled = weights.sum(axis=1) > 0.99 * h  # a node of longer cells has more
    fine = np.linspace(0.0, length, 20001)
    at, MPa = curve("normal_traction")
    of_curve = spline((fine - nodes[:, None]) / h)
    exact = of_curve @ np.interp(fine, at, MPa) / of_curve.sum(axis=1) * 1e6
    found = weights @ fields["0/reaction_n_Pa"] / np.maximum(weights.sum(axis=1), 1e-12)
    return Sample(found[filled], exact[filled])


def slip(run: Run) -> Sample:
    """Slip at the curve's places more than a cell from the junction; the + face goes the other way than the curve has it."""
    x, fields, length = along(run)
    at, mm = curve("slip")
    asked = np.abs(at - 0.5 * length) > given(run, "numerics.cell_m")
    return Sample(np.interp(at[asked], x, fields["0/slip_m"]), 1e-3 * mm[asked])


def largest(name: str, unit: str, mark: float, sample: Callable[[Run], Sample]) -> Quantity:
    """The largest difference, in shares of what it may reach."""
    return Quantity(name, unit, lambda run: Sample.of(float(np.max(np.abs((s := sample(run)).values - s.exact))), 0.0, mark), DIGITISED)


CASES = (
    case_of(ANALYTIC / "t_crack.toml")(
        "t_crack", "a crack that ends on the middle of a finite one with friction", cell_levels(1.0, 0.5),
        (Quantity("normal traction", "Pa", traction, DIGITISED), largest("largest difference in normal traction, of 3 MPa", "Pa", MARK_PA, traction),
         Quantity("slip", "m", slip, DIGITISED), largest("largest difference in slip, of 1.5 mm", "m", MARK_M, slip)),
    ),
)  # fmt: skip
