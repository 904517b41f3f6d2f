"""The scale for graphs that read large files: what the view shows of them, within the budget of memory."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING

from halation.nodes import Size
from msgspec import Struct

from ...errors import HalationError
from ...graph import Graph
from ...inputs.provider import MediaProvider
from ...resources.picture import LARGE_PICTURE
from ...watch.sequence_files import representative_file
from ...watch.watching import find_pictures

if TYPE_CHECKING:
    from ...inputs.provider import Binding

PIXEL_BYTES = 8
"""Of four half floats, as most large files have."""

COARSEST = 0.125
"""The coarsest scale: that of the coarsest proxy of the viewer."""


class LargeFiles(Struct):
    """The size of the largest picture file that a graph reads, looked up again when the graph has changed."""

    size: Size = (0, 0)
    """Of files that are too small to matter, it is 0, 0."""
    _graph: Graph | None = None
    _bindings: Mapping[str, Binding] | None = None

    def follow(self, graph: Graph, bindings: Mapping[str, Binding], provider: MediaProvider) -> None:
        """Look at the headers of the files, if these may be other ones."""
        if graph is self._graph and bindings == self._bindings:
            return
        self._graph, self._bindings, sizes = graph, dict(bindings), list[Size]()
        for path in find_pictures(graph, bindings):
            with suppress(HalationError):  # whoever shows the picture reports it
                sizes.append(provider.find_info(str(representative_file(path, sandbox=provider.sandbox))).size)
        largest = max(sizes, key=_count_pixels, default=(0, 0))
        self.size = largest if _count_pixels(largest) >= LARGE_PICTURE else (0, 0)

    def choose_scale(self, zoom: float, budget: int) -> float:
        """The coarsest scale that shows all of a view with `zoom` pixels of the window for one of the picture.

        It is coarser than that where the file would take more than the `budget` in bytes.
        """
        nbytes, scale = PIXEL_BYTES * _count_pixels(self.size), 1.0
        while nbytes and scale > COARSEST and (zoom <= scale / 2 or nbytes * scale**2 > budget):
            scale /= 2
        return scale


def _count_pixels(size: Size) -> int:
    return size[0] * size[1]
