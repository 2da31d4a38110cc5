"""Asks strata-reference for analytic values, so that no test has to hold one."""
from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from functools import lru_cache

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


def reference(name: str, **settings: float | str) -> dict[str, Value]:
    """The values of a named reference solution for its settings, in the units they state."""
    answer = json.loads(_ask(name, tuple(f"{key}={value!r}" if isinstance(value, float) else f"{key}={value}" for key, value in settings.items())))
    return {key: Value(float(item["value"]), str(item.get("unit", ""))) for key, item in answer["values"].items()}


def value(name: str, quantity: str, **settings: float | str) -> float:
    """One value of a named reference solution, SI."""
    values = reference(name, **settings)
    if quantity not in values:
        raise NoReference(f"{name} has no {quantity}; it has {', '.join(sorted(values))}")
    return values[quantity].value
