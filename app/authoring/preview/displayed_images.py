"""The pictures that panels show: each stays until the next one is ready."""

from __future__ import annotations

from collections.abc import Container, Mapping
from contextlib import suppress

from halation.nodes import Kind, Size
from msgspec import Struct

from ...compiler import Plan, scale_size
from ...errors import InputError
from ...graph import Port
from ...inputs.default_view import PictureEncodings, choose_default_view
from ...renderer import DeviceTexture, Runner, TextureLease
from ...renderer.device import PixelRect
from .frame_cache import FrameImage
from .request import PreviewRequest, pixel_kind
from .visible_region import PictureRegion


class DisplayedImage(Struct, frozen=True):
    """A finished picture: it stays as it is until another takes its place.

    `texture` is scene-linear. It may be a part of the picture, from pixel `start` on, or go on beyond the frame on all
    sides: then it starts below 0.
    """

    port: Port
    texture: DeviceTexture
    size: Size
    """The size of the frame."""
    full_size: Size
    """The size of the whole picture at scale 1."""
    scale: float
    kind: Kind
    channels: int
    key: str
    revision: int
    """Greater for every new picture."""
    frame: int = 1
    start: tuple[int, int] = (0, 0)
    default_view: str = ""
    """The view that suits it where nobody names one, as `choose_default_view` says."""

    pixel_aspect: float = 1.0
    """The width of a pixel over its height."""

    @property
    def partial(self) -> bool:
        """True if the texture lacks some of the frame."""
        return self.part[2:] != self.size

    @property
    def reaches_beyond(self) -> bool:
        """True if there are pixels around the frame."""
        return self.part[2:] != self.texture.size

    @property
    def part(self) -> PixelRect:
        """The pixels of the texture that lie in the frame, as x, y, width, height."""
        (x, y), held = self.start, self.texture.size
        left, top = max(-x, 0), max(-y, 0)
        return left, top, min(held[0], self.size[0] - x) - left, min(held[1], self.size[1] - y) - top

    @property
    def share(self) -> float:
        """The area of the texture as a fraction of the frame."""
        width, height = self.texture.size
        return width * height / (self.size[0] * self.size[1])


class _LeasedImage(Struct, eq=False):
    """The picture of a panel, and the lease that keeps its texture on the device."""

    image: DisplayedImage
    lease: TextureLease


class DisplayedImages:
    """The picture of each panel, by the panel's name."""

    def __init__(self, runner: Runner, encodings: PictureEncodings) -> None:
        self._runner, self._encodings = runner, encodings
        self._pictures: dict[str, _LeasedImage] = {}
        self._parts: dict[str, _LeasedImage] = {}
        """Parts of newer pictures, by the panel's name."""
        self._full_sizes: dict[Port, Size] = {}
        self._revision = 0

    def find(self, name: str) -> DisplayedImage | None:
        """The picture of a panel; None if it has none."""
        picture = self._pictures.get(name)
        return picture and picture.image

    def find_part(self, name: str) -> DisplayedImage | None:
        """The part of a newer picture that is ready before the whole."""
        picture = self._parts.get(name)
        return picture and picture.image

    def show(self, name: str, port: Port, request: PreviewRequest, frame_image: FrameImage) -> None:
        """Set the picture of a panel."""
        surface, before = frame_image.surface, self._pictures.get(name)
        self._pictures[name] = self._lease_image(before, port, request, frame_image, surface.frame_size)
        _drop(before)
        _drop(self._parts.pop(name, None))

    def show_part(self, request: PreviewRequest, ports: Mapping[str, Port], plan: Plan, part: PictureRegion) -> None:
        """Show a part of new pictures until the whole is ready."""
        for name, port in ports.items():
            before = self._parts.get(name)
            frame_image = self.describe(name, port, request, plan, part.size)
            self._parts[name] = self._lease_image(before, port, request, frame_image, part.size)
            _drop(before)

    def _lease_image(
        self, before: _LeasedImage | None, port: Port, request: PreviewRequest, frame_image: FrameImage, size: Size
    ) -> _LeasedImage:
        """The picture of a panel, with a lease so that its texture is not used again.

        The revision grows only with other pixels: what is computed of a picture, such as a scope, stays valid when the
        same picture is shown again.
        """
        surface = frame_image.surface
        same = before is not None and before.image.key == surface.key
        lease = self._runner.create_lease()
        lease.add(surface.key)
        texture = self._runner.textures.find(surface.key)
        assert texture is not None
        self._revision += not same
        return _LeasedImage(
            DisplayedImage(
                port,
                texture.handle,
                size,
                frame_image.full_size,
                request.scale,
                pixel_kind(request.graph, port, surface.channels),
                surface.channels,
                surface.key,
                before.image.revision if before is not None and same else self._revision,
                request.frame,
                surface.window.start if surface.window else (0, 0),
                frame_image.default_view,
                surface.pixel_aspect,
            ),
            lease,
        )

    def describe(self, name: str, port: Port, request: PreviewRequest, plan: Plan, size: Size) -> FrameImage:
        """What a panel is to show of a plan; `size` is that of the whole picture."""
        number, view = plan.outputs[name], ""
        with suppress(InputError):  # a file that is gone by now: the next plan says so
            view = choose_default_view(plan, number, self._encodings)
        return FrameImage(plan.surfaces[number], self._find_full_size(port, request, plan, size), view)

    def _find_full_size(self, port: Port, request: PreviewRequest, plan: Plan, size: Size) -> Size:
        """The size at scale 1 of what was rounded at this one: as before, or that of a picture or the canvas."""
        candidates = [self._full_sizes.get(port), request.size, request.graph.settings.size]
        candidates += [plan.surfaces[upload.surface].frame_size for upload in plan.uploads]
        full_size = (round(size[0] / request.scale), round(size[1] / request.scale))
        for full in candidates:
            if full and scale_size(full, request.scale) == size:
                full_size = full
                break
        full_size = size if request.scale == 1.0 or size == (1, 1) else full_size
        self._full_sizes[port] = full_size
        return full_size

    def keep(self, names: Container[str]) -> None:
        """Release the pictures of all other panels."""
        for pictures in (self._pictures, self._parts):
            for name in [name for name in pictures if name not in names]:
                _drop(pictures.pop(name))


def _drop(picture: _LeasedImage | None) -> None:
    if picture is not None:
        picture.lease.close()
