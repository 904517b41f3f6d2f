"""Commands for keys and expressions: values that change over time.

Ports are those of the graph that the user sees. A value of a group's body may be animated as a control outside of the
group; then it cannot be animated inside too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from halation.nodes import Scalar

from ...errors import GraphError
from ...graph import Animation, Expression, Graph, Key, Keys, Port
from ...graph.frames import list_range
from ...language.translation import translate
from ..edits.elements import clean_text
from ..edits.values import find_expression_fault
from ..state.open_document import OpenDocument
from .command import EditCommand, Edited


class SetKey(EditCommand[None], frozen=True):
    """Set a key at the current frame, with the current value unless another one is given."""

    port: Port
    value: object = None
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        check_not_animated_outside(document, self.port)
        before = document.graph.animation.get(self.port)
        if isinstance(before, Expression):
            raise GraphError(
                translate("{port} follows an expression: bake it into keys, or remove it first", port=self.port)
            )
        keys = before or Keys()
        if self.value is not None:
            keys = keys.set(document.time.frame, to_scalar(self.value))
        elif keys.keys:
            keys = keys.insert(document.time.frame)
        else:
            keys = keys.set(document.time.frame, to_scalar(document.time.evaluate(self.port)))
        graph = document.graph.animate(self.port, keys)
        for point in graph.keyed_points.get(self.port, {}).values():  # a key of a spline holds all of its points
            if isinstance(own := graph.animation[point], Keys):
                graph = graph.animate(point, own.insert(document.time.frame))
        return Edited(translate("Key {port}", port=self.port), None, graph, merge=self.merge)


class RemoveKey(EditCommand[None], frozen=True):
    """Remove the key at the current frame. After the last one the value stays as it is."""

    port: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        keys = document.graph.animation.get(self.port)
        if not isinstance(keys, Keys) or keys.key(document.time.frame) is None:
            raise GraphError(translate("{port} has no key at frame {frame}", port=self.port, frame=document.time.frame))
        graph = _animate(document, document.graph, self.port, keys.remove(document.time.frame))
        return Edited(translate("Remove a key of {port}", port=self.port), None, graph)


class ToggleKey(EditCommand[None], frozen=True):
    """Set or remove the key at the current frame."""

    port: Port

    def apply(self, document: OpenDocument) -> Edited[None]:
        command = SetKey(self.port) if document.time.find_key(self.port) is None else RemoveKey(self.port)
        return command.apply(document)


class AnimateValue(EditCommand[None], frozen=True):
    """Animate a value; without an animation it keeps its number at the current frame."""

    port: Port
    animation: Animation | None
    label: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        return AnimateValues({self.port: self.animation}, self.label, self.merge).apply(document)


class AnimateValues(EditCommand[None], frozen=True):
    """Animate several values, as one step."""

    animations: Mapping[Port, Animation | None]
    label: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        graph = document.graph
        for port, animation in self.animations.items():
            graph = _animate(document, graph, port, animation)
        return Edited(self.label, None, graph, merge=self.merge)


class SetExpression(EditCommand[None], frozen=True):
    """Drive a value by an expression; a leading `=` is ignored. Without text the value keeps its current number."""

    port: Port
    text: str
    merge: str = ""

    def apply(self, document: OpenDocument) -> Edited[None]:
        check_not_animated_outside(document, self.port)
        text = clean_text(self.text).strip().removeprefix("=").strip()
        if text and (fault := find_expression_fault(document.graph, self.port, text)):
            raise GraphError(fault)
        graph = _animate(document, document.graph, self.port, Expression(text) if text else None)
        return Edited(translate("Expression of {port}", port=self.port), None, graph, merge=self.merge)


class BakeKeys(EditCommand[None], frozen=True):
    """Set a key with the current result of the value at each of these frames, by default at all frames of the range."""

    port: Port
    frames: Iterable[int] | None = None

    def apply(self, document: OpenDocument) -> Edited[None]:
        check_not_animated_outside(document, self.port)
        first, last = document.time.frames
        frames = list_range(first, last) if self.frames is None else tuple(self.frames)
        if not frames:
            raise GraphError(translate("{port}: there are no frames to bake", port=self.port))
        values = {frame: to_scalar(document.time.evaluate(self.port, frame)) for frame in frames}
        keys = (
            Key(frame, plain, "constant" if isinstance(plain, bool) else "linear") for frame, plain in values.items()
        )
        return Edited(
            translate("Bake {port}", port=self.port), None, document.graph.animate(self.port, Keys(tuple(keys)))
        )


def add_key(document: OpenDocument, port: Port, value: object) -> Keys | None:
    """The keys of a value with one at the current frame; None if it has none. Raises GraphError for an expression."""
    check_not_animated_outside(document, port)
    before = document.graph.animation.get(port)
    if isinstance(before, Expression):
        raise GraphError(translate("{port} follows an expression: edit it, or remove it first", port=port))
    return before and before.set(document.time.frame, to_scalar(value))


def check_not_animated_outside(document: OpenDocument, port: Port) -> None:
    """Raise GraphError for a value that is animated as a control of the group around it."""
    if outer := document.time.find_outer_animation(port):
        where = "/".join(outer[0]) or translate("the graph outside")
        raise GraphError(
            translate(
                "{port} is animated as '{control}' in {where}: change it there",
                port=port,
                control=outer[1],
                where=where,
            )
        )


def _animate(document: OpenDocument, graph: Graph, port: Port, animation: Animation | None) -> Graph:
    """The graph with a value animated; without an animation the value stays as it is at the current frame, if any."""
    if animation is not None and not (isinstance(animation, Keys) and not animation.keys):
        return graph.animate(port, animation)
    if port not in graph.animation:
        return graph
    own = {point: graph.animation[point] for point in graph.keyed_points.get(port, {}).values()}
    try:
        graph = graph.set(port, document.time.evaluate(port))
    except GraphError:
        return graph.animate(port, None)
    return replace(graph, animation={**graph.animation, **own}) if own else graph


def to_scalar(value: object) -> Scalar:
    """A value as a key holds it. Raises GraphError for a value that keys cannot have."""
    if isinstance(value, list | tuple):
        return tuple(float(part) for part in value)
    if isinstance(value, bool | int | float | str):
        return value
    raise GraphError(translate("{value!r} cannot be a key: set a number, or a list of numbers", value=value))
