"""The files that a graph names: pictures of inputs and sources, and other paths."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import PurePath

from halation.nodes import Kind, Missing, Reader, Source
from msgspec.structs import replace

from ...graph import INPUTS, Graph, Group, Input, Port, color_settings
from ...graph.color import BUILT_IN
from ...resources.picture import Picture
from .expand import FlatGraph, expand

CONFIG = "settings.config"
"""Stands for the node where the color settings of the graph name a file."""


class ReferencedPictures:
    """The pictures that a graph names, and those that are bound to its inputs."""

    def __init__(self, flat: FlatGraph, bindings: Mapping[str, Picture]) -> None:
        self._flat, self._bindings = flat, bindings

    def __iter__(self) -> Iterator[tuple[Picture, str]]:
        """Every picture and the node that reads it, inputs first, then sources. A path may stand for a sequence."""
        for port, socket in self._flat.inputs.items():
            named = port.node == INPUTS and not socket.kind.is_single
            picture = self.find_bound(port, socket) if named else None
            if picture is not None:
                yield picture, f"{port}"
        for path, node in self._flat.nodes.items():
            for value in node.values.values() if isinstance(node, Source) else ():
                if value.pixels and node.setting(value.name):
                    yield Picture(self.locate(str(node.setting(value.name)), path), "", Kind.IMAGE, 4), path

    def find_bound(self, port: Port, socket: Input) -> Picture | None:
        """The picture bound to a graph input, else its default file; None for objects such as cameras."""
        if socket.kind.is_planned:
            return None
        kind, width = socket.kind, socket.width
        bound = self._bindings.get(port.socket) if port.node == INPUTS else None
        if bound is not None:
            return replace(bound, kind=kind, width=width, space=socket.color_space)
        if not socket.file:
            return None
        folder = self._flat.folders[port.node.removesuffix(INPUTS)]
        return Picture(str(PurePath(folder, socket.file)), socket.layer, kind, width, space=socket.color_space)

    def locate(self, file: str, node: str) -> str:
        """Relative paths start at the folder of the graph file that the node came from."""
        return str(PurePath(self._flat.folders[node], file))


def find_named_files(graph: Graph, bindings: Mapping[str, Picture]) -> list[tuple[str, str, Missing]]:
    """The paths of all pictures that a graph reads, their nodes, and what is shown where a frame has no file.

    Groups are looked into; a path may stand for a sequence.
    """
    if not _names_files(graph, bindings):
        return []
    flat = expand(graph)

    def find_policy(owner: str) -> Missing:
        node = flat.nodes.get(owner)
        if isinstance(node, Reader):
            return node.missing
        group, _, name = owner.rpartition(".")
        return flat.inputs[Port(group, name)].missing if node is None else "error"

    return [
        (picture.path, owner, find_policy(owner))
        for picture, owner in ReferencedPictures(flat, bindings)
        if not picture.in_memory
    ]


def _names_files(graph: Graph, bindings: Mapping[str, Picture]) -> bool:
    """False for a graph that certainly reads no file, which need not be expanded."""
    for name, end in graph.inputs.items():
        if not bindings[name].in_memory if name in bindings else end.file:
            return True
    return _has_source(graph)


def _has_source(graph: Graph) -> bool:
    """True if a node of the graph, or of a group in it, may read a file."""
    return any(
        _has_source(item.graph) if isinstance(item, Group) else isinstance(item, Source)
        for item in graph.nodes.values()
    )


def find_path_texts(graph: Graph) -> dict[str, tuple[str, str]]:
    """Every file that inputs and values of nodes name, by input or value: the text, and the path that it leads to.

    Inputs are `inputs.beauty` or `glow/inputs.image`, values `read.path` or `glow/read.path`; a file of color
    management is `settings.config`.
    """
    flat = expand(graph)
    texts = {
        f"{port}": (end.file, str(PurePath(flat.folders[port.node.removesuffix(INPUTS)], end.file)))
        for port, end in flat.inputs.items()
        if end.file
    }
    for path, node in flat.nodes.items():
        for value in node.values.values():
            if value.type == "path" and (text := str(node.setting(value.name))):
                texts[f"{path}.{value.name}"] = text, str(PurePath(flat.folders[path], text))
    config = graph.settings.color.config
    if config and not config.startswith(BUILT_IN):
        texts[CONFIG] = config, color_settings(graph).config
    return texts
