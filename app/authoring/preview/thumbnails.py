"""Thumbnails of nodes, drawn from results that are on the device anyway."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from halation.nodes import ColorSettings, Kind
from msgspec import Struct

from ...color.management import get_default_color_manager
from ...compiler import Plan, scale_size
from ...media.comparison.data_range import are_normals, balance_range, find_data_range
from ...renderer import DeviceTexture, Display, Look, PixelProbe, Renderer
from .color_fallback import ColorFallback
from .request import PreviewRequest, canvas_path, find_output_place, pixel_kind

LARGEST = (160, 90)
"""The largest thumbnail: nearly as wide as a node on the canvas, in 16:9."""
RANGE_WIDTH = 64
"""The width of the picture on which the range of a field is measured: small enough to read it back every time."""


class ThumbnailSource(Struct, frozen=True):
    """The result that a thumbnail shows. `mark` changes when anything upstream of the node changes."""

    path: str
    place: int
    """Which of the outputs of its node it is, from 0."""
    key: str
    kind: Kind
    channels: int
    mark: object
    frame: int
    size: tuple[int, int]
    start: tuple[int, int]
    """The pixel of the frame with which the texture begins: below 0 if it goes on beyond the frame."""

    def is_preferred_to(self, other: ThumbnailSource) -> bool:
        """True for an earlier output of the same node in the same state: a view of a later one does not replace it."""
        return self.place < other.place and (self.mark, self.frame) == (other.mark, other.frame)


class _DisplaySource(Struct, frozen=True):
    """The picture and its meaning, as the display takes them."""

    texture: DeviceTexture
    full_size: tuple[int, int]
    channels: int
    key: str
    start: tuple[int, int]

    @property
    def size(self) -> tuple[int, int]:
        return self.full_size


class _Thumbnail(Struct, frozen=True):
    texture: DeviceTexture
    source: ThumbnailSource


def list_thumbnail_sources(request: PreviewRequest, plan: Plan) -> dict[str, ThumbnailSource]:
    """The thumbnail sources of a plan that has run, by path: the first output of each node that it computes."""
    sources: dict[str, ThumbnailSource] = {}
    for port, number in plan.results.items():
        path, surface = canvas_path(port), plan.surfaces[number]
        kind = pixel_kind(request.graph, port, surface.channels)
        start, mark = surface.window.start if surface.window else (0, 0), request.node_mark(path)
        source = ThumbnailSource(
            path,
            find_output_place(request.graph, port),
            surface.key,
            kind,
            surface.channels,
            mark,
            request.frame,
            surface.frame_size,
            start,
        )
        if path not in sources or source.is_preferred_to(sources[path]):
            sources[path] = source
    return sources


class Thumbnails:
    """The last thumbnail of every node. No result is ever computed only for a thumbnail."""

    def __init__(self, renderer: Renderer, display: Display) -> None:
        self._renderer, self._display = renderer, display
        self._probe = PixelProbe(renderer.device)
        self._thumbnails: dict[str, _Thumbnail] = {}
        self._waiting: dict[str, ThumbnailSource] = {}
        self._coloring, self._manager = ColorFallback(renderer.sandbox), get_default_color_manager()
        self.paths: frozenset[str] = frozenset()
        """The paths that have a thumbnail; the same object until that changes."""

    @property
    def waiting(self) -> bool:
        """True while thumbnails wait to be drawn."""
        return bool(self._waiting)

    def offer(self, subjects: Mapping[str, ThumbnailSource], color: ColorSettings | None = None) -> None:
        """Offer results for thumbnails, by path, with the color manager that displays them."""
        self._manager = self._coloring.resolve(color or ColorSettings())
        for path, subject in subjects.items():
            thumbnail = self._thumbnails.get(path)
            self._waiting.pop(path, None)
            if thumbnail is not None and thumbnail.source.is_preferred_to(subject):
                continue
            if thumbnail is not None and thumbnail.source.key == subject.key:
                self._thumbnails[path] = _Thumbnail(thumbnail.texture, subject)
            else:
                self._waiting[path] = subject

    def draw_next(self) -> None:
        """Draw the next thumbnail, if its result is still on the device."""
        subject = self._waiting.pop(next(iter(self._waiting)))
        texture = self._renderer.runner.textures.find(subject.key)
        if texture is None:
            return
        source = _DisplaySource(texture.handle, subject.size, subject.channels, subject.key, subject.start)
        width, height = source.full_size
        zoom = min(LARGEST[0] / width, LARGEST[1] / height, 1.0)
        size = scale_size(source.full_size, zoom)
        look = self._look(subject, source.texture, max(size[0] / width, size[1] / height))
        handle = self._display.draw(f"thumbnail {subject.path}", size, source, None, look)
        self._thumbnails[subject.path] = _Thumbnail(handle, subject)
        if subject.path not in self.paths:
            self.paths |= {subject.path}

    def find(self, path: str, mark: Callable[[str], object]) -> tuple[DeviceTexture, bool] | None:
        """The last thumbnail of a node, and whether it is up to date, by its `mark`."""
        thumbnail = self._thumbnails.get(path)
        return thumbnail and (thumbnail.texture, thumbnail.source.mark == mark(path))

    def clear(self) -> None:
        """Drop all thumbnails."""
        for path in self._thumbnails:
            self._display.release_slot(f"thumbnail {path}")
        self._thumbnails.clear()
        self._waiting.clear()
        self.paths = frozenset()

    def close(self) -> None:
        """Release all textures."""
        self.clear()
        self._probe.close()

    def _look(self, subject: ThumbnailSource, texture: DeviceTexture, zoom: float) -> Look:
        if subject.kind is Kind.IMAGE:
            return Look(zoom=zoom, view="none", manager=self._manager)
        pixels = self._probe.read_small(texture, RANGE_WIDTH)[..., : subject.channels]
        if are_normals(pixels):
            return Look(zoom=zoom, meaning="normal")
        low, high = find_data_range(pixels)
        if subject.channels > 1:
            low, high = balance_range(low, high)
        elif low >= 0.0 and high <= 1.0:  # a mask, for example: black and white have a meaning
            low, high = 0.0, 1.0
        return Look(zoom=zoom, meaning="field" if subject.channels == 1 else "vector", low=low, high=high)
