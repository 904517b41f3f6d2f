"""Renaming and removing the inputs, outputs and controls of a graph."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, Protocol, Self

from .model import Input, Output, Port
from .names import check_name, pick
from .notes import move_keys, move_layout, rename_key, without
from .relink import move_links

EndSection = Literal["inputs", "outputs", "controls"]


class _Ends(Protocol):
    """The fields of a graph that name its inputs, outputs and controls."""

    @property
    def links(self) -> Mapping[Port, Port]: ...
    @property
    def ui(self) -> Mapping[str, Any]: ...
    @property
    def extra(self) -> Mapping[str, Mapping[str, Any]]: ...


def move_end(graph: _Ends, section: EndSection, old: str, new: str | None) -> dict[str, Any]:
    """The fields of a graph that change when an input, output or control is renamed, or removed if `new` is None.

    Its links, layout and unknown keys are renamed or removed too.
    """
    ends: Mapping[str, Any] = getattr(graph, section)
    pick(ends, old, f"the graph has no {section[:-1]}")
    other_ends, port = without(ends, old), Port(section, old)
    if new is None:
        ends, links = other_ends, {end: start for end, start in graph.links.items() if port not in (end, start)}
    else:
        check_name(new, section[:-1], other_ends)
        ends, links = rename_key(ends, old, new), move_links(graph.links, {port: Port(section, new)})
    place, new_place = f"{section}.{old}", f"{section}.{new}" if new else ""
    ui, extra = move_layout(graph.ui, place, new_place), move_keys(graph.extra, place, new_place)
    return {section: ends, "links": links, "ui": ui, "extra": extra}


class EndEdits:
    """The edits of a graph that add, rename and remove its inputs and outputs, and remove its controls."""

    inputs: Mapping[str, Input]
    outputs: Mapping[str, Output]
    links: Mapping[Port, Port]
    ui: Mapping[str, Any]
    extra: Mapping[str, Mapping[str, Any]]

    def add_input(self, name: str, input: Input) -> Self:
        """A graph with one more input."""
        check_name(name, "input", self.inputs)
        return self._with(inputs={**self.inputs, name: input})

    def add_output(self, name: str, output: Output) -> Self:
        """A graph with one more output."""
        check_name(name, "output", self.outputs)
        return self._with(outputs={**self.outputs, name: output})

    def remove_input(self, name: str) -> Self:
        """A graph without an input and its links."""
        return self._move_end("inputs", name)

    def remove_output(self, name: str) -> Self:
        """A graph without an output and its link."""
        return self._move_end("outputs", name)

    def remove_control(self, name: str) -> Self:
        """A graph without a control; its value keeps its setting."""
        return self._move_end("controls", name)

    def rename_input(self, old: str, new: str) -> Self:
        """A graph where an input has another name; links follow."""
        return self._move_end("inputs", old, new)

    def rename_output(self, old: str, new: str) -> Self:
        """A graph where an output has another name; its link follows."""
        return self._move_end("outputs", old, new)

    def _move_end(self, section: EndSection, old: str, new: str | None = None) -> Self:
        return self._with(**move_end(self, section, old, new))

    def _with(self, **changes: Any) -> Self:
        raise NotImplementedError
