"""Which parts of a script are functions of the frame, and which run frame by frame."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence, Set

from halation.nodes import Temporal
from msgspec import Struct

from ...compiler.lowering.expand import FlatGraph
from ...compiler.lowering.graph_at_frames import GraphAtFrames
from ...errors import GraphError
from ...graph import Port

MAIN = ""
"""The part of a script that makes the picture of the graph."""

_SAMPLED = 240
"""The frames, from the first one, of which is looked up what they read: as many as animated values have."""


class ScriptParts(Struct, frozen=True):
    """The part of the script to which each node and each input belongs: `MAIN`, or itself for a function of the frame.

    `looped` are the nodes of the main part that are needed at each frame from the first one, for nodes with a memory.
    """

    parts: Mapping[str, str]
    looped: Set[str]

    @property
    def clips(self) -> list[str]:
        """The nodes and inputs that are functions, each after those that it uses."""
        return [key for key, part in reversed(list(self.parts.items())) if part == key]


def find_read_frames(
    at_frames: GraphAtFrames, source: Port, frames: tuple[int, int]
) -> tuple[tuple[int, int], dict[str, int]]:
    """The first and the last frame that is read in order to make some frames, and by node or input over how many
    frames it is read for one of these.
    """
    read_frames, spans = set(frames), dict[str, int]()
    flat = at_frames.flat_at(frames[0])
    for frame in range(frames[0], min(frames[1], frames[0] + _SAMPLED - 1) + 1):
        seen = defaultdict[str, set[int]](set)
        for moment in at_frames.find_order([source], frame):
            for port, at in at_frames.find_feeds(moment).values():
                seen[find_key(flat, port)].update(at)
        read_frames.update(*seen.values())
        for key, times in seen.items():
            spans[key] = max(spans.get(key, 1), max(times) - min(times) + 1)
    return (min(read_frames), max(read_frames)), spans


def find_key(flat: FlatGraph, port: Port) -> str:
    """The name under which a node, or an input of the graph, has its part."""
    return f"{port}" if port in flat.inputs else port.node


def has_memory(flat: FlatGraph, path: str) -> bool:
    """True for a node that remembers the frame before."""
    return isinstance(flat.nodes.get(path), Temporal) and path not in flat.muted


def plan_parts(
    flat: FlatGraph,
    paths: Sequence[str],
    source: Port,
    find_feeds: Callable[[str], Mapping[str, Port]],
    list_clips: Callable[[str], Set[str]],
    is_written_anywhere: Callable[[Port], bool],
) -> ScriptParts:
    """Which part of a script each node belongs to. `paths` are the nodes that `source` needs, each after what it reads.

    What is read at several frames (`list_clips`) is a function of the frame, and so is what two parts need: nothing is
    made twice in one frame. What `is_written_anywhere`, such as a number, belongs to no part. Raises GraphError for a
    node with a memory of which other frames are read.
    """
    readers, clips = defaultdict[str, dict[str, None]](dict), set[str]()
    parts: dict[str, str] = {}

    def enter(port: Port, reader: str) -> str:
        key = find_key(flat, port)
        if not is_written_anywhere(port):
            readers[key][reader] = None
        return key

    def choose_part(key: str) -> str:
        parts[key] = key if key in clips or len(readers[key]) > 1 else next(iter(readers[key]))
        return parts[key]

    enter(source, MAIN)
    for path in reversed(paths):
        if not readers[path]:
            continue
        part = choose_part(path)
        if part != MAIN and has_memory(flat, path):
            fault = "it remembers the frame before, and is read at other frames"
            raise GraphError(f"node '{path}': {fault}: put what changes the time before it", node=path)
        by_frame = list_clips(path)
        for name, port in find_feeds(path).items():
            key = enter(port, part)
            if name in by_frame and not is_written_anywhere(port):
                clips.add(key)
    for key in [key for key in readers if key not in parts and readers[key]]:
        choose_part(key)
    return ScriptParts(parts, _find_looped(flat, paths, parts, find_feeds))


def _find_looped(
    flat: FlatGraph, paths: Sequence[str], parts: Mapping[str, str], find_feeds: Callable[[str], Mapping[str, Port]]
) -> Set[str]:
    """The nodes of the main part that have a memory, or that such a node needs."""
    looped = set[str]()
    for path in reversed(paths):
        if parts.get(path) == MAIN and (path in looped or has_memory(flat, path)):
            looped.add(path)
            looped |= {port.node for port in find_feeds(path).values()}
    return looped
