"""Writes run folders that look like the solver's, from made-up curves: what the page's tests read."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from verification.harness.claims import NOT_REPRODUCED, ONLY_UNDER_A_VARIANT, REPRODUCED, Case, CaseResult, ClaimResult, Reading, write_claims
from verification.tests.fake_run import write_files

RATE_PA_S = 0.35e6
START_PA = 2.0e6
OUTPUTS = 12
STEMS: dict[int, str] = {
    1: "exp1_single_interface", 2: "exp2_soft_above", 3: "exp3_two_interfaces",
    4: "exp4_soft_between", 5: "exp5_parallel_interface", 6: "exp6_stress_reversal",
}


@dataclass(frozen=True)
class Plan:
    """What a made-up run does: height in m at which it stops, inlet pressures in Pa, how far its tip drifts in m."""

    variant: str
    interfaces: tuple[str, ...] = ("perfect",)
    start_Pa: float = 2.4e6
    stop_at_m: float | None = None
    restart_Pa: float | None = None
    drift_m: float = 0.0
    status: str = "completed"
    reason: str = "tip at 70 m"
    extra: str = ""
    mechanics: str = "explicit"
    by: str = "J"  # what decided its events
    kinetic: float = 0.02  # kinetic energy as a share of the fluid's work


def scene_text(number: int, plan: Plan) -> str:
    """A resolved scene of one experiment."""
    along = "x" if number > 4 else "y"
    sizes = {3: "10, 10", 4: "10, 10", 5: "45", 6: "45"}.get(number, "10").split(", ")
    rocks = {2: "stiff soft", 4: "stiff soft stiff", 5: "soft stiff", 6: "stiff soft", 3: "stiff stiff stiff"}
    names = rocks.get(number, "stiff stiff").split()
    layers = [f'{{rock = "{name}", thickness_m = {size}}}' for name, size in zip(names, sizes)]
    layers.append(f'{{rock = "{names[-1]}"}}')
    interfaces = ", ".join(f'"{name}"' for name in plan.interfaces)
    return f"""title = "Experiment {number}: made up"
domain = {{width_m = 80, height_m = 80, bottom = "symmetry", sides = "fixed", top = "traction"}}
in_situ = {{vertical_Pa = 3.0e6, horizontal_Pa = 2.0e6, initialise = "uniform"}}
rock.stiff = {{youngs_modulus_Pa = 10.0e9, poisson_ratio = 0.2, toughness_Pa_sqrt_m = 1.45e6}}
rock.soft = {{youngs_modulus_Pa = 5.0e9, poisson_ratio = 0.2, toughness_Pa_sqrt_m = 1.25e6}}
interface = {{weak.law = "weak", friction.law = "friction", soft.law = "soft"}}
strata = {{along = "{along}", layers = [{", ".join(layers)}], interfaces = [{interfaces}]}}
fracture = {{path_m = [[40, 0], [40, 5]], growth = "J", increment_m = 1.0}}
numerics = {{mechanics = "{plan.mechanics}", cell_m = 2.0, shape = "bspline2"}}
{plan.extra}
"""


def height_at(plan: Plan, inlet_Pa: np.ndarray) -> np.ndarray:
    """The tip's height in m, whole metres, at inlet pressures in Pa."""
    free = 5.0 + 65.0 * np.clip((inlet_Pa - plan.start_Pa) / 0.5e6, 0.0, 1.0)
    if plan.stop_at_m is None:
        return np.floor(free)
    late = np.inf if plan.restart_Pa is None else plan.restart_Pa
    after = plan.stop_at_m + (70.0 - plan.stop_at_m) * np.clip((inlet_Pa - late) / 0.3e6, 0.0, 1.0)
    return np.floor(np.where(inlet_Pa < late, np.minimum(free, plan.stop_at_m), after))


def write_run(root: Path, number: int, plan: Plan) -> Path:
    """One run's folder with all its files."""
    folder = root / plan.mechanics / STEMS[number] / plan.variant
    inlet = np.linspace(START_PA, 4.0e6, 120)
    height = height_at(plan, inlet)
    end = int(np.argmax(height >= 70.0)) if (height >= 70.0).any() else inlet.size - 1
    if plan.status == "failed":
        end = inlet.size // 4
    inlet, height = inlet[: end + 1], height[: end + 1]
    drift = plan.drift_m * ((height - 5.0) / 65.0) ** 2
    write_files(folder, scene_text(number, plan), _history(plan, inlet, height, drift), _summary(folder, plan, inlet, height, drift))
    _write_fields(folder, inlet, height, plan)
    return folder


