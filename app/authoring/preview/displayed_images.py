"""The pictures that panels show: each stays until another takes its place."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass

from halation.nodes import Kind, Size

from ...compiler import Plan, scale_size
from ...graph import Port
from ...renderer import DeviceTexture, Runner, TextureLease
from .frame_cache import FrameImage
from .request import PreviewRequest, pixel_kind
from .visible_region import PictureRegion


@dataclass(frozen=True)
class DisplayedImage:
    """A finished picture: it stays as it is until another takes its place.

    `texture` is scene-linear. It may be a part of the picture: from pixel `start` on.
    """

    port: Port
    texture: DeviceTexture
    size: Size
    full_size: Size
    """Its size at scale 1."""
    scale: float
    kind: Kind
    channels: int
    key: str
    revision: int
    """Greater for every picture that is not the one before."""
    frame: int = 1
    start: tuple[int, int] = (0, 0)

    @property
    def partial(self) -> bool:
        """True if the texture is not all of the picture."""
        return self.texture.size != self.size

    @property
    def share(self) -> float:
        """The part of the picture that the texture is, of its area."""
        width, height = self.texture.size
        return width * height / (self.size[0] * self.size[1])


@dataclass(eq=False)
class _LeasedImage:
    """What a panel shows, and the lease that keeps it."""

    image: DisplayedImage
    lease: TextureLease


class DisplayedImages:
    """What each panel shows, by its name."""

    def __init__(self, runner: Runner) -> None:
        self._runner = runner
        self._pictures: dict[str, _LeasedImage] = {}
        self._parts: dict[str, _LeasedImage] = {}
        """Of pictures that are newer than those."""
        self._full_sizes: dict[Port, Size] = {}
        self._revision = 0

    def find(self, name: str) -> DisplayedImage | None:
        """What a panel shows."""
        picture = self._pictures.get(name)
        return picture and picture.image

    def find_part(self, name: str) -> DisplayedImage | None:
        """The part of a newer picture, where no more is there of it."""
        picture = self._parts.get(name)
        return picture and picture.image

    def show(self, name: str, port: Port, wish: PreviewRequest, face: FrameImage) -> None:
        """Let a panel show something else."""
        surface, before = face.surface, self._pictures.get(name)
        self._pictures[name] = self._lease_image(before, port, wish, face, surface.size)
        _drop(before)
        _drop(self._parts.pop(name, None))

    def show_part(self, wish: PreviewRequest, ports: Mapping[str, Port], plan: Plan, part: PictureRegion) -> None:
        """Let panels show a part of something else, until all of it is there."""
        for name, port in ports.items():
            surface, before = plan.surfaces[plan.outputs[name]], self._parts.get(name)
            face = FrameImage(surface, self.full_size(port, wish, plan, part.size))
            self._parts[name] = self._lease_image(before, port, wish, face, part.size)
            _drop(before)

    def _lease_image(
        self, before: _LeasedImage | None, port: Port, wish: PreviewRequest, face: FrameImage, size: Size
    ) -> _LeasedImage:
        surface = face.surface
        same = before is not None and before.image.key == surface.key
        lease = self._runner.create_lease()
        lease.add(surface.key)
        texture = self._runner.find_texture(surface.key)
        assert texture is not None
        self._revision += not same
        return _LeasedImage(
            DisplayedImage(
                port,
                texture.handle,
                size,
                face.full_size,
                wish.scale,
                pixel_kind(wish.graph, port, surface.channels),
                surface.channels,
                surface.key,
                before.image.revision if before is not None and same else self._revision,
                wish.frame,
                surface.window.start if surface.window else (0, 0),
            ),
            lease,
        )

    def full_size(self, port: Port, wish: PreviewRequest, plan: Plan, size: Size) -> Size:
        """The size at scale 1 of what was rounded at this one: as before, or that of a picture or the canvas."""
        candidates = [self._full_sizes.get(port), wish.size, wish.graph.settings.size]
        candidates += [plan.surfaces[upload.surface].size for upload in plan.uploads]
        full_size = (round(size[0] / wish.scale), round(size[1] / wish.scale))
        for full in candidates:
            if full and scale_size(full, wish.scale) == size:
                full_size = full
                break
        full_size = size if wish.scale == 1.0 or size == (1, 1) else full_size
        self._full_sizes[port] = full_size
        return full_size

    def keep(self, names: Container[str]) -> None:
        """Take down what no panel of these names shows."""
        for pictures in (self._pictures, self._parts):
            for name in [name for name in pictures if name not in names]:
                _drop(pictures.pop(name))


def _drop(picture: _LeasedImage | None) -> None:
    if picture is not None:
        picture.lease.close()
