"""What K near an interface may be off by, whatever was measured: the gates of the ladder, which its runs are judged by, keep it."""
from __future__ import annotations

import pytest

from verification.harness.reference import value
from verification.ladder import gates
from verification.ladder.cases.interfaces import CASES

GATES = gates.read("interfaces")

# Largest relative error of K_I by the number of cells between the crack and the interface.
BONDED = {"4 cells": 0.01, "8 cells": 0.005, "16 cells": 0.005}
SPRINGS = {"4 cells": 0.01, "8 cells": 0.01}
ANGLE_DEG = 0.2


def of(quantity: str, *cases: str) -> list[tuple[str, str, str]]:
    """Keys of the gates of a quantity, of whichever tip, in cases that begin so, 4 cells or more from the interface."""
    found = [key for key in GATES if key[0].startswith(cases) and key[1].split(",")[0] == quantity and key[2] != "2 cells"]
    assert found
    return found


def test_K_near_a_bonded_interface() -> None:
    """K_I within 0.5 % at 8 cells from it and 1 % at 4, crack normal or parallel, either rock, both tips."""
    keys = of("K_I", "bonded_")
    assert {key[0] for key in keys} == {case.name for case in CASES if case.name.startswith("bonded_")}
    wide = [key for key in keys if GATES[key].error > BONDED[key[2]]]
    assert wide == []


@pytest.mark.parametrize("distance_m", [1.25, 2.5, 5.0])
@pytest.mark.parametrize(("held_by", "modulus_Pa", "beyond_Pa"), [("stiff", 10e9, 5e9), ("soft", 5e9, 10e9)])
def test_kink_beside_a_bonded_interface(held_by: str, modulus_Pa: float, beyond_Pa: float, distance_m: float) -> None:
    """The kink angle within 0.2 degrees at 4 cells from it and more, at both tips."""
    rocks = {"youngs_modulus_Pa": modulus_Pa, "beyond_youngs_modulus_Pa": beyond_Pa}
    kink_deg = value("bonded_parallel", "kink_deg", half_length_m=5.0, distance_m=distance_m, **rocks)
    keys = of("kink angle", f"bonded_parallel_{held_by}_{distance_m:g}")
    assert [key for key in keys if GATES[key].error * abs(kink_deg) > ANGLE_DEG] == []


def test_K_near_springs_and_without_friction() -> None:
    """K_I within 1 % at D a/E' = 0.01 to 100, near a free surface and a frictionless interface, both tips."""
    wide = [key for key in of("K_I", "springs_", "free", "frictionless") if GATES[key].error > SPRINGS[key[2]]]
    assert wide == []