def _history(plan: Plan, inlet: np.ndarray, height: np.ndarray, drift: np.ndarray) -> dict[str, np.ndarray]:
    """The history with the ledger's columns, and in quasi-static the energy released."""
    work, same = 1e3 * (height - 5.0) ** 1.5, np.ones_like(inlet)
    return {
        "time_s": (inlet - START_PA) / RATE_PA_S, "inlet_Pa": inlet, "tip_x_m": 40.0 + drift, "tip_y_m": height, "height_m": height,
        "J_N_m": 200.0 * same, "kinetic_J": plan.kinetic * work * (plan.mechanics == "explicit"), "strain_J": 0.6 * work, "fluid_work_J": work,
        "damping_J": 0.3 * work, "friction_J": 0.075 * work, "J_spread": 0.006 * same,
        **({"G_N_m": 204.0 * same, "G_by_J_N_m": 200.0 * same} if plan.mechanics == "quasistatic" else {}),
    }


def _summary(folder: Path, plan: Plan, inlet: np.ndarray, height: np.ndarray, drift: np.ndarray) -> dict[str, Any]:
    """The summary with the events that the curve has."""
    stop = np.inf if plan.stop_at_m is None else plan.stop_at_m
    when = {"start": height > 5.0, "reach_interface": height >= stop, "arrest": height >= stop,
            "restart": (height > stop) & (plan.restart_Pa is not None)}
    rows = [(kind, int(np.argmax(there))) for kind, there in when.items() if there.any()]
    events = []
    for kind, row in [*rows, ("stop", inlet.size - 1)]:
        near = plan.interfaces[0] != "perfect" and bool(abs(height[row] - 10.0) <= 3.0)
        events.append({"kind": kind, "time_s": (inlet[row] - START_PA) / RATE_PA_S, "inlet_Pa": inlet[row], "tip_x_m": 40.0 + drift[row],
                       "tip_y_m": height[row], "by": plan.by, "at_interface": plan.by == "J" and near})
    return {"scene": folder.parent.name, "variant": plan.variant, "status": plan.status, "reason": plan.reason, "mechanics": plan.mechanics,
            "inlet_Pa": inlet[-1], "energy": {"closure": 0.005}, "suspect": [], "events": events,
            "tips": [{"x_m": 40.0, "y_m": height[-1], "J_spread": 0.006, "kink_deg": 1.0}]}


def _write_fields(folder: Path, inlet: np.ndarray, height: np.ndarray, plan: Plan) -> None:
    """result.h5 with fracture and particles at a few output times."""
    rows = np.unique(np.linspace(0, inlet.size - 1, OUTPUTS).astype(int))
    x_m, y_m = (part.ravel() for part in np.meshgrid(np.arange(0.5, 80.0), np.arange(0.5, 80.0)))
    with h5py.File(folder / "result.h5", "w") as store:
        store["times"] = (inlet[rows] - START_PA) / RATE_PA_S
        for index, row in enumerate(rows):
            group = store.create_group(f"fracture/{index:05d}")
            group.attrs.update(time_s=(inlet[row] - START_PA) / RATE_PA_S, inlet_Pa=inlet[row])
            points = np.arange(0.0, height[row] + 0.5)
            group["y_m"], group["arc_m"] = points, points
            group["x_m"] = 40.0 + plan.drift_m * (np.clip(points - 5.0, 0.0, None) / 65.0) ** 2
            group["opening_m"] = 1e-4 * np.sqrt(np.clip(height[row] ** 2 - points**2, 0.0, None))
            group["slip_m"] = 0.0 * points
            group["pressure_Pa"] = inlet[row] * (1.0 - 0.5 * points / points[-1])
            group["permeability_m2"] = np.maximum(group["opening_m"][()], 1e-4) ** 2 / 12.0
            if plan.interfaces[0] != "perfect":
                along = np.arange(0.5, 80.0)
                interface = store.create_group(f"interfaces/{index:05d}/0")
                interface.attrs["at_m"] = 10.0
                interface["slip_m"], interface["opening_m"] = np.zeros((2, along.size))
                interface["x_m"], interface["y_m"] = along, np.full_like(along, 10.0)
                interface["split"] = (np.abs(along - 40.0) < 6.0).astype(int)
            cloud = store.create_group(f"particles/{index:05d}")
            cloud["x_m"], cloud["y_m"], cloud["volume_m2"] = x_m, y_m, np.ones_like(x_m)
            near = np.exp(-np.hypot(x_m - 40.0, y_m - height[row]) / 5.0)
            cloud["s_xx_Pa"], cloud["s_yy_Pa"], cloud["s_xy_Pa"] = -2.0e6 + 0.5e6 * near, np.full_like(x_m, -3.0e6), np.zeros_like(x_m)


