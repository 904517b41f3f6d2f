"""The frames of one graph that are on the device, and the histories of temporal nodes."""

from __future__ import annotations

import time
from collections.abc import Mapping

from halation.nodes import Size
from msgspec import Struct

from ...compiler import Surface
from ...graph import Port
from ...renderer import FrameRenderer, Renderer, TextureLease
from ...renderer.execution.texture_pool import count_device_bytes

SHARE = 0.5
"""The share of the memory budget for frames that were shown; the rest is for the current frame. A choice."""

LOOK_AGAIN = 0.2
"""Seconds between two checks which frames are still on the device: a choice, for checking takes time."""

MOST_FRAMES = 5000
"""The most frames that are remembered, whatever their size: more than three minutes at 24 per second. A choice."""


class FrameImage(Struct, frozen=True):
    """The picture of one frame in one panel."""

    surface: Surface
    full_size: Size
    default_view: str = ""


FrameImages = Mapping[str, FrameImage]
"""The pictures of one frame, by the panels' names."""


class FrameCache:
    """The frames of one graph as it is wanted, whatever the frame: it ends with any other change.

    Frames that were shown stay on the device within a share of the memory budget; when that is spent, those go that
    would be wanted last if the range was played on and on.
    """

    def __init__(self) -> None:
        self._images_by_frame: dict[int, FrameImages] = {}
        self._leases: dict[int, TextureLease] = {}
        self._last_lookup: tuple[tuple[str, ...], float, tuple[int, ...]] = ((), 0.0, ())
        """The last check: for which panels, when, and which frames were there."""
        self._frame_renderers: dict[tuple[tuple[str, Port], ...], FrameRenderer] = {}
        self.closed = False
        self.failed_frames: set[int] = set()
        """Frames that failed to render."""

    # --- frames ------------------------------------------------------------------------------------------------------

    def add_frame(self, frame: int, frame_images: FrameImages, renderer: Renderer, current_frame: int) -> None:
        """Add a rendered frame; `now` is the current one."""
        if self.closed:
            return
        self._last_lookup = (), 0.0, ()
        frame_images = {**self._images_by_frame.get(frame, {}), **frame_images}
        self._release_frame(frame)
        self._images_by_frame[frame] = frame_images
        lease = renderer.runner.create_lease()
        for frame_image in frame_images.values():
            if frame_image.surface.key in renderer.runner.textures:
                lease.add(frame_image.surface.key)
        self._leases[frame] = lease
        self._make_room(int(renderer.runner.textures.budget * SHARE), current_frame)
        while len(self._images_by_frame) > MOST_FRAMES:
            self._forget_frame(next(iter(self._images_by_frame)))

    def find(self, frame: int, names: Mapping[str, Port], renderer: Renderer) -> FrameImages | None:
        """The pictures of a frame for these panels, if all are on the device."""
        frame_images = self._images_by_frame.get(frame)
        return frame_images if frame_images is not None and is_on_device(frame_images, names, renderer) else None

    def list_frames(self, names: Mapping[str, Port], renderer: Renderer) -> tuple[int, ...]:
        """The frames that are on the device, in order; frames that were dropped are noticed a moment later."""
        time_now = time.monotonic()
        asked_names, looked_up_at, frames = self._last_lookup
        if asked_names != tuple(names) or time_now - looked_up_at > LOOK_AGAIN:
            frames = tuple(
                sorted(
                    frame
                    for frame, frame_images in self._images_by_frame.items()
                    if is_on_device(frame_images, names, renderer)
                )
            )
            self._last_lookup = tuple(names), time_now, frames
        return frames

    @property
    def nbytes(self) -> int:
        """The bytes of all cached frames on the device."""
        return sum(self._sizes().values())

    # --- histories ---------------------------------------------------------------------------------------------------

    def find_frame_renderer(self, ports: Mapping[str, Port]) -> FrameRenderer | None:
        """The history of these ports, if they are known to have one."""
        return self._frame_renderers.get(tuple(ports.items()))

    @property
    def needs_history(self) -> bool:
        """True if frames are known to need the ones before."""
        return bool(self._frame_renderers)

    def add_frame_renderer(self, ports: Mapping[str, Port], reel: FrameRenderer) -> FrameRenderer:
        """Remember the history of these ports."""
        self._frame_renderers[tuple(ports.items())] = reel
        return reel

    def close(self) -> None:
        """Release everything."""
        self.closed = True
        for lease in (*self._leases.values(), *self._frame_renderers.values()):
            lease.close()
        self._images_by_frame.clear()
        self._leases.clear()
        self._frame_renderers.clear()

    # --- parts -------------------------------------------------------------------------------------------------------

    def _sizes(self) -> dict[str, int]:
        return {
            frame_image.surface.key: count_device_bytes(frame_image.surface.nbytes)
            for frame in self._leases
            for frame_image in self._images_by_frame[frame].values()
        }

    def _make_room(self, most: int, current_frame: int) -> None:
        """Release the frames that playback needs last, until the others fit."""
        sizes = self._sizes()
        total, first, last = sum(sizes.values()), min(self._leases), max(self._leases)
        if total <= most:
            return
        span = last - first + 1
        for frame in sorted(self._leases, key=lambda frame: (frame - current_frame) % span, reverse=True):
            self._release_frame(frame)
            if sum(self._sizes().values()) <= most:
                return

    def _release_frame(self, frame: int) -> None:
        """Release a frame; its texture may stay on the device for a while."""
        if lease := self._leases.pop(frame, None):
            lease.close()

    def _forget_frame(self, frame: int) -> None:
        self._release_frame(frame)
        del self._images_by_frame[frame]


def is_on_device(frame_images: FrameImages, names: Mapping[str, Port], renderer: Renderer) -> bool:
    """True if the pictures of all these panels are on the device."""
    textures = renderer.runner.textures
    return all(name in frame_images and frame_images[name].surface.key in textures for name in names)
