"""The value at which something ceases to hold."""

from collections.abc import Callable


def bisected(sound: Callable[[float], bool], good: float, bad: float, resolution: float) -> tuple[float, float]:
    """The last sound and first unsound value, halving what is between until they differ by `resolution` of the larger one.

    Raises ValueError where the first is not sound or the second one is.
    """
    if not sound(good) or sound(bad):
        raise ValueError(f"{good:g} and {bad:g} do not enclose the edge")
    while abs(bad - good) > resolution * max(abs(good), abs(bad)):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if sound(middle) else (good, middle)
    return good, bad
