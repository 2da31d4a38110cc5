"""The part of the page of verification on what each ingredient of an experiment is worth: what ci/ablate kept, as a chart and tables."""

from collections.abc import Sequence
from pathlib import Path

from reports.charts.parts import draw_ablation
from reports.figures import Figure, Section, Table, words_of
from reports.shown import Shown
from reports.words import NONE, amount, base_words, experiment_name, listed, number, plain, share, small_unit
from verification.ablation.effects import CHANGES, NEEDED, NOTHING, SPARED, WANTED, Tried, free, missing, needs, not_needed
from verification.ablation.ingredients import LEFT_OUT, MODELLED, RESOLVED
from verification.ablation.store import REASONS, Reasons, reason_for, reasons
from verification.ablation.store import RECORDS, Table as Kept, read_all

_GROUPS = {MODELLED: "modelled", RESOLVED: "resolved", LEFT_OUT: "gone without"}
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
                   figures=[Figure("ablation", data, draw_ablation, "ablation")],
                   tables=[table_of(one, why) for one in kept])


def ablation_figure(kept: Sequence[Kept]) -> Shown:
    """What is drawn: the tables in which more than the interfaces was left out.

    Rows of ingredients with their group, columns of scenes. A cell, None where the scene does not have the ingredient: share (None where that
    cannot be said), whether something else happens, time over the scene's own.
    """
    whole = [one for one in kept if one.extent != "interfaces"] or list(kept)
    labels: dict[str, tuple[str, str]] = {}
    for group in _GROUPS:
        # Those with the most interfaces first, so that the rows of these come one below the other.
        for one in sorted(whole, key=lambda one: -sum(line.id in _INTERFACES for line in one.lines)):
            for line in one.lines:
                if line.group == group:
                    labels.setdefault(line.id, (_INTERFACES.get(line.id, line.label), _GROUPS[group]))
    tried = [{line.id: line for line in reversed(one.lines) if line.applies} for one in whole]
    rows = []
    for name, (label, group) in labels.items():
        cells = [Shown(share=own[name].largest, changes=own[name].verdict == CHANGES, time=own[name].cpu_s / one.cpu_s) if name in own else None
                 for one, own in zip(whole, tried)]
        if any(cells):
            rows.append((label, group, cells))
    columns = [f"{experiment_name(one.experiment).replace('Experiment', 'Exp.')}\n{plain(one.variant)}" for one in whole]
    return Shown(title=finding(whole), columns=columns, rows=rows)


def finding(kept: Sequence[Kept]) -> str:
    """What all scenes need for 1 %, and what none does."""
    lines: dict[str, list[Tried]] = {}
    for one in kept:
        for line in one.lines:
            if line.applies and line.group != LEFT_OUT and not line.id.startswith("interface"):
                lines.setdefault(line.id, []).append(line)
    always = [found[0].label for found in lines.values() if all(line.verdict in (NEEDED, CHANGES) for line in found)]
    never = [found[0].label for found in lines.values() if all(line.verdict == SPARED for line in found)]
    told = [f"every scene that has them needs {listed(always)}"] if always else []
    told += [f"none needs {listed(never)}"] if never else []
    return f"For {share(WANTED)}: " + ("; ".join(told) if told else "what a scene needs differs from one to the next")


def table_of(one: Kept, why: Reasons) -> Table:
    """The table of a scene: what was left out, the effect on each number, the time, the verdict and why it is kept."""
    header = ["left out", "instead", *(f"{label} ({small_unit(unit)})" for _, label, unit in one.quantities), "largest", "time", "for 1 %"]
    own = [base_words(one.base.get(name), unit) for name, _, unit in one.quantities]
    rows, marked = [["nothing", "", *own, "", f"{number(one.cpu_s, 3)}\u00a0s", ""]], []
    for line in one.lines:
        if not line.applies:
            rows.append([line.label, line.reason, *(NONE for _ in one.quantities), "", "", ""])
            continue
        added = line.group == LEFT_OUT
        cells = [_effect(line, name, unit) for name, _, unit in one.quantities]
        if line.verdict == NOTHING or (added and line.verdict in (NEEDED, CHANGES)):
            marked.append(len(rows))
        largest = NONE if line.largest is None else share(line.largest)
        rows.append([f"(added) {line.label}" if added else line.label, "modelled" if added else line.done, *cells, largest,
                     f"×\u00a0{number(line.cpu_s / one.cpu_s, 2)}", verdict_words(line, one, why)])
    title = f"{experiment_name(one.experiment)}, {plain(one.variant)}"
    return Table(title=title, header=header, rows=rows, marked=marked, note=note_of(one))


def verdict_words(line: Tried, one: Kept, why: Reasons) -> str:
    """A verdict, with why the scene keeps what it does not need or goes without what it would."""
    reason = reason_for(line, one.experiment, why)
    if line.group == LEFT_OUT:
        would = "moves it" if line.verdict in (NEEDED, CHANGES) else "not needed" if line.verdict == SPARED else NOTHING
        return f"{would}; {reason}" if would == "moves it" and reason else would
    if line.verdict == NOTHING:
        return f"{NOTHING}: {line.status} ({line.reason})"
    if line.verdict == SPARED and line in free(one.lines, one.cpu_s):
        return "not needed, but leaving it out saves no time"
    return f"not needed; {reason}" if line.verdict == SPARED else line.verdict


def note_of(one: Kept) -> str:
    """What the table says the scene needs."""
    wanted = [line.label for line in needs(one.lines)]
    spared = [line.label for line in not_needed(one.lines, one.cpu_s)]
    lacks = [line.label for line in missing(one.lines)]
    told = [f"For {share(WANTED)} it needs {listed(wanted)}."] if wanted else []
    told += [f"It does not need {listed(spared)}."] if spared else []
    told += [f"It would need {listed(lacks)}."] if lacks else []
    return " ".join([*told, f"Version {one.version}."])


def _effect(line: Tried, name: str, unit: str) -> str:
    """An effect with its share, or why there is none."""
    effect = line.effects.get(name)
    if effect is None or effect.value is None:
        return effect.note if effect is not None and effect.note else NONE
    return amount(effect.value, unit) + (f" ({share(line.shares[name])})".replace("-", "−") if name in line.shares else "")
