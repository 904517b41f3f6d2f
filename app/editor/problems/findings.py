"""Everything that is wrong right now, as one list."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...authoring.log import Level

if TYPE_CHECKING:
    from ..window.editor import Editor


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong. `where` is the path of a node, such as `glow/blur` or `inputs.beauty`, or ""."""

    level: Level
    where: str
    sentence: str
    detail: str = ""


def findings(editor: Editor) -> tuple[Finding, ...]:
    """Problems of the graph, of its pictures, of the services and of panels; worst first, each once."""
    found = dict.fromkeys(_found(editor))
    return tuple(sorted(found, key=lambda finding: finding.level != "error"))


def _found(editor: Editor) -> Iterator[Finding]:
    """What the preview says about a node that the graph itself has a problem with is the same thing in other words."""
    inside = "/".join(editor.session.place)
    for node, problems in editor.session.problems.items():
        for problem in problems:
            yield Finding(problem.severity, "/".join(filter(None, (inside, node))), problem.sentence)
    known = {"/".join(filter(None, (inside, node))) for node in editor.session.problems}
    for where, sentence in editor.preview.faults.items():
        if where not in known:
            yield Finding("error", where, sentence)
    for sentence in _services(editor):
        yield Finding("warning", "", sentence)
    for name, detail in editor.faults.items():
        yield Finding("error", "", f"the panel {name} failed; the document is safe", detail)


def _services(editor: Editor) -> Iterable[str]:
    return filter(None, (editor.recovery.fault, editor.watcher.fault, *editor.store.faults))


def show(editor: Editor, where: str) -> None:
    """Go to a node by its path, select it and bring it into view."""
    *place, key = where.split("/")
    if tuple(place) != editor.session.place:
        editor.session.go(tuple(place))
    editor.session.select((key,))
    editor.canvas.fit((key,))
