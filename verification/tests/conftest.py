"""Puts the project's root on the path of the tests and keeps their runs together."""
from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
