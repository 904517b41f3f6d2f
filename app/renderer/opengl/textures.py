"""Textures: pooled by size and format, kept by key under a byte budget, leased by the runs that need them."""

from __future__ import annotations

from collections import Counter

import moderngl
from msgspec import Struct

from ...compiler import Surface
from ...errors import DeviceError

Kind = tuple[int, int, int, str]
"""Width, height, components, depth."""


_SMALLEST = 2**16
"""What a texture counts for at least among those that may go: one of few pixels takes more than these."""


class Texture(Struct, eq=False):
    """A texture on the device, and a framebuffer for it once a fragment pass draws to it alone."""

    handle: moderngl.Texture
    kind: Kind
    nbytes: int
    framebuffer: moderngl.Framebuffer | None = None
    freed: int = 0
    """The round in which it was last in use."""
    cost: float = 0.0
    """Seconds that it would take to make its pixels again."""

    def release(self) -> None:
        """Give it back to the driver."""
        if self.framebuffer is not None:
            self.framebuffer.release()
        self.handle.release()


class Textures:
    """Every texture we own: results by key, of which those that nobody leases go when the budget is spent.

    First goes what was not used for long and is made again soon: the rank of a result is what a byte of it costs, on
    top of the rank of the last one that went (GreedyDual-Size: Cao and Irani 1997). At equal costs that is the least
    recently used one.

    A freed texture waits for the next use, but not for long: `next_round` returns what a whole round did not want, so
    that pictures of ever other sizes do not pile up.
    """

    def __init__(self, context: moderngl.Context, budget: int) -> None:
        self._context = context
        self.budget = budget
        self._results: dict[str, Texture] = {}
        self._leases: Counter[str] = Counter()
        self._idle: dict[str, float] = {}
        """Results that nobody leases, least recently used first, and their ranks."""
        self._floor = 0.0
        """The rank of the last one that went."""
        self._idle_bytes = 0
        self._free: dict[Kind, list[Texture]] = {}
        self._round = 0
        self.allocated = 0
        self.peak = 0

    def find(self, key: str) -> Texture | None:
        """The texture that holds these pixels, if any does."""
        return self._results.get(key)

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def clear(self) -> None:
        """Give everything back to the driver."""
        for texture in self._results.values():
            texture.release()
        self._results.clear()
        self._leases.clear()
        self._idle.clear()
        self._idle_bytes = 0
        self._release_free()
        self.allocated = 0

    def forget(self) -> None:
        """Give back to the driver whatever nobody leases."""
        for key in list(self._idle):
            self.drop(key)
        self._release_free()

    def next_round(self) -> None:
        """Give back to the driver what waited in vain since the round before this one."""
        waiting, self._free = [one for kind in self._free.values() for one in kind], {}
        for texture in waiting:
            if texture.freed < self._round:
                self._release(texture)
            else:
                self._free.setdefault(texture.kind, []).append(texture)
        self._round += 1

    # --- for leases --------------------------------------------------------------------------------------------------

    def make(self, surface: Surface) -> Texture:
        """A texture for `surface`, leased. Raises DeviceError where the device cannot hold it."""
        kind = (*surface.size, surface.components, surface.depth)
        waiting = self._free.get(kind)
        texture = waiting.pop() if waiting else self._allocate(kind, surface)
        self._results[surface.key] = texture
        self._leases[surface.key] += 1
        return texture

    def lease(self, key: str) -> None:
        """Keep these pixels until `unlease`."""
        self._leases[key] += 1
        self._wake(key)

    def unlease(self, key: str) -> None:
        """Unless somebody else leases them, these pixels may go as soon as the budget asks for it."""
        if key not in self._leases:  # everything was given back to the driver
            return
        self._leases[key] -= 1
        if self._leases[key] > 0:
            return
        del self._leases[key]
        texture = self._results[key]
        self._idle[key] = self._floor + texture.cost / max(texture.nbytes, _SMALLEST)
        self._idle_bytes += texture.nbytes
        while self._idle_bytes > self.budget:
            gone = min(self._idle, key=self._idle.__getitem__)
            self._floor = self._idle[gone]
            self.drop(gone)

    def drop(self, key: str) -> None:
        """Forget these pixels: there is no room for them, or they were not finished."""
        self._wake(key)
        self._leases.pop(key, None)
        texture = self._results.pop(key)
        texture.freed = self._round
        self._free.setdefault(texture.kind, []).append(texture)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _wake(self, key: str) -> None:
        """No longer idle."""
        if key in self._idle:
            del self._idle[key]
            self._idle_bytes -= self._results[key].nbytes

    def _release(self, texture: Texture) -> None:
        self.allocated -= texture.nbytes
        texture.release()

    def _release_free(self) -> None:
        for waiting in self._free.values():
            for texture in waiting:
                self._release(texture)
        self._free.clear()

    def _allocate(self, kind: Kind, surface: Surface) -> Texture:
        width, height, components, depth = kind
        self._context.error  # noqa: B018  (reading it clears what earlier calls left behind)
        handle = self._try(width, height, components, depth)
        for make_room in (self._release_free, self.forget):
            if handle is None:
                make_room()
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


class Lease:
    """The pixels that one run still needs: they stay until it hands them back."""

    def __init__(self, textures: Textures) -> None:
        self._textures = textures
        self._keys: set[str] = set()
        self._others: list[object] = []

    def make(self, surface: Surface) -> Texture:
        """A texture for `surface`, whose pixels are to be made. Raises DeviceError where there is no room."""
        texture = self._textures.make(surface)
        self._keys.add(surface.key)
        return texture

    def take(self, key: str) -> None:
        """Keep these pixels."""
        if key not in self._keys:
            self._textures.lease(key)
            self._keys.add(key)

    def hold(self, pixels: object) -> None:
        """Keep these as well, which are not on the device."""
        self._others.append(pixels)

    def give(self, key: str) -> None:
        """These pixels are not needed any more."""
        if key in self._keys:
            self._keys.discard(key)
            self._textures.unlease(key)

    def spoil(self, key: str) -> None:
        """These pixels could not be made."""
        if key in self._keys:
            self._keys.discard(key)
            self._textures.drop(key)

    def close(self) -> None:
        """Hand everything back."""
        self._others.clear()
        for key in list(self._keys):
            self.give(key)
