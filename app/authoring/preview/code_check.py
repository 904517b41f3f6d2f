"""Finds errors in code that no picture needs: a driver sees only the shaders of what is rendered."""

from __future__ import annotations

from collections.abc import Iterator
from weakref import WeakKeyDictionary

import numpy as np
from halation.nodes import Size

from ...custom_nodes import CustomNode
from ...errors import HalationError, ShaderError
from ...graph import Graph, Group
from ...regression.node_promises import make_node_request, make_pictures
from ...renderer import Renderer, Run
from .work import PreviewWork

_SIZE: Size = (4, 4)
"""Pixels of a trial: the least that has neighbors on all sides of a pixel."""


class CodeCheck:
    """Renders each node of code once, alone and tiny, and remembers what was wrong. Nodes of the same code share it.

    It works in small steps and never waits: a compiler may take a minute over a few lines.
    """

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._errors: WeakKeyDictionary[type[CustomNode], ShaderError | None] = WeakKeyDictionary()
        self._checked: type[CustomNode] | None = None
        """The code that `_run` renders."""
        self._run: Run | None = None
        self._lease = renderer.runner.create_lease()
        self._listed: tuple[Graph | None, tuple[tuple[str, CustomNode], ...]] = (None, ())

    def is_behind(self, work: PreviewWork) -> bool:
        """True while there is code in the graph that was not tried yet, or whose errors were not added to the work.

        Code that a picture has found at fault is not tried again.
        """
        return any(
            path not in work.faults and self._errors.get(type(node), node) is not None
            for path, node in self._list_nodes(work.request.graph)
        )

    def add_faults(self, work: PreviewWork) -> bool:
        """Do a step, and add the errors that rendering did not find; True if there are new ones."""
        faults = dict[str, HalationError]()
        nodes = {path: node for path, node in self._list_nodes(work.request.graph) if path not in work.faults}
        untried = {type(node): node for node in nodes.values() if type(node) not in self._errors}
        if self._checked not in untried:
            self.clear()
        if untried:
            self._step(untried[self._checked] if self._checked else next(iter(untried.values())))
        for path, node in nodes.items():
            if error := self._errors.get(type(node)):
                faults[path] = ShaderError(path, error.file, error.line, error.fault)
        work.faults |= faults
        return bool(faults)

    def clear(self) -> None:
        """Give up what has begun. What was found stays known."""
        if self._run is not None:
            self._run.close()
        self._lease.close()
        self._checked = self._run = None

    def _list_nodes(self, graph: Graph) -> tuple[tuple[str, CustomNode], ...]:
        """The nodes of code of a graph; asked in each frame, so they are found once."""
        if self._listed[0] is not graph:
            self._listed = graph, tuple(_list_code_nodes(graph, ""))
        return self._listed[1]

    def _step(self, node: CustomNode) -> None:
        """Compile the code, or run one more of its passes unless that would wait."""
        error = None
        try:
            if self._run is None:
                pictures = make_pictures(type(node), _SIZE, np.random.default_rng(0))
                plan = self._renderer.compile(*make_node_request(node, pictures, _SIZE))
                self._run, self._checked = self._renderer.runner.start_run(plan, self._lease), type(node)
                return
            if not self._run.is_ready or next(self._run, None) is not None:
                return
        except ShaderError as fault:
            error = fault
        except HalationError:  # about what it lacks, which its own graph may have
            pass
        self._errors[type(node)] = error
        self.clear()


def _list_code_nodes(graph: Graph, inside: str) -> Iterator[tuple[str, CustomNode]]:
    """Nodes of code with their paths, groups included."""
    for id, item in graph.nodes.items():
        if isinstance(item, CustomNode):
            yield f"{inside}{id}", item
        elif isinstance(item, Group):
            yield from _list_code_nodes(item.graph, f"{inside}{id}/")
