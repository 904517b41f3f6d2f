"""Renders graphs to arrays: what the command line, the editor and Python call."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from halation.nodes import Size
from msgspec import Struct, field

from ..compiler import Library, Memory, Plan, Planner, Precision, Region, Request
from ..graph import Graph, Port
from ..inputs.provider import MediaProvider
from ..resources.sandbox import Sandbox
from .device import Device
from .execution.decoding import Array
from .execution.runner import Runner
from .execution.trials import TrialProcess, Trials
from .opening import open_device

if TYPE_CHECKING:
    from ..inputs.prefetch import Prefetcher
    from ..inputs.provider import Binding

DEFAULT_BUDGET = 512 * 2**20
"""Bytes of results that stay on the device: 16 pictures of 1920x1080 in RGBA floats. Chosen by judgement: enough that
undo and sliders find earlier results, and a small part of what GPUs have today. More keeps more results."""


class RenderRequest(Struct, frozen=True):
    """What to render of a graph.

    `inputs` are files, arrays or numbers by the name of a graph input, or functions from the frame to one of these;
    `targets` are node or graph outputs by the name of their results (default: every graph output). `size` replaces the
    size of canvas and pictures; `scale` renders a proxy.
    """

    inputs: Mapping[str, Binding | Callable[[int], Binding]] = field(default_factory=lambda: MappingProxyType({}))
    targets: Mapping[str, Port] = field(default_factory=lambda: MappingProxyType({}))
    size: Size | None = None
    scale: float = 1.0
    frame: int = 1
    precision: Precision | None = None
    memories: Mapping[Port, Memory] = field(default_factory=lambda: MappingProxyType({}))
    """What temporal nodes stored in the frame before: see `FrameRenderer`."""
    halves: frozenset[str] = frozenset()
    """Outputs that the caller will round to half floats: they may come back rounded."""

    region: Region | None = None
    """The part of every output to compute, in its pixels. The `window` of a surface says which part was computed."""
    by_rows: frozenset[str] = frozenset()
    """Outputs that are handed over by rows, from the top down, if they are made in tiles: see `Run.receive_rows`."""
    whole: frozenset[str] = frozenset()
    """Outputs of which pixels beyond the frame are made as well. The `window` of a surface says which there are."""

    @property
    def bound_inputs(self) -> dict[str, Binding]:
        """The inputs at this frame."""
        return {name: item(self.frame) if callable(item) else item for name, item in self.inputs.items()}


_ALL = RenderRequest()


class Renderer:
    """Renders graphs on one device and one thread, keeping programs, textures and results for the next time.

    `budget` is how many bytes of results may stay on the device. Without a `device` it opens one, and closes it too.
    `ahead` reads pictures already; `trial_process` has started already, to try programs with code of users.
    """

    def __init__(
        self,
        device: Device | None = None,
        *,
        budget: int = DEFAULT_BUDGET,
        library: Library | None = None,
        fusion: bool = True,
        prefetcher: Prefetcher | None = None,
        trial_process: TrialProcess | None = None,
        sandbox: Sandbox,
    ) -> None:
        self.sandbox = sandbox
        self._owns_device = device is None
        self.device = device or open_device(sandbox=sandbox)
        self.pictures = MediaProvider(prefetcher=prefetcher, sandbox=sandbox)
        self._trial_process = trial_process or TrialProcess()
        if trial_process is None:  # its thread keeps it alive, also where nobody closes this renderer
            weakref.finalize(self, self._trial_process.abandon)
        self.runner = Runner(self.device, self.pictures.load_pixels, budget, Trials(self._trial_process))
        self.library = library
        """The shaders of nodes; None for those that ship with Halation."""
        self._fusion = fusion
        self._planner = Planner()

    def compile(self, graph: Graph, request: RenderRequest = _ALL, *, fusion: bool = True) -> Plan:
        """Plan the rendering of what is wanted of `graph`. Raises the errors of `app.errors`."""
        bindings = self.pictures.bind(graph, request.bound_inputs)
        plan_request = Request(
            request.targets,
            bindings,
            request.size,
            request.scale,
            request.frame,
            request.memories,
            request.halves,
            request.region,
            request.by_rows,
            request.whole,
        )
        return self._planner.plan(
            graph,
            plan_request,
            self.pictures,
            target=self.device.target,
            precision=request.precision,
            library=self.library,
            fusion=fusion and self._fusion,
            cached_keys=self.runner.textures,
        )

    def find_frames(self, graph: Graph, request: RenderRequest = _ALL) -> tuple[int, int]:
        """The first and last frame of a graph: as it says, else those of the first sequence it reads, else of keys."""
        fixed_inputs = {name: item for name, item in request.inputs.items() if not callable(item)}
        return self.pictures.find_frames(graph, self.pictures.bind(graph, fixed_inputs))

    def render(self, graph: Graph, request: RenderRequest = _ALL) -> dict[str, Array]:
        """Every wanted output by name as [height, width, channels], scene-linear. Raises the errors of `app.errors`.

        One frame alone: nodes with a memory have none. See `FrameRenderer`.
        """
        return self.runner.run(self.compile(graph, request))

    def close(self) -> None:
        """Give back textures, programs and threads, and the device if it was not handed in."""
        self.runner.close()
        self._trial_process.close()
        if self._owns_device:
            self._owns_device = False
            self.device.close()
