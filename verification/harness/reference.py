"""Asks strata-reference for analytic values, so that no test has to hold one."""
from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from verification.harness.paths import reference_program


class NoReference(Exception):
    """The reference program does not know what it was asked, or failed; the message is its own."""


@dataclass(frozen=True)
class Value:
    """A reference value with its unit."""

    value: float
    unit: str


@lru_cache(maxsize=None)
def _ask(name: str, settings: tuple[str, ...]) -> str:
    """What strata-reference prints for a name and settings."""
    command = [str(reference_program()), name]
    for setting in settings:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise NoReference(f"{' '.join(command)}: exit {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def _settings(settings: dict[str, float | str | list[float]]) -> tuple[str, ...]:
    """Settings as the program takes them, numbers with all their digits."""
    return tuple(f"{key}={given!r}" if isinstance(given, (float, list)) else f"{key}={given}" for key, given in settings.items())


def reference(name: str, **settings: float | str | list[float]) -> dict[str, Value]:
    """The values of a named reference solution for its settings, in the units they state; those that are lists or words left out."""
    answer = json.loads(_ask(name, _settings(settings)))["values"]
    numbers = {key: item for key, item in answer.items() if not isinstance(item["value"], (list, str))}
    return {key: Value(float(item["value"]), str(item.get("unit", ""))) for key, item in numbers.items()}


def values(name: str, quantity: str, **settings: float | str | list[float]) -> np.ndarray:
    """One quantity of a named reference solution at each of the places or times that a setting lists, SI."""
    answer = json.loads(_ask(name, _settings(settings)))["values"]
    if quantity not in answer:
        raise NoReference(f"{name} has no {quantity}; it has {', '.join(sorted(answer))}")
    return np.atleast_1d(np.array(answer[quantity]["value"], dtype=float))


def value(name: str, quantity: str, **settings: float | str | list[float]) -> float:
    """One value of a named reference solution, SI."""
    found = reference(name, **settings)
    if quantity not in found:
        raise NoReference(f"{name} has no {quantity}; it has {', '.join(sorted(found))}")
    return found[quantity].value


def relative_error(name: str, **settings: float | str | list[float]) -> float:
    """The relative error that a named reference solution gives of itself."""
    return float(json.loads(_ask(name, _settings(settings)))["error_estimate"]["relative"])
