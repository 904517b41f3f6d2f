"""Objects on the device that are created once and used by many passes: programs, tables, weights, meshes."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

from ..device import DeviceResource

Key = TypeVar("Key", bound=Hashable)
Resource = TypeVar("Resource", bound=DeviceResource)


class ResourceCache(Generic[Key, Resource]):
    """Keeps at most `limit` objects by key; the least recently used one is released first."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._resources: dict[Key, Resource] = {}

    def get(self, key: Key, create: Callable[[], Resource]) -> Resource:
        """The object of a key, created where it is not there."""
        resource = self._resources.pop(key, None)
        if resource is None:
            resource = create()
        self._resources[key] = resource
        if len(self._resources) > self._limit:
            self._resources.pop(next(iter(self._resources))).release()
        return resource

    def __contains__(self, key: Key) -> bool:
        return key in self._resources

    def clear(self) -> None:
        """Release all of them."""
        for resource in self._resources.values():
            resource.release()
        self._resources.clear()
