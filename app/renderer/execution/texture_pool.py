"""Textures: pooled by size and format, kept by key under a byte budget, leased by the runs that need them.

The key of a surface says what its pixels are. A texture under a key is leased while a run, a panel or a history needs
it. Without a lease it is idle: it stays as long as the budget allows, because the next plan often wants the same
pixels. What the budget evicts is not destroyed at once either: a texture of the same size and format is often wanted a
moment later.
"""

from __future__ import annotations

from collections import Counter

from msgspec import Struct

from ...compiler import Surface
from ...compiler.plan import Depth
from ...errors import DeviceError, describe_owner
from ..device import Device, DeviceTexture

TextureKind = tuple[int, int, int, Depth]
"""Width, height, components, depth."""


MIN_TEXTURE_BYTES = 2**16
"""The bytes that a texture takes at least on a device, however few pixels it has: GPUs place textures in steps of
64 KiB (Direct3D 12, D3D12_DEFAULT_RESOURCE_PLACEMENT_ALIGNMENT). Mesa's llvmpipe takes 2.5 KiB beside the pixels and up
to 5 KiB more for a framebuffer (measured on 1,000 textures of 1, 8 and 32 pixels on a side). With its own 16 bytes a
single pixel would rank above every picture, and a budget of 512 MiB would hold 33 million of them."""


def count_device_bytes(pixel_bytes: int) -> int:
    """The bytes that a texture takes on the device, beside which the pixels of a small texture are little."""
    return max(pixel_bytes, MIN_TEXTURE_BYTES)


class PooledTexture(Struct, eq=False):
    """A texture of the pool."""

    handle: DeviceTexture
    kind: TextureKind
    nbytes: int
    freed_round: int = 0
    """The round in which it was last in use."""
    cost: float = 0.0
    """Seconds that it would take to make its pixels again."""

    @property
    def device_bytes(self) -> int:
        """The bytes that it takes on the device."""
        return count_device_bytes(self.nbytes)


