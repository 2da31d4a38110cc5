"""Settings of these tests."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import verification.harness.hermetic  # noqa: E402, F401  (before anything that reads the environment)
