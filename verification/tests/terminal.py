"""A program on a terminal, and in a pipe."""

import os
import pty
import select
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path


def on_terminal(command: Sequence[str | Path], folder: Path, typed: Sequence[tuple[str, str]] = (), **environment: str) -> str:
    """What a program shows on a terminal of its own. typed: keys, and the text that has to be shown, after them, before what comes next is typed."""
    ours, theirs = pty.openpty()
    variables = {**os.environ, "TERM": "xterm", **environment}
    with subprocess.Popen(list(map(str, command)), cwd=folder, env=variables, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True) as program:
        os.close(theirs)
        shown, until, waiting = "", "", list(typed)
        seen, end = 0, time.monotonic() + 60  # of what was shown when the last keys were typed
        try:
            while time.monotonic() < end:
                if waiting and until in shown[seen:]:
                    keys, until = waiting.pop(0)
                    seen = len(shown)
                    os.write(ours, keys.encode())
                if select.select([ours], [], [], 0.1)[0]:
                    shown += os.read(ours, 4096).decode()
        except OSError:  # the program has ended
            pass
        finally:
            os.close(ours)
            program.kill()
        assert not waiting and until in shown[seen:], shown
    return shown
