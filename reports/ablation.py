"""What each ingredient of an experiment is worth: what ci/ablate kept, as a chart and what each scene needs in words."""

from collections.abc import Sequence
from pathlib import Path

from reports.charts.records import draw_ablation
from reports.figures import Figure, Table, Topic
from reports.words import NONE, Shown, experiment_name, listed, number, plain, share
from verification.ablation.table import CHANGES, NEEDED, SPARED, WANTED, Tried, read_all
from verification.ablation.table import Table as Kept

_INTERFACES = {"interface_1": "an interface that acts", "interface_2": "a second one"}  # rows that scenes share, whatever the law


def topic(folder: Path) -> Topic | None:
    """The section of the front page from the kept tables; None where there are none."""
    kept = read_all(folder)
    if not kept:
        return None
    data = ablation_figure(kept)
    rows = [[f"{experiment_name(one.experiment)}, {plain(one.variant)}",
             *(listed([line.label for line in lines]) or NONE for lines in (one.needs(), one.spared(True))), f"{number(one.cpu_s, 3)}\u00a0s"] for one in kept]
    return Topic("needs", "What a scene needs", [f"{data.title}."], "ci/ablate", listed(sorted({one.version for one in kept})),
                 Figure("ablation", data, draw_ablation, "ablation", "ci/ablate"),
                 [Table(f"What each scene needs for {share(WANTED)}", ["Scene", "needs", "does not need", "CPU time"], rows)])


def ablation_figure(kept: Sequence[Kept]) -> Shown:
    """What is drawn: the tables in which more than the interfaces was left out.

    Rows of ingredients, columns of scenes. A cell, None where the scene does not have the ingredient: share (None where that cannot be said), whether
    something else happens, time over the scene's own.
    """
    whole = [one for one in kept if one.extent != "interfaces"] or list(kept)
    labels: dict[str, str] = {}
    for one in sorted(whole, key=lambda one: -sum(line.id in _INTERFACES for line in one.lines)):  # rows of all interfaces one below the other
        for line in one.lines:
            labels.setdefault(line.id, _INTERFACES.get(line.id, line.label))
    rows = [(label, [next((Shown(share=line.largest, changes=line.verdict == CHANGES, time=line.cpu_s / one.cpu_s) for line in one.lines
                           if line.id == name and line.applies), None) for one in whole]) for name, label in labels.items()]
    columns = [f"{experiment_name(one.experiment).replace('Experiment', 'Exp.')} {plain(one.variant)}" for one in whole]
    return Shown(title=finding(whole), columns=columns, rows=[row for row in rows if any(row[1])])


def finding(kept: Sequence[Kept]) -> str:
    """What all scenes need for 1 %, and what none does."""
    lines: dict[str, list[Tried]] = {}
    for line in (line for one in kept for line in one.lines if line.applies and not line.id.startswith("interface")):
        lines.setdefault(line.id, []).append(line)
    always, never = ([found[0].label for found in lines.values() if all(line.verdict in verdicts for line in found)]
                     for verdicts in ((NEEDED, CHANGES), (SPARED,)))
    told = [f"every scene that has them needs {listed(always)}"] if always else []
    told += [f"none needs {listed(never)}"] if never else []
    return f"For {share(WANTED)}: " + ("; ".join(told) if told else "what a scene needs differs from one to the next")
