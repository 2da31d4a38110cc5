"""A fracture that passes a column of particles at a small angle: what is left of a node's rock on one side is a particle or two."""

from verification.harness.load import E_prime, Run, path_key
from verification.stability.family import (
    AT_REST, CRACK, HALF_LENGTH_M, MIDDLE_M, SETTLING, Checked, Family, Parameter, at_values, close, farthest_off, griffith_K, sneddon_opening,
    walked,
)  # fmt: skip

# Of the crack's middle from a grid line: columns of particles, 4 x 4 in cells of 1 m, are at 0.125 and 0.375. As many of these places as
# not made a crack open 1.2 to 30 times too far before light copies took no load.
OFFSETS_M = (0.2, 0.3, 0.375, 0.385, 0.405, 0.475, 0.5, 0.51, 0.53)


def opening(run: Run) -> Checked:
    """The opening at the crack's middle and J of both tips against Sneddon's: the worse of the two."""
    found = close(run.summary.mouth_opening_m, sneddon_opening(run), 0.03, "opening at the middle")
    J = griffith_K(run) ** 2 / E_prime(run)
    by_J = close(farthest_off([tip.J_N_m for tip in run.summary.tips], J), J, 0.03, "J")
    return max(found, by_J, key=lambda checked: abs(checked.error))


def leaning(slope: float, offset_m: float) -> str:
    """A crack that leans by `slope`, its middle at a distance from a grid line."""
    x, reach = MIDDLE_M + offset_m, slope * HALF_LENGTH_M
    return path_key((x - reach, 11.0), (x + reach, 21.0))


def family(slope: float, name: str, keys: tuple[str, ...] = AT_REST, how: str = "without inertia", offsets: tuple[float, ...] = OFFSETS_M) -> Family:
    """The walk of a crack of a slope towards a column."""
    return Family(
        f"grazing_{name}", f"A crack that leans by {slope:g}, past a column of particles, {how}",
        "However near to a column of particles the path passes, opening and J are those of the closed form.",
        Parameter("middle of the crack from a grid line", "m"),
        walked(at_values(CRACK, lambda offset: (*keys, leaning(slope, offset)), "{:g} m"), offsets, smoke=(0.385, 0.5)), opening,
        section="Small parts cut off by a fracture",
    )  # fmt: skip


FAMILIES = (
    family(0.03, "3"), family(0.1, "10"), family(0.2, "20"),
    family(0.1, "10_explicit", SETTLING, "brought to rest by damping", (0.2, 0.385, 0.5)),
)  # fmt: skip
