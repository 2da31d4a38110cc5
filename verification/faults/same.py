"""Whether two run folders say the same, but for what the clock says, and whether an interrupted one can be read."""

import csv
import json
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from verification.harness.load import items_below

# What a process says of itself: it may differ between equal runs.
OF_THE_PROCESS = ("wall_s", "particle_steps_per_s", "peak_memory_MB", "threads")

Content = dict[str, Any]


def stored(file: Path) -> Content:
    """All data sets and attributes of an HDF5 file by their paths, values as the bytes they are."""
    found: Content = {}
    with h5py.File(file, "r") as store:
        for name, item in (("/", store), *items_below(store)):
            if isinstance(item, h5py.Dataset):
                values = item[()]
                found[name] = (values.dtype.str, values.shape, np.ascontiguousarray(values).tobytes())
            for key, value in item.attrs.items():
                found[f"{name}@{key}"] = str(value) if isinstance(value, str) else np.asarray(value).tobytes()
    return found


def summary(file: Path) -> Content:
    """A summary without what the process says of itself."""
    content = json.loads(file.read_text(encoding="utf-8"))
    return {key: value for key, value in content.items() if key not in OF_THE_PROCESS}


def differences(one: Path, other: Path) -> list[str]:
    """What differs between two run folders, a line each; empty where they say the same."""
    found = [f"{name}: other bytes" for name in ("scene.toml", "history.csv", "result.xdmf") if (one / name).read_bytes() != (other / name).read_bytes()]
    for name, read in (("summary.json", summary), ("result.h5", stored)):
        first, second = read(one / name), read(other / name)
        found += [f"{name}: {key}" for key in sorted(first.keys() | second.keys()) if first.get(key) != second.get(key)]
    return found


def torn(folder: Path) -> list[str]:
    """What of a folder whose run was killed cannot be read whole, a line each; what is not there yet is not torn."""
    found = []
    try:
        if (folder / "history.csv").is_file():
            text = (folder / "history.csv").read_text(encoding="utf-8")
            rows = list(csv.reader(text.splitlines()))
            if not text.endswith("\n") or any(len(row) != len(rows[0]) for row in rows):
                found.append("history.csv: a row is not whole")
        if (folder / "result.h5").is_file():
            content = stored(folder / "result.h5")
            outputs = content["times"][1][0] if "times" in content else 0
            fields = {name.split("/")[1] for name in content if name.startswith("particles/") and "@" not in name}
            if len(fields) != outputs:
                found.append(f"result.h5: {outputs} times, fields of {len(fields)}")
        for file in folder.glob("result.h5.fields/?????.h5"):
            if not any(name.startswith(f"particles/{file.stem}/") for name in stored(file)):
                found.append(f"{file.name}: no fields")
        if (folder / "summary.json").is_file():
            summary(folder / "summary.json")
    except (OSError, ValueError, KeyError, IndexError) as error:
        found.append(f"cannot be read: {error}")
    return found