def write_both(root: Path, number: int, plan: Plan) -> None:
    """A run in each mechanics; without inertia it starts 0.03 MPa earlier and decides by energy."""
    write_run(root, number, plan)
    write_run(root, number, replace(plan, mechanics="quasistatic", by="energy", start_Pa=plan.start_Pa - 0.03e6))


def write_all(root: Path) -> Path:
    """All six experiments with their interface types in both mechanics, one run failed; returns the folder of runs."""
    runs = root / "runs"
    weak = {"stop_at_m": 10.0, "restart_Pa": 3.2e6}
    for number in (1, 2):
        for plan in (Plan("perfect"), Plan("friction", ("friction",)), Plan("weak", ("weak",), **weak), Plan("soft", ("soft",), stop_at_m=10.0)):
            write_both(runs, number, plan)
    write_both(runs, 1, Plan("uniform", start_Pa=2.36e6, extra='[fluid]\nlaw = "uniform"'))
    for plan in (Plan("perfect", ("perfect", "perfect")), Plan("weak_soft", ("weak", "soft"), **weak),
                 Plan("soft_weak", ("soft", "weak"), stop_at_m=10.0, restart_Pa=3.0e6)):
        write_both(runs, 3, plan)
    for plan in (Plan("perfect", ("perfect", "perfect")), Plan("weak", ("weak", "weak"), **weak),
                 Plan("soft", ("soft", "soft"), status="failed", reason="a mechanism: the upper block is free")):
        write_both(runs, 4, plan)
    for number, sign in ((5, -1.0), (6, 1.0)):
        for plan in (Plan("perfect", drift_m=0.4 * sign), Plan("friction", ("friction",), drift_m=0.405 * sign),
                     Plan("soft", ("soft",), drift_m=1.3 * sign)):
            write_both(runs, number, plan)
    write_claims(claims(), runs / "claims.json")
    return runs


def case(variant: str = "weak", holds: bool | None = True, value: float = 6.4e5, high: float | None = 6.4e5) -> CaseResult:
    """A case of a plateau: without an upper bound it is open from above."""
    asked = Case("plateau_Pa", variant, at_least=5e4, parameters={"interface": 1})
    note = "" if high is not None else "does not grow on from 10 m"
    return CaseResult(**vars(asked), unit="Pa", value=value, low=value, high=high, holds=holds, note=note)


def claims() -> list[ClaimResult]:
    """Three claims in both mechanics, which agree but on the last."""
    found = []
    for mechanics, flags in (("explicit", ("J at interface",)), ("quasistatic", ())):
        failing, loaded = (case(holds=False),), (case("soft", None, 1.6e6, None),)
        under = (Reading("edges: loaded", True, (case(),), "loaded", True),)
        last = REPRODUCED if mechanics == "quasistatic" else ONLY_UNDER_A_VARIANT
        found += [
            ClaimResult("1b", STEMS[1], mechanics, "Weak and soft stop the fracture.", "0.05 MPa is an arrest.", "plateau_Pa",
                        REPRODUCED, True, (case(), case("soft", True, 1.6e6, None)), (), flags),
            ClaimResult("5a", STEMS[5], mechanics, "The path turns away from the stiff rock.", "Its sign.", "lateral_deflection_m",
                        NOT_REPRODUCED, False, failing, (Reading("edges: loaded", None, loaded, "loaded", False),), ()),
            ClaimResult("2c", STEMS[2], mechanics, "The start is later.", "Its pressure.", "start_Pa", last,
                        mechanics == "quasistatic", failing if mechanics == "explicit" else (case(),), under, ()),
        ]
    return found
