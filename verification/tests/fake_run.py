"""Writes run folders as the contract describes them, so that the harness can be tested without the solver."""

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

# Columns of the history that say nothing, and what a summary says of the run itself.
CONSTANT = {
    "J_N_m": 201.0, "K_I_Pa_sqrt_m": 1.4e6, "K_II_Pa_sqrt_m": 0.0, "mouth_opening_m": 1e-3, "fracture_volume_m2": 1e-3,
    "kinetic_J": 1.0, "strain_J": 10.0, "interface_strain_J": 0.0,
}  # fmt: skip
OF_THE_RUN = {
    "cells": 6400, "particles": 25600, "steps": 100, "time_s": 1.0, "wall_s": 1.0, "particle_steps_per_s": 1e7, "peak_memory_MB": 50.0, "version": "0",
    "mouth_opening_m": 1e-3, "fracture_volume_m2": 1e-3,
}  # fmt: skip

SCENE = """
title = "made up"
domain = {{width_m = 80, height_m = 80}}
strata = {{along = "{along}", layers = {layers}, interfaces = {interfaces}}}
fracture = {{path_m = [[40.0, 0.0], [40.0, 5.0]], increment_m = 1.0}}
numerics = {{mechanics = "{mechanics}", cell_m = 1.0}}
"""

SOLVER = Path(__file__).with_name("fake_solver.sh").read_text(encoding="utf-8")
START_PA, RATE_PA_S = 2.0e6, 0.35e6

Step = tuple[float, float, float]  # inlet pressure (Pa) at which the tip gets to x, y (m)


def time_of(inlet_Pa: float) -> float:
    """Time at which the ramp is at a pressure, s."""
    return (inlet_Pa - START_PA) / RATE_PA_S


def events_of(steps: Sequence[Step], end_Pa: float, mechanics: str) -> list[dict[str, Any]]:
    """The events of a growth history: start, arrests of 0.05 MPa or more, restarts, stop; with inertia by J, as if at an interface."""
    decided = {"by": "J", "at_interface": True} if mechanics == "explicit" else {"by": "energy", "at_interface": False}

    def event(kind: str, inlet_Pa: float, x: float, y: float) -> dict[str, Any]:
        return {"kind": kind, "time_s": time_of(inlet_Pa), "inlet_Pa": inlet_Pa, "tip_x_m": x, "tip_y_m": y, **decided}

    events = [event("start", *steps[0])] if steps else []
    for k, step in enumerate(steps):
        until = steps[k + 1][0] if k + 1 < len(steps) else end_Pa
        if until - step[0] >= 0.05e6:
            events.append(event("arrest", *step))
            if k + 1 < len(steps):
                events.append(event("restart", until, step[1], step[2]))
    last = steps[-1][1:] if steps else (40.0, 5.0)
    return [*events, event("stop", end_Pa, *last)]


def write_files(folder: Path, scene: str, columns: Mapping[str, Iterable[float]], summary: Mapping[str, Any]) -> None:
    """Write scene, history and summary of a run."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    lines = [",".join(columns), *(",".join(map(str, row)) for row in zip(*columns.values()))]
    (folder / "history.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "summary.json").write_text(json.dumps({**OF_THE_RUN, **summary}), encoding="utf-8")


def history_of(steps: Sequence[Step], end_Pa: float, friction_J: float) -> dict[str, Sequence[float]]:
    """The columns of a history: the start, a row a step, the end; energy in interfaces grows with the steps."""
    rows = [(START_PA, 40.0, 5.0, 0.0)]
    rows += [(p, x, y, friction_J * (k + 1) / len(steps)) for k, (p, x, y) in enumerate(steps)]
    rows.append((end_Pa, *rows[-1][1:]))
    inlet, x, y, spent = zip(*rows)
    return {
        "time_s": [time_of(p) for p in inlet], "inlet_Pa": inlet, "tip_x_m": x, "tip_y_m": y, "height_m": y,
        **{name: [value] * len(rows) for name, value in CONSTANT.items()}, **{name: [0.5 * one for one in spent] for name in ("friction_J", "failure_J")},
    }  # fmt: skip


def write_result(folder: Path, failed_m: Sequence[tuple[float, float]]) -> None:
    """Write result.h5 with one interface, of which a length (m) has failed at each of some pressures (Pa)."""
    x = np.arange(0.25, 80.0, 0.5)
    with h5py.File(folder / "result.h5", "w") as store:
        store["times"] = np.array([time_of(inlet_Pa) for inlet_Pa, _ in failed_m])
        store.create_group("interfaces")
        for k, (_, length) in enumerate(failed_m):
            place = store.create_group(f"interfaces/{k:05d}/0")
            place["x_m"], place["y_m"], place["split"] = x, np.full_like(x, 10.0), (np.arange(len(x)) < length / 0.5).astype(int)


def write_run(
    folder: Path, steps: Sequence[Step], end_Pa: float = 3.0e6,
    layers: str = '[{rock = "stiff", thickness_m = 10.0}, {rock = "stiff", thickness_m = 70.0}]', along: str = "y", status: str = "completed",
    friction_J: float = 0.0, failed_m: Sequence[tuple[float, float]] = (), mechanics: str = "explicit",
) -> Path:
    """Write a whole run folder from its growth steps."""
    interfaces = "[" + ", ".join(['"weak"'] * (layers.count("{") - 1)) + "]"
    x, y = steps[-1][1:] if steps else (40.0, 5.0)
    tip = {"x_m": x, "y_m": y, "K_I_Pa_sqrt_m": 1.4e6, "K_II_Pa_sqrt_m": None, "J_N_m": 201.0, "J_spread": 0.004, "kink_deg": 0.0}
    summary = {
        "scene": folder.parent.name, "variant": folder.name, "status": status, "reason": "" if status == "completed" else "made to fail",
        "mechanics": mechanics, "time_s": time_of(end_Pa), "inlet_Pa": end_Pa, "energy": {"kinetic": 1.0}, "tips": [tip],
        "events": events_of(steps, end_Pa, mechanics),
    }  # fmt: skip
    scene = SCENE.format(along=along, layers=layers, interfaces=interfaces, mechanics=mechanics)
    write_files(folder, scene, history_of(steps, end_Pa, friction_J), summary)
    write_result(folder, failed_m)
    return folder


def changed(folder: Path, **content: Any) -> Path:
    """Put other content into a run's summary; None takes a key out."""
    path = folder / "summary.json"
    summary = json.loads(path.read_text(encoding="utf-8")) | content
    path.write_text(json.dumps({key: value for key, value in summary.items() if value is not None}), encoding="utf-8")
    return folder


def program(path: Path, text: str = SOLVER) -> Path:
    """Write a program that stands for the solver."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.chmod(0o755)
    return path


def climb(start_Pa: float = 2.36e6, to_m: float = 70.0, slope_Pa_m: float = 5.0e3, plateaus: dict[float, float] | None = None) -> list[Step]:
    """Growth from 6 m up, a step a metre and `slope_Pa_m` more each, with plateaus (Pa) on leaving given heights (m)."""
    steps, pressure, height = [], start_Pa, 6.0
    while height <= to_m + 1e-9:
        steps.append((pressure, 40.0, height))
        pressure += slope_Pa_m + (plateaus or {}).get(height, 0.0)
        height += 1.0
    return steps
