"""Asks strata-reference for analytic values, so that no test has to hold one."""

import json
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from verification.harness.paths import reference_program


class NoReference(Exception):
    """The reference program does not know what it was asked, or failed; the message is its own."""


@dataclass(frozen=True)
class Value:
    """A reference value with its unit."""

    value: float
    unit: str


Setting = float | str | list[float]


@cache
def _answer(name: str, settings: tuple[str, ...]) -> dict[str, Any]:
    """What strata-reference says for a name and settings."""
    command = [str(reference_program()), name, *(word for setting in settings for word in ("--set", setting))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise NoReference(f"{' '.join(command)}: exit {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def settings_of(settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Settings as the program takes them, numbers with all their digits."""
    return tuple(f"{key}={given!r}" if isinstance(given, (float, list)) else f"{key}={given}" for key, given in settings.items())


def _ask(name: str, settings: Mapping[str, Setting]) -> dict[str, Any]:
    """The same for settings by their names."""
    return _answer(name, settings_of(settings))


def reference(name: str, **settings: Setting) -> dict[str, Value]:
    """The values of a named reference solution for its settings, in the units they state; those that are lists or words left out."""
    values = _ask(name, settings)["values"]
    return {key: Value(float(item["value"]), str(item.get("unit", ""))) for key, item in values.items() if not isinstance(item["value"], (list, str))}


def values(name: str, quantity: str, **settings: Setting) -> np.ndarray:
    """One quantity of a named reference solution at each of the places or times that a setting lists, SI."""
    found = _ask(name, settings)["values"]
    if quantity not in found:
        raise NoReference(f"{name} has no {quantity}; it has {', '.join(sorted(found))}")
    return np.atleast_1d(np.array(found[quantity]["value"], dtype=float))


def value(name: str, quantity: str, **settings: Setting) -> float:
    """One value of a named reference solution, SI."""
    return float(values(name, quantity, **settings).item())


def relative_error(name: str, **settings: Setting) -> float:
    """The relative error that a named reference solution gives of itself."""
    return float(_ask(name, settings)["error_estimate"]["relative"])
