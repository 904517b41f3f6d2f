"""Collects all current problems in one list."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from msgspec import Struct

from ...authoring.edits.element_id import ElementId
from ...authoring.log import Level
from ...errors import ShaderError
from ...language.translation import translate

if TYPE_CHECKING:
    from .context import ProblemsContext


class ListedProblem(Struct, frozen=True):
    """One problem. `where` is the path of a node, such as `glow/blur` or `inputs.beauty`, or ""."""

    level: Level
    where: str
    sentence: str
    detail: str = ""


def list_problems(context: ProblemsContext) -> tuple[ListedProblem, ...]:
    """Problems of the graph, of its pictures, of the services and of panels; worst first, each once."""
    problems = dict.fromkeys(_collect(context))
    return tuple(sorted(problems, key=lambda finding: finding.level != "error"))


def _collect(context: ProblemsContext) -> Iterator[ListedProblem]:
    """Collect the problems. Errors of the preview only repeat those of the graph, unless they are in code."""
    inside = "/".join(context.session.place)
    for node, problems in context.session.problems.items():
        for problem in problems:
            yield ListedProblem(problem.severity, "/".join(filter(None, (inside, node))), problem.sentence)
    faulty_nodes = {"/".join(filter(None, (inside, node))) for node in context.session.problems}
    for where, sentence in context.preview.faults.items():
        if where not in faulty_nodes or isinstance(context.preview.errors.get(where), ShaderError):
            yield ListedProblem("error", where, sentence)
    for sentence in service_faults(context):
        yield ListedProblem("warning", "", sentence)
    for name, detail in context.faults.items():
        yield ListedProblem("error", "", translate("the panel {name} failed; the document is safe", name=name), detail)


def service_faults(context: ProblemsContext) -> Iterable[str]:
    """The current problems of recovery, file watching and preferences, and other editors of the same document."""
    recovery = context.recovery
    return filter(None, (recovery.fault, recovery.find_rivals(), context.watcher.fault, *context.store.faults))


def show_element(context: ProblemsContext, where: str) -> None:
    """Go to a node by its path, select it and bring it into view."""
    *place, name = where.split("/")
    element = ElementId(name)
    if tuple(place) != context.session.place:
        context.session.go(tuple(place))
    context.session.select(element)
    context.canvas.fit((element,))
