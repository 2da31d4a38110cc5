"""Keeps tests to themselves: a clean environment, a folder of their own for runs, and none of what the checkout has in runs/ and reports/out.

Loaded by each conftest.py before anything of the project. $STRATA, $STRATA_REFERENCE and $STRATA_BENCH may name programs of another build.
"""

import atexit
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]

# What is there on the user's account and must not decide on a test.
FORBIDDEN = tuple(str(ROOT / name) for name in ("runs", "reports/out"))

# Variables that stay: where programs are, where there is room, and what pytest tells its own processes.
KEPT = ("PATH", "TMPDIR", "LD_LIBRARY_PATH", "STRATA", "STRATA_REFERENCE", "STRATA_BENCH")

# Ways to a file or folder, as Python's audit events name them.
EVENTS = ("open", "os.listdir", "os.scandir", "os.mkdir", "os.remove", "os.rename", "os.rmdir", "os.link", "os.symlink", "subprocess.Popen")


class NotHermetic(BaseException):
    """A test reaches for what is not its own; no `except Exception` hides it."""


def words_of(arguments: Any) -> list[str]:
    """All texts and paths among the arguments of an event."""
    if isinstance(arguments, (list, tuple)):
        return [word for argument in arguments for word in words_of(argument)]
    return [os.fsdecode(arguments)] if isinstance(arguments, (str, bytes, os.PathLike)) else []


def refuse(event: str, arguments: tuple[Any, ...]) -> None:
    """An audit hook that ends a test which touches what is forbidden, itself or by a process."""
    if event not in EVENTS:
        return
    for word in words_of(arguments):
        if os.sep not in word or len(word) > 4096:
            continue  # a name alone may be one below an open folder
        path = os.path.abspath(word)
        for place in FORBIDDEN:
            if path == place or path.startswith(place + os.sep):
                raise NotHermetic(f"{event} of {path}: tests keep to a folder of their own")


def seal() -> None:
    """Clean the environment, make the folder of runs (one for all processes of a session) and refuse the checkout's."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where a shell starts tests in the background
    worker = "PYTEST_XDIST_WORKER" in os.environ
    own = os.environ.get("STRATA_RUNS", "") if worker else tempfile.mkdtemp(prefix="strata-tests-")
    for name in [name for name in os.environ if name not in KEPT and not name.startswith(("PYTEST_", "PY_COLORS"))]:
        del os.environ[name]
    home = Path(own) / "home"
    home.mkdir(exist_ok=True)
    os.environ |= {
        "STRATA_RUNS": own, "HOME": str(home), "MPLCONFIGDIR": str(home), "MPLBACKEND": "Agg", "LC_ALL": "C.UTF-8", "COLUMNS": "200",
        "OMP_NUM_THREADS": "1",  # of runs that do not say how many: tests stand side by side
    }  # fmt: skip
    if not worker:
        atexit.register(shutil.rmtree, own, ignore_errors=True)
    sys.addaudithook(refuse)


seal()
