"""The page of verification: the accuracy ladder, then the parts that other modules fill.

A module that fills a part has `section(runs: Path, out: Path) -> Section | None`, where Section is

    {"title": str, "intro": str,
     "figures": [{"name": str, "title": str, "caption": str}, ...],      # as reports.sections.put_figure returns them
     "tables": [{"title": str, "header": [str, ...], "rows": [[str, ...], ...], "marked": [int, ...], "note": str}, ...]}

(`marked`, the rows that fall short, and `note` may be left out); see `reports/sections.py`. None: nothing was run.
"""

from __future__ import annotations

# Modules of reports/ that fill parts of the page, in its order; one that is not there is left out.
PARTS: tuple[str, ...] = ("path_check", "refinement", "budget")
