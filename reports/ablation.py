"""The part of the page of verification on what each ingredient of an experiment is worth: what ci/ablate kept, as a chart and tables."""

from collections.abc import Sequence
from pathlib import Path

from reports.charts.parts import draw_ablation
from reports.figures import Figure, Section, Table, words_of
from reports.shown import Shown
from reports.words import NONE, amount, base_words, experiment_name, listed, minus, number, plain, share, small_unit
from verification.ablation.table import CHANGES, NEEDED, NOTHING, REASONS, RECORDS, SPARED, WANTED, Reasons, Tried, read_all, reason_for, reasons
from verification.ablation.table import Table as Kept

_INTERFACES = {"interface_1": "an interface that acts", "interface_2": "a second one"}  # rows that scenes share, whatever the law


def section(runs: Path) -> Section | None:
    """The part of the page from the records beside the folder of runs; None where there are none."""
    root = runs.parent
    return section_of(read_all(root / RECORDS.relative_to(RECORDS.parents[2])), reasons(root / REASONS.relative_to(REASONS.parents[2])))


def section_of(kept: Sequence[Kept], why: Reasons) -> Section | None:
    """The part of the page from tables and reasons."""
    if not kept:
        return None
    data = ablation_figure(kept)
    return Section(title="What each experiment needs", intro=f"{data.title}. {words_of('ablation_method')}",
                   figures=[Figure("ablation", data, draw_ablation, "ablation")], tables=[table_of(one, why) for one in kept])


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
    columns = [f"{experiment_name(one.experiment).replace('Experiment', 'Exp.')}\n{plain(one.variant)}" for one in whole]
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


def table_of(one: Kept, why: Reasons) -> Table:
    """The table of a scene: what was left out, the effect on each number, the time, the verdict and why it is kept; what the scene needs below."""
    header = ["left out", "instead", *(f"{label} ({small_unit(unit)})" for _, label, unit in one.quantities), "largest", "time", "for 1 %"]
    own = [base_words(one.base.get(name), unit) for name, _, unit in one.quantities]
    rows = [["nothing", "", *own, "", f"{number(one.cpu_s, 3)}\u00a0s", ""]]
    for line in one.lines:
        if not line.applies:
            rows.append([line.label, line.reason, *(NONE for _ in own), "", "", ""])
            continue
        cells = [_effect(line, name, unit) for name, _, unit in one.quantities]
        rows.append([line.label, line.done, *cells, NONE if line.largest is None else share(line.largest),
                     f"×\u00a0{number(line.cpu_s / one.cpu_s, 2)}", verdict_words(line, one, why)])
    wanted, spared = ([line.label for line in lines] for lines in (one.needs(), one.spared(True)))
    told = [f"For {share(WANTED)} it needs {listed(wanted)}."] if wanted else []
    told += [f"It does not need {listed(spared)}."] if spared else []
    return Table(title=f"{experiment_name(one.experiment)}, {plain(one.variant)}", header=header, rows=rows,
                 note=" ".join([*told, f"Version {one.version}."]),
                 marked=[k for k, line in enumerate(one.lines, 1) if line.applies and line.verdict == NOTHING])


def verdict_words(line: Tried, one: Kept, why: Reasons) -> str:
    """A verdict, with why the scene keeps what it does not need."""
    if line.verdict == NOTHING:
        return f"{NOTHING}: {line.status} ({line.reason})"
    if line.verdict == SPARED and line in one.spared(False):
        return "not needed, but leaving it out saves no time"
    return f"not needed; {reason_for(line, one.experiment, why)}" if line.verdict == SPARED else line.verdict


def _effect(line: Tried, name: str, unit: str) -> str:
    """An effect with its share, or why there is none."""
    effect = line.effects.get(name)
    if effect is None or effect.value is None:
        return effect.note if effect is not None and effect.note else NONE
    return amount(effect.value, unit) + (minus(f" ({share(line.shares[name])})") if name in line.shares else "")
