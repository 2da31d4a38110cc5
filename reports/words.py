"""Numbers as words: units, rounding and lists, used by titles, captions and tables."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

_SCALES: tuple[tuple[str, float, str], ...] = (
    ("Pa_sqrt_m", 1e-6, "MPa√m"),
    ("Pa_per_m", 1e-6, "MPa/m"),
    ("Pa_m", 1e-6, "MPa/m"),
    ("MPa", 1.0, "MPa"),
    ("1_s", 1.0, "1/s"),
    ("kg_m3", 1.0, "kg/m³"),
    ("N_m", 1.0, "N/m"),
    ("J_m", 1.0, "J/m"),
    ("m2", 1.0, "m²"),
    ("Pa", 1e-6, "MPa"),
    ("mm", 1.0, "mm"),
    ("deg", 1.0, "°"),
    ("MB", 1.0, "MB"),
    ("m", 1.0, "m"),
    ("s", 1.0, "s"),
    ("J", 1.0, "J/m"),
)


def number(value: float, digits: int = 3) -> str:
    """A number with so many significant digits, without a needless exponent, and exact ones without trailing zeros."""
    if not math.isfinite(value):
        return "not finite"
    if abs(value) < 1e-13:  # round-off of any quantity shown here
        return "0"
    if abs(value) < 1e4 and abs(value - float(f"{value:.{digits}g}")) < 1e-9 * abs(value):
        return f"{value:.{digits}g}".replace("-", "−") if abs(value) >= 1e-3 else scientific(value, digits)
    size = math.floor(math.log10(abs(value)))
    if size < -3 or size > 6:
        return scientific(value, digits)
    return f"{value:,.{max(0, digits - 1 - size)}f}".replace("-", "−").replace(",", "\u202f")


def scientific(value: float, digits: int) -> str:
    """A number as mantissa and power of ten."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}×10{_raised(int(exponent))}".replace("-", "−")


def _raised(exponent: int) -> str:
    """An integer written in superscript digits."""
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def mpa(pressure_Pa: float, decimals: int = 2) -> str:
    """A pressure in Pa written in MPa, to two decimals unless asked otherwise."""
    return f"{pressure_Pa / 1e6:.{decimals}f}\u00a0MPa"


def metres(length_m: float) -> str:
    """A length in m to one decimal, or none where it is whole."""
    return f"{length_m:.1f}\u00a0m".replace(".0\u00a0m", "\u00a0m")


def share(fraction: float) -> str:
    """A fraction as a percentage."""
    return f"{number(100.0 * fraction, 2)}\u00a0%"


def listed(items: Sequence[str]) -> str:
    """Words joined by commas and a last 'and'."""
    if len(items) < 2:
        return "".join(items)
    return ", ".join(items[:-1]) + " and " + items[-1]


def experiment_name(experiment: str) -> str:
    """'Experiment 1' from a scene's name, else the name."""
    found = re.match(r"exp(\d+)", experiment)
    return f"Experiment {found.group(1)}" if found else plain(experiment)


def plain(name: str) -> str:
    """A key or a variant's name as words; two interface types one above the other are joined by a dash."""
    return name.replace("_", "–" if name in ("weak_soft", "soft_weak") else " ")


_MECHANICS_NAMES: dict[str, str] = {"explicit": "explicit", "quasistatic": "quasi-static"}


def mechanics_name(mechanics: str) -> str:
    """A mechanics as words, with the size of cells where one follows."""
    name, space, cells = mechanics.partition(" ")
    return _MECHANICS_NAMES.get(name, name) + space + cells


def split_unit(key: str) -> tuple[str, float, str]:
    """A key such as restart_inlet_Pa as words, the factor to its printed unit, and that unit."""
    for suffix, factor, unit in _SCALES:
        if key == suffix or key.endswith("_" + suffix):
            return plain(key[: len(key) - len(suffix)].rstrip("_")), factor, unit
    return plain(key), 1.0, ""


def setting(value: Any) -> str:
    """A scene key's value as the scene has it, its unit being in the key; 'unset' where there is none."""
    if value is None:
        return "unset"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        if value == 0.0 or 1e-3 <= abs(value) < 1e5:
            return f"{value:g}"
        mantissa, exponent = f"{value:.5e}".split("e")
        return f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(setting(item) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name} = {setting(item)}" for name, item in value.items()) + "}"
    return str(value)


def quantity(key: str, value: Any) -> str:
    """A value written with the unit that its key ends in."""
    _, factor, unit = split_unit(key)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return "none"
    if isinstance(value, (int, float)):
        space = "" if unit in ("", "°") else "\u00a0"
        return number(float(value) * factor) + space + unit
    if isinstance(value, (list, tuple)):
        return ", ".join(quantity(key, item) for item in value) or "none"
    if isinstance(value, dict):
        return "; ".join(f"{plain(k)} {quantity(k if unit == '' else key, v)}" for k, v in value.items())
    return str(value)
