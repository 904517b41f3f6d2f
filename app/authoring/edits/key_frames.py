"""The frames that have keys."""

from __future__ import annotations

from collections.abc import Collection

from ...graph import Animation, Graph, Keys
from ...graph.keys import round_keys


def whole_key_frames(animation: Animation | None) -> tuple[int, ...]:
    """The whole frames nearest to the keys of a value, in order."""
    frames = animation.frames if isinstance(animation, Keys) else ()
    return tuple(sorted({round_keys(frame) for frame in frames}))


def list_key_frames(graph: Graph, chosen: Collection[str]) -> tuple[int, ...]:
    """The frames with keys of the chosen nodes, or, where these have none, of all nodes."""
    animation = graph.animation
    nodes = {id for id in graph.nodes if id in chosen}
    frames = {frame for port, item in animation.items() if port.node in nodes for frame in whole_key_frames(item)}
    return tuple(sorted(frames or {frame for item in animation.values() for frame in whole_key_frames(item)}))
