"""Settings of these tests."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import verification.harness.hermetic  # noqa: E402, F401  (before anything that reads the environment)
from reports.charts import style  # noqa: E402

style.PNG_DPI = 40  # that a picture is written is tested, not how sharp it is
