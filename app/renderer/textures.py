"""Textures: pooled by size and format, kept by key under a byte budget."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

import moderngl

from ..compiler import Surface
from ..errors import DeviceError

Kind = tuple[int, int, int, str]
"""Width, height, components, depth."""


@dataclass(eq=False)
class Texture:
    """A texture on the device, and a framebuffer for it once a fragment pass draws to it alone."""

    handle: moderngl.Texture
    kind: Kind
    nbytes: int
    framebuffer: moderngl.Framebuffer | None = None

    def release(self) -> None:
        """Give it back to the driver."""
        if self.framebuffer is not None:
            self.framebuffer.release()
        self.handle.release()


class Textures:
    """Every texture we own. Results stay by key, least recently used first out; freed ones wait for the next use."""

    def __init__(self, context: moderngl.Context, max_size: int, budget: int) -> None:
        self._context, self._max_size = context, max_size
        self.budget = budget
        self._results: OrderedDict[str, Texture] = OrderedDict()
        self._pinned: set[str] = set()
        self._held: set[str] = set()
        self._free: dict[Kind, list[Texture]] = {}
        self.allocated = 0
        self.peak = 0

    def find(self, key: str) -> Texture | None:
        """The texture that holds these pixels, if any does."""
        found = self._results.get(key)
        if found is not None:
            self._results.move_to_end(key)
        return found

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def make(self, surface: Surface) -> Texture:
        """A texture for `surface`, pinned until `unpin`. Raises DeviceError where the device cannot hold it."""
        kind = (*surface.size, surface.components, surface.depth)
        waiting = self._free.get(kind)
        texture = waiting.pop() if waiting else self._allocate(kind, surface)
        self._results[surface.key] = texture
        self._pinned.add(surface.key)
        return texture

    def pin(self, key: str) -> None:
        """Keep these pixels until `unpin`."""
        self._pinned.add(key)

    def unpin(self, key: str) -> None:
        """These pixels may go as soon as the budget asks for it."""
        self._pinned.discard(key)
        self._trim()

    def hold(self, key: str) -> None:
        """Keep these pixels until `let_go`, whatever the budget says: a later frame needs them."""
        self._held.add(key)

    def let_go(self, key: str) -> None:
        """These pixels may go like any others."""
        self._held.discard(key)
        self._trim()

    def drop(self, key: str) -> None:
        """Forget these pixels: they were not finished."""
        self._pinned.discard(key)
        texture = self._results.pop(key, None)
        if texture is not None:
            self._free.setdefault(texture.kind, []).append(texture)

    def clear(self) -> None:
        """Give everything back to the driver."""
        for texture in (*self._results.values(), *(one for waiting in self._free.values() for one in waiting)):
            texture.release()
        self._results.clear()
        self._pinned.clear()
        self._held.clear()
        self._free.clear()
        self.allocated = 0

    def _trim(self) -> None:
        """Free unpinned results, oldest first, until what is kept fits the budget."""
        idle = [key for key in self._results if key not in self._pinned and key not in self._held]
        kept = sum(self._results[key].nbytes for key in idle)
        for key in idle:
            if kept <= self.budget:
                break
            kept -= self._results[key].nbytes
            self.drop(key)

    def _allocate(self, kind: Kind, surface: Surface) -> Texture:
        width, height, components, depth = kind
        if max(width, height) > self._max_size:
            raise DeviceError(
                f"node '{surface.label}': {width}x{height} pixels is more than the {self._max_size} that this device "
                "can hold on a side; render smaller with --scale or --size"
            )
        self._context.error  # noqa: B018  (reading it clears what earlier calls left behind)
        handle = self._try(width, height, components, depth)
        if handle is None:
            for waiting in self._free.values():
                for texture in waiting:
                    self.allocated -= texture.nbytes
                    texture.release()
            self._free.clear()
            handle = self._try(width, height, components, depth)
        if handle is None:
            raise DeviceError(
                f"node '{surface.label}': the device has no room for {surface.nbytes / 2**20:.0f} MiB more "
                f"({self.allocated / 2**20:.0f} MiB are in use); render smaller with --scale or --size, or with "
                "--precision half"
            )
        handle.filter = (moderngl.NEAREST, moderngl.NEAREST)
        handle.repeat_x = handle.repeat_y = False
        self.allocated += surface.nbytes
        self.peak = max(self.peak, self.allocated)
        return Texture(handle, kind, surface.nbytes)

    def _try(self, width: int, height: int, components: int, depth: str) -> moderngl.Texture | None:
        try:
            handle = self._context.texture((width, height), components, dtype=depth)
        except moderngl.Error:
            return None
        # moderngl does not raise when the driver is out of memory.
        if self._context.error != "GL_NO_ERROR":
            handle.release()
            return None
        return handle
