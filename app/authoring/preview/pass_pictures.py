"""The passes of what the viewer shows, one by one: what each reads, what it makes as a picture, and its time."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

from msgspec import Struct

from ...color.transforms import Array
from ...compiler import Pass, Plan
from ...errors import DeviceError, HalationError
from ...export.surface_picture import SurfacePicture, picture_surface
from ...graph import INPUTS, OUTPUTS
from ...inputs.default_view import choose_default_view
from ...language.translation import translate
from ...renderer import Renderer
from .request import PreviewRequest
from .stepwise import StepwiseWork

WIDTH = 320
"""Pixels across of a picture: as on the page of `halation explain --html`."""


class PassPicture(Struct, frozen=True, eq=False):
    """A file that was read, or a pass that has run."""

    number: int
    """The number of the pass, from 1 on; 0 for a file."""
    nodes: tuple[str, ...]
    functions: tuple[str, ...]
    reads: tuple[str, ...]
    """The numbers of the passes, and the layers of files, that it reads."""
    makes: str
    """The size and the format of what it makes."""
    picture: SurfacePicture


class PassPictures(StepwiseWork):
    """Runs the passes of a request while somebody looks at them, one pass per `work`.

    They run on a renderer of their own, which keeps no results: the one of the preview would leave out passes whose
    results are there already. Passes run once for the pictures, and a second time, when drivers have compiled them, for
    the times.
    """

    def __init__(self, renderer: Renderer) -> None:
        super().__init__()
        self._main = renderer
        self._renderer: Renderer | None = None
        self._request: PreviewRequest | None = None
        self.passes: list[PassPicture] = []
        self.seconds: list[float] = []
        """The times of the passes that were measured, in their order."""
        self.revision = 0
        """Grows with every change of the pictures."""
        self.fault = ""
        self.marked = ""
        """The shader function whose passes the panel marks; "" for none."""

    def want(self, request: PreviewRequest) -> None:
        """Say whose passes are shown. Costs nothing if the pixels are the same as before."""
        if self._request is not None and self._request.wants_same_pixels(request):
            return
        self.stop()
        self._request, self.fault = request, ""
        self._steps = self._run(request)

    def clear(self) -> None:
        """Show no passes: there is nothing to look at."""
        if self._request is not None:
            self.stop()
            self._request, self.fault, self.passes, self.seconds = None, "", [], []
            self.revision += 1

    def close(self) -> None:
        """Give back what the device holds."""
        self.stop()
        self._request = None
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None

    def _note_failure(self, error: HalationError) -> None:
        self.fault = str(error)
        self.passes, self.seconds = [], []

    def _run(self, request: PreviewRequest) -> Generator[None]:
        if self._renderer is None:
            self._renderer = Renderer(self._main.device, budget=0, sandbox=self._main.sandbox)
        renderer, (name, port) = self._renderer, next(iter(request.ports.items()))
        renderer.library = self._main.library
        plan = renderer.compile(request.graph, request.render_request({name: port}, request.frame))
        if plan.tiling is not None:
            raise DeviceError(translate("{why}: look at a smaller proxy", why=plan.tiling.why))
        output = request.graph.outputs.get(port.socket) if port.node == OUTPUTS else None
        view = (output.view if output else "") or choose_default_view(plan, plan.outputs[name], renderer.pictures)
        passes = [
            _describe_file(plan, index, renderer.pictures.load_pixels(upload.picture), view)
            for index, upload in enumerate(plan.uploads)
        ]
        yield
        for index, trace in enumerate(renderer.runner.trace(plan)):
            passes.append(_describe_pass(plan, index, trace.pixels[trace.render_pass.targets[0]], view))
            yield
        self.passes, self.seconds = passes, []
        self.revision += 1
        yield from self._measure(renderer, plan)

    def _measure(self, renderer: Renderer, plan: Plan) -> Generator[None]:
        lease, timings = renderer.runner.create_lease(), list[tuple[Pass, float]]()
        try:
            with renderer.runner.start_run(plan, lease, timings=timings) as run:
                for _ in run:
                    self.seconds = [seconds for _, seconds in timings]
                    yield
        finally:
            lease.close()
            renderer.runner.release_idle()


def _describe_file(plan: Plan, index: int, pixels: Array, view: str) -> PassPicture:
    upload = plan.uploads[index]
    surface = plan.surfaces[upload.surface]
    picture = picture_surface(pixels, surface, view, WIDTH)
    reads = " ".join(filter(None, (Path(upload.picture.path).name, upload.picture.layer)))
    return PassPicture(
        0, (upload.node.removeprefix(f"{INPUTS}."),), (), (reads,), _describe_surface(plan, upload.surface), picture
    )


def _describe_pass(plan: Plan, index: int, pixels: Array, view: str) -> PassPicture:
    """A pass by its first target."""
    render_pass = plan.passes[index]
    target = render_pass.targets[0]
    makers = {number: str(at) for at, before in enumerate(plan.passes[:index], 1) for number in before.targets}
    makers |= {
        upload.surface: upload.picture.layer or upload.node.removeprefix(f"{INPUTS}.") for upload in plan.uploads
    }
    return PassPicture(
        index + 1,
        render_pass.nodes,
        tuple(dict.fromkeys(render_pass.functions)),
        tuple(makers.get(number, plan.surfaces[number].label) for number in render_pass.textures),
        _describe_surface(plan, target),
        picture_surface(pixels, plan.surfaces[target], view, WIDTH),
    )


def _describe_surface(plan: Plan, number: int) -> str:
    width, height = plan.surfaces[number].size
    return f"{width}x{height} {plan.surfaces[number].texel}"
