"""Settings of these tests."""

from __future__ import annotations

from reports.charts import style

style.PNG_DPI = 40  # that a picture is written is tested, not how sharp it is
