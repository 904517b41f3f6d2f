"""The undo history: a list of steps, each with the document before and after."""

from __future__ import annotations

from collections.abc import Callable

from msgspec import Struct, field
from msgspec.structs import replace

from ...graph import Graph
from ..edits.element_id import NO_ELEMENT, ElementId

MOST = 1000
"""Steps that are kept at most; older ones are dropped. Graphs share their unchanged parts, so a step is small."""


class Snapshot(Struct, frozen=True):
    """The state that a step restores: the document, the groups entered, and the selection."""

    root: Graph
    place: tuple[str, ...] = ()
    selection: frozenset[ElementId] = frozenset()
    active: ElementId = NO_ELEMENT


class HistoryStep(Struct, frozen=True):
    """One undo step. Further changes with the same `merge` become part of it."""

    label: str
    before: Snapshot
    after: Snapshot
    merge: str = ""


class History(Struct):
    """Steps, oldest first; the first `position` of them are done, the others undone."""

    _steps: list[HistoryStep] = field(default_factory=list[HistoryStep])
    position: int = 0

    @property
    def steps(self) -> tuple[str, ...]:
        """The labels of all steps, oldest first."""
        return tuple(step.label for step in self._steps)

    @property
    def can_undo(self) -> bool:
        """True if there is a step to undo."""
        return self.position > 0

    @property
    def can_redo(self) -> bool:
        """True if there is a step to redo."""
        return self.position < len(self._steps)

    def add(self, step: HistoryStep) -> None:
        """Add a step; undone steps are dropped. It joins the last step if both have the same `merge`."""
        last = self._steps[self.position - 1] if self.can_undo and not self.can_redo else None
        del self._steps[self.position :]
        if last and step.merge and last.merge == step.merge:
            self._steps[-1] = replace(last, after=step.after)
        else:
            self._steps = [*self._steps, step][-MOST:]
        self.position = len(self._steps)

    def snapshot_before(self, merge: str) -> Snapshot | None:
        """The state before the last step, if that step has this `merge` and is unfinished."""
        if not merge or not self.can_undo or self.can_redo or self._steps[-1].merge != merge:
            return None
        return self._steps[-1].before

    def abandon(self, merge: str) -> Snapshot | None:
        """Drop the last step if it has this `merge` and is unfinished; returns the state before it."""
        before = self.snapshot_before(merge)
        if before is not None:
            self.position -= 1
            self._steps.pop()
        return before

    def seal(self) -> None:
        """End merging; a step that changed nothing in the end is dropped."""
        if not self.can_undo or self.can_redo or not self._steps[-1].merge:
            return
        last = self._steps.pop()
        if last.before.root != last.after.root:
            self._steps.append(replace(last, merge=""))
        self.position = len(self._steps)

    def go_to(self, position: int) -> Snapshot | None:
        """Undo or redo until that many steps are done; returns the state then, None if nothing changes."""
        target = min(max(position, 0), len(self._steps))
        if target == self.position:
            return None
        back = target < self.position
        self.position = target
        return self._steps[target].before if back else self._steps[target - 1].after

    def map_documents(self, edit: Callable[[Graph], Graph]) -> None:
        """Apply a change that is no step, such as another folder, to the documents of all steps."""
        self._steps = [
            replace(
                step,
                before=replace(step.before, root=edit(step.before.root)),
                after=replace(step.after, root=edit(step.after.root)),
            )
            for step in self._steps
        ]
