"""One file of a render job that has many: what it has of its own."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct, field


class RenderEntry(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """The name, inputs, values and destinations of one file of a `RenderJob`, which has the same for all of them."""

    file: str
    inputs: Mapping[str, str] = field(default_factory=dict[str, str])
    sets: Mapping[str, str] = field(default_factory=dict[str, str])
    destinations: tuple[tuple[str, str], ...] = ()
