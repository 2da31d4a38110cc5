"""Makes the wheel of verification/strata that `pip install .` asks for (PEP 517), of the version in CMakeLists.txt.

A backend of our own, since that of setuptools would have to be downloaded first, and would leave its files in build/ and in the checkout.
"""

import re
import zipfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent


def build_wheel(wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None) -> str:
    """Write the wheel and return its name; raises RuntimeError where CMakeLists.txt has no version."""
    found = re.search(r"project\(strata VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
    if found is None:
        raise RuntimeError(f"{ROOT / 'CMakeLists.txt'}: no version of strata")
    version = found[1]
    about = f"strata-{version}.dist-info"
    content = {path.relative_to(ROOT / "verification").as_posix(): path.read_text(encoding="utf-8") for path in sorted((ROOT / "verification/strata").glob("*.py"))}
    content[f"{about}/METADATA"] = "\n".join((
        "Metadata-Version: 2.1", "Name: strata", f"Version: {version}", "Summary: Reads the runs of strata", "License: GPL-3.0-or-later",
        "Requires-Python: >=3.11", "Requires-Dist: numpy", "Provides-Extra: h5py", 'Requires-Dist: h5py; extra == "h5py"', "",  # Debian's h5py is not known to pip
    ))  # fmt: skip
    content[f"{about}/WHEEL"] = "Wheel-Version: 1.0\nGenerator: strata\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    content[f"{about}/RECORD"] = "".join(f"{name},,\n" for name in [*content, f"{about}/RECORD"])
    name = f"strata-{version}-py3-none-any.whl"
    with zipfile.ZipFile(Path(wheel_directory) / name, "w") as wheel:
        for path, text in content.items():
            wheel.writestr(path, text)
    return name