class TexturePool:
    """Every texture that renderings own: results by key, of which idle ones are evicted when the budget is spent.

    A result that is cheap to make again and was not used for long is evicted first: its rank is its cost per byte, on
    top of the rank of the result that was evicted last (GreedyDual-Size: Cao and Irani 1997). At equal costs that is
    the least recently used one.

    A free texture waits for its next use, but not for long: `next_round` releases what a whole round did not use, so
    that pictures of many sizes do not pile up.
    """

    def __init__(self, device: Device, budget: int) -> None:
        self._device = device
        self.budget = budget
        self._results: dict[str, PooledTexture] = {}
        self._leases: Counter[str] = Counter()
        self._idle: dict[str, float] = {}
        """Results without a lease, least recently used first, and their ranks."""
        self._evicted_rank = 0.0
        """The rank of the result that was evicted last."""
        self._idle_bytes = 0
        self._free: dict[TextureKind, list[PooledTexture]] = {}
        self._round = 0
        self.allocated = 0
        """Bytes of the pixels of all textures on the device, as plans count them."""
        self.peak = 0
        """The most that `allocated` has been."""

    def find(self, key: str) -> PooledTexture | None:
        """The texture that holds these pixels, if any does."""
        return self._results.get(key)

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def clear(self) -> None:
        """Release everything."""
        for texture in self._results.values():
            texture.handle.release()
        self._results.clear()
        self._leases.clear()
        self._idle.clear()
        self._idle_bytes = 0
        self._release_free()
        self.allocated = 0

    def release_idle(self) -> None:
        """Release everything that has no lease."""
        for key in list(self._idle):
            self.forget(key)
        self._release_free()

    def next_round(self) -> None:
        """Release the free textures that nobody used since the round before this one."""
        waiting, self._free = [texture for textures in self._free.values() for texture in textures], {}
        for texture in waiting:
            if texture.freed_round < self._round:
                self._release(texture)
            else:
                self._free.setdefault(texture.kind, []).append(texture)
        self._round += 1

    # --- for leases --------------------------------------------------------------------------------------------------

    def create(self, surface: Surface) -> PooledTexture:
        """A texture for `surface`, leased. Raises DeviceError where the device cannot hold it."""
        kind = (*surface.size, surface.components, surface.depth)
        waiting = self._free.get(kind)
        texture = waiting.pop() if waiting else self._allocate(kind, surface)
        self._results[surface.key] = texture
        self._leases[surface.key] += 1
        return texture

    def lease(self, key: str) -> None:
        """Keep these pixels until `end_lease`."""
        self._leases[key] += 1
        self._remove_from_idle(key)

    def end_lease(self, key: str) -> None:
        """Unless they have another lease, these pixels may go as soon as the budget requires it."""
        if key not in self._leases:  # everything was released meanwhile
            return
        self._leases[key] -= 1
        if self._leases[key] > 0:
            return
        del self._leases[key]
        texture = self._results[key]
        self._idle[key] = self._evicted_rank + texture.cost / texture.device_bytes
        self._idle_bytes += texture.device_bytes
        while self._idle_bytes > self.budget:
            lowest = min(self._idle, key=self._idle.__getitem__)
            self._evicted_rank = self._idle[lowest]
            self.forget(lowest)

    def forget(self, key: str) -> None:
        """Forget these pixels: there is no room for them, or they were not finished."""
        self._remove_from_idle(key)
        self._leases.pop(key, None)
        texture = self._results.pop(key)
        texture.freed_round = self._round
        self._free.setdefault(texture.kind, []).append(texture)

    def rename(self, key: str, new_key: str) -> None:
        """Keep leased pixels, which nobody else has, under another key, which is free."""
        self._results[new_key], self._leases[new_key] = self._results.pop(key), self._leases.pop(key)

    # --- parts -------------------------------------------------------------------------------------------------------

    def _remove_from_idle(self, key: str) -> None:
        if key in self._idle:
            del self._idle[key]
            self._idle_bytes -= self._results[key].device_bytes

    def _release(self, texture: PooledTexture) -> None:
        self.allocated -= texture.nbytes
        texture.handle.release()

    def _release_free(self) -> None:
        for waiting in self._free.values():
            for texture in waiting:
                self._release(texture)
        self._free.clear()

    def _allocate(self, kind: TextureKind, surface: Surface) -> PooledTexture:
        handle = self._try_create(kind)
        for free_memory in (self._release_free, self.release_idle):
            if handle is None:
                free_memory()
                handle = self._try_create(kind)
        if handle is None:
            raise DeviceError(
                f"{describe_owner(surface.label)}: the device has no room for {surface.nbytes / 2**20:.0f} MiB more "
                f"({self.allocated / 2**20:.0f} MiB are in use); render smaller with --scale or --size, or with "
                "--precision half"
            )
        self.allocated += surface.nbytes
        self.peak = max(self.peak, self.allocated)
        return PooledTexture(handle, kind, surface.nbytes)

    def _try_create(self, kind: TextureKind) -> DeviceTexture | None:
        width, height, components, depth = kind
        try:
            return self._device.create_texture((width, height), components, depth)
        except DeviceError:
            return None


class TextureLease:
    """Keeps the pixels that a run, a panel or a history still needs, until it gives them back."""

    def __init__(self, textures: TexturePool) -> None:
        self._textures = textures
        self._keys: set[str] = set()
        self._arrays: list[object] = []

    def create(self, surface: Surface) -> PooledTexture:
        """A texture for `surface`, whose pixels are to be made. Raises DeviceError where there is no room."""
        texture = self._textures.create(surface)
        self._keys.add(surface.key)
        return texture

    def rename(self, key: str, new_key: str) -> None:
        """Keep pixels that this lease has created under another key, which is free."""
        self._textures.rename(key, new_key)
        self._keys.remove(key)
        self._keys.add(new_key)

    def add(self, key: str) -> None:
        """Keep these pixels."""
        if key not in self._keys:
            self._textures.lease(key)
            self._keys.add(key)

    def hold(self, pixels: object) -> None:
        """Keep pixels that are not on the device as well."""
        self._arrays.append(pixels)

    def release(self, key: str) -> None:
        """These pixels are not needed any more."""
        if key in self._keys:
            self._keys.discard(key)
            self._textures.end_lease(key)

    def discard(self, key: str) -> None:
        """These pixels could not be made."""
        if key in self._keys:
            self._keys.discard(key)
            self._textures.forget(key)

    def close(self) -> None:
        """Give everything back."""
        self._arrays.clear()
        for key in list(self._keys):
            self.release(key)
