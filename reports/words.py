"""What is shown: plain data under names, and numbers as words: units, rounding and lists, used by titles, captions and tables."""

import math
import re
from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

# How keys end, with the factor to the printed unit and that unit; longer endings before those they end in.
_SCALES: tuple[tuple[str, float, str], ...] = (
    ("Pa_sqrt_m", 1e-6, "MPa√m"), ("Pa_per_m", 1e-6, "MPa/m"), ("Pa_m", 1e-6, "MPa/m"), ("MPa", 1.0, "MPa"), ("1_s", 1.0, "1/s"),
    ("kg_m3", 1.0, "kg/m³"), ("N_m", 1.0, "N/m"), ("J_m", 1.0, "J/m"), ("m2", 1.0, "m²"), ("Pa", 1e-6, "MPa"), ("mm", 1.0, "mm"),
    ("deg", 1.0, "°"), ("MB", 1.0, "MB"), ("m", 1.0, "m"), ("s", 1.0, "s"), ("J", 1.0, "J/m"),
)
NONE = "–"  # where there is no number


def written(value: Any, words: Callable[[Any], str]) -> str:
    """A number in words, a dash where there is none."""
    return words(value) if isinstance(value, (int, float)) else NONE


def minus(text: str) -> str:
    """Hyphens as minus signs."""
    return text.replace("-", "−")


def number(value: float, digits: int = 3) -> str:
    """A number with so many significant digits, without a needless exponent, and exact ones without trailing zeros."""
    if not math.isfinite(value):
        return "not finite"
    if abs(value) < 1e-13:  # round-off of any quantity shown here
        return "0"
    if abs(value) < 1e4 and abs(value - float(f"{value:.{digits}g}")) < 1e-9 * abs(value):
        return minus(f"{value:.{digits}g}") if abs(value) >= 1e-3 else scientific(value, digits)
    size = math.floor(math.log10(abs(value)))
    if size < -3 or size > 6:
        return scientific(value, digits)
    return minus(f"{value:,.{max(0, digits - 1 - size)}f}").replace(",", "\u202f")


def scientific(value: float, digits: int) -> str:
    """A number as mantissa and power of ten, in superscript digits."""
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return minus(f"{mantissa}×10{str(int(exponent)).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))}")


def general(value: float | None, digits: int = 4) -> str:
    """A number with at most so many significant digits, by an exponent where it is very large or small; a dash for none."""
    return NONE if value is None or not math.isfinite(value) else minus(f"{value:.{digits}g}")


def span(values: Sequence[float], digits: int = 3) -> str:
    """A number, or from the least to the largest."""
    return " to ".join(dict.fromkeys(general(value, digits) for value in (min(values), max(values)))) if values else NONE


def thousands(count: float | None) -> str:
    """A count with thin spaces between thousands; a dash for none."""
    return f"{int(count):,}".replace(",", "\u202f") if isinstance(count, (int, float)) else NONE


def mpa(pressure_Pa: float, decimals: int = 2, sign: str = "") -> str:
    """A pressure in Pa written in MPa, to two decimals unless asked otherwise; with its sign where that is "+"."""
    return minus(f"{pressure_Pa / 1e6:{sign}.{decimals}f}\u00a0MPa") if sign else f"{pressure_Pa / 1e6:.{decimals}f}\u00a0MPa"


def millimetres(length_m: float) -> str:
    """A small length in mm; a hundredth is the least that is told."""
    return f"{number(1e3 * length_m, 2)}\u00a0mm" if length_m >= 1e-5 else "<\u00a00.01\u00a0mm"


def wall_time(time_s: float) -> str:
    """A wall time in s, or min from 100 s on."""
    return f"{number(time_s / 60.0, 2)}\u00a0min" if time_s >= 100.0 else f"{number(time_s, 2)}\u00a0s"


def order_words(order: float, decimals: int = 1) -> str:
    """An order of convergence with one decimal unless asked otherwise."""
    return minus(f"{round(order, decimals) + 0.0:.{decimals}f}")


def relative(error: float, signed: bool = False) -> str:
    """A relative error: in per cent, or below 1e-6 as a power of ten."""
    if math.isnan(error):
        return NONE
    words = "0" if error == 0.0 else share(error) if abs(error) >= 1e-6 else scientific(error, 2)
    return f"+{words}" if signed and error > 0.0 else words


def metres(length_m: float) -> str:
    """A length in m to one decimal, or none where it is whole."""
    return f"{length_m:.1f}\u00a0m".replace(".0\u00a0m", "\u00a0m")


def share(fraction: float) -> str:
    """A fraction as a percentage."""
    return f"{number(100.0 * fraction, 2)}\u00a0%"


def counted(count: int, word: str) -> str:
    """A count with its word."""
    return f"{count} {word if count == 1 else word[:-1] + 'ies' if word.endswith('y') else word + 's'}"


def sentence(words: str) -> str:
    """Words with a capital and a full stop."""
    return f"{words[:1].upper()}{words[1:].rstrip('.')}." if words else ""


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


_MECHANICS_NAMES: dict[str, str] = {"explicit": "with inertia", "quasistatic": "without inertia"}


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


class Shown(SimpleNamespace):
    """What is shown, under names that carry their units; a figure's has its finding as `title`."""
