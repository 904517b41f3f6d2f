"""Finds errors in code that no picture needs: a driver sees only the shaders of what is rendered."""

from __future__ import annotations

from collections.abc import Iterator
from weakref import WeakKeyDictionary

import numpy as np
from halation.nodes import Size

from ...custom_nodes import CustomNode
from ...errors import HalationError, ShaderError
from ...graph import Graph, Group
from ...regression.node_promises import make_pictures, render_node
from ...renderer import Renderer
from .work import PreviewWork

_SIZE: Size = (4, 4)
"""Pixels of a trial: the least that has neighbors on all sides of a pixel."""


class CodeCheck:
    """Renders each node of code once, alone and tiny, and remembers what was wrong. Nodes of the same code share it."""

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._errors: WeakKeyDictionary[type[CustomNode], ShaderError | None] = WeakKeyDictionary()

    def is_behind(self, work: PreviewWork) -> bool:
        """True while there is code in the graph that was not tried yet, or whose errors were not added to the work."""
        return any(
            type(node) not in self._errors or (self._errors[type(node)] is not None and path not in work.faults)
            for path, node in _list_code_nodes(work.wish.graph, "")
        )

    def add_faults(self, work: PreviewWork) -> bool:
        """Add the errors that rendering did not find; True if there are new ones.

        One node at most is tried in a call, so that no frame of the window takes long.
        """
        faults, has_tried = dict[str, HalationError](), False
        for path, node in _list_code_nodes(work.wish.graph, ""):
            if type(node) not in self._errors:
                if has_tried:
                    break
                has_tried = True
                self._errors[type(node)] = self._try(node)
            error = self._errors[type(node)]
            if error is not None and path not in work.faults:
                faults[path] = ShaderError(path, error.file, error.line, error.fault)
        work.faults |= faults
        return bool(faults)

    def _try(self, node: CustomNode) -> ShaderError | None:
        try:
            render_node(self._renderer, node, make_pictures(type(node), _SIZE, np.random.default_rng(0)), _SIZE)
        except ShaderError as error:
            return error
        except HalationError:  # about what it lacks, which its own graph may have
            return None
        return None


def _list_code_nodes(graph: Graph, inside: str) -> Iterator[tuple[str, CustomNode]]:
    """Nodes of code with their paths, groups included."""
    for id, item in graph.nodes.items():
        if isinstance(item, CustomNode):
            yield f"{inside}{id}", item
        elif isinstance(item, Group):
            yield from _list_code_nodes(item.graph, f"{inside}{id}/")
