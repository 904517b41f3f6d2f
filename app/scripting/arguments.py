"""The arguments of the Python interface, checked before anything is made of them.

What is wrong is a UsageError, a HalationError with one sentence. A missing argument, or a keyword that no function has,
is a TypeError, as Python raises it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import GraphError, UsageError
from ..resources.picture import MAX_SIDE

if TYPE_CHECKING:
    import numpy as np

    from ..graph import Graph, Port

_SHOWN_CHARACTERS = 60
"""How much of an argument a message repeats."""


def describe_object(item: object) -> str:
    """What an argument is, for a sentence: its text on one line, shortened, or only its type."""
    if item is None or isinstance(item, str | bytes | int | float | complex | tuple | list):
        try:
            text = ascii(item) if isinstance(item, str | bytes) else repr(item)
        except (ValueError, RecursionError):  # a number of too many digits, or a list in itself
            return f"a {type(item).__name__}"
        if len(text) <= _SHOWN_CHARACTERS and text.isprintable():
            return text
    return f"a {type(item).__name__}"


def check_graph(graph: object) -> Graph:
    """A graph that holds what a graph may hold. Raises UsageError."""
    from ..graph import Graph

    if not isinstance(graph, Graph):
        raise UsageError(f"graph: give a Graph, such as load returns, not {describe_object(graph)}")
    for name, keys, parts in _list_section_types():
        for key, part in getattr(graph, name).items():
            if not isinstance(key, keys) or not isinstance(part, parts):
                where = f"{describe_object(key)}: {describe_object(part)}"
                raise UsageError(f"graph: its {name} cannot hold {where}")
    first, last = graph.settings.frames or (1, 1)
    if last < first:
        raise GraphError(f"the frames {first} to {last} of the graph run backwards: exchange the two")
    return graph


@cache
def _list_section_types() -> tuple[tuple[str, type, tuple[type, ...]], ...]:
    """The sections of a graph, and the types of their keys and entries."""
    from halation.nodes import Node

    from ..graph import Control, Expression, Group, Input, Keys, Output, Port, Unknown

    return (
        ("nodes", str, (Node, Group, Unknown)),
        ("links", Port, (Port,)),
        ("inputs", str, (Input,)),
        ("outputs", str, (Output,)),
        ("controls", str, (Control,)),
        ("animation", Port, (Keys, Expression)),
    )


def check_text(name: str, text: object) -> str:
    """A string. Raises UsageError."""
    if not isinstance(text, str):
        raise UsageError(f"{name}: give a string, not {describe_object(text)}")
    return text


def check_target(graph: Graph, node: object) -> dict[str, Port]:
    """What `render` is asked for by the `node` (`id` or `id.output`), by that name; empty for all outputs."""
    from ..graph import find_node_output

    name = check_text("node", node)
    return {name: find_node_output(graph, name)} if name else {}


def check_choice(name: str, text: object, words: tuple[str, ...]) -> Any:
    """One of these words. Raises UsageError."""
    if not isinstance(text, str) or text not in words:
        raise UsageError(f"{name}: give {' or '.join(map(repr, words))}, not {describe_object(text)}")
    return text


def check_path(name: str, path: object) -> Path:
    """A path that a system can have. Raises UsageError."""
    if not isinstance(path, str | Path):
        raise UsageError(f"{name}: give a path, not {describe_object(path)}")
    text = str(path)
    if not text or "\0" in text:
        raise UsageError(f"{name}: {describe_object(text)} is not a path")
    return Path(path)


def check_mapping(name: str, mapping: object) -> dict[str, Any]:
    """A mapping by names; None is an empty one. Raises UsageError."""
    if mapping is None:
        return {}
    if not isinstance(mapping, Mapping):
        raise UsageError(f"{name}: give a dict by names, not {describe_object(mapping)}")
    entries: dict[Any, Any] = dict(mapping)  # pyright: ignore[reportUnknownArgumentType]
    for key in entries:
        check_text(f"{name}, {describe_object(key)}", key)
    return entries


def check_frame_number(frame: object) -> int:
    """A whole number of at most nine digits. Raises UsageError."""
    from ..graph.frames import check_frame

    return check_frame(_whole_number("frame", frame))


def check_frame_numbers(frames: object) -> Iterator[int]:
    """Frames one after the other, as they are taken from any iterable. Raises UsageError."""
    if isinstance(frames, str | bytes) or not isinstance(frames, Iterable):
        raise UsageError(f"frames: give whole numbers, such as range(1, 25), not {describe_object(frames)}")
    return (check_frame_number(frame) for frame in frames)  # pyright: ignore[reportUnknownVariableType]


def check_size(size: object) -> tuple[int, int] | None:
    """Width and height in pixels, or None. Raises UsageError."""
    if size is None:
        return None
    sides: tuple[Any, ...] = tuple(size) if isinstance(size, tuple | list) else ()  # pyright: ignore
    if len(sides) != 2:
        raise UsageError(f"size: give width and height as two whole numbers, not {describe_object(size)}")
    width, height = (_whole_number("size", side) for side in sides)
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
        raise UsageError(f"size {width}x{height}: give width and height in pixels, at least 1 and at most {MAX_SIDE:,}")
    return width, height


def check_scale(scale: object) -> float:
    """A number above 0 and up to 1. Raises UsageError."""
    if isinstance(scale, bool) or not isinstance(scale, int | float):
        try:
            number: Any = getattr(scale, "item", lambda: None)() if getattr(scale, "shape", None) == () else None
        except Exception:  # an object of anybody's
            number = None
        if isinstance(number, bool) or not isinstance(number, int | float):
            raise UsageError(f"scale: give a number above 0 and up to 1, not {describe_object(scale)}")
        scale = number
    if not 0.0 < scale <= 1.0:
        words = f"{scale:g}" if isinstance(scale, float) else describe_object(scale)
        raise UsageError(f"scale {words}: give a number above 0 and up to 1")
    return float(scale)


def check_inputs(inputs: object) -> dict[str, Any]:
    """What is bound to graph inputs, by name: paths, arrays, numbers, and functions that make these for a frame."""
    return {
        name: _check_function(name, item) if callable(item) else check_binding(name, item)
        for name, item in check_mapping("inputs", inputs).items()
    }


def check_binding(name: str, item: object) -> Any:
    """What fills a graph input: a path, an array of numbers, a number or several. Raises UsageError."""
    if isinstance(item, str | Path):
        check_path(f"input '{name}'", item)
        return item
    return item if isinstance(item, float) else as_array(f"input '{name}'", item)


def as_array(name: str, item: object) -> np.ndarray:
    """An array of numbers. Raises UsageError."""
    import numpy as np

    try:
        array = np.asarray(item)
    except Exception:  # of a list of lists of several lengths, or an object of anybody's
        array = np.asarray(None)
    if array.dtype.kind not in "fiub":
        shape = f"{array.dtype} {list(array.shape)}" if array.ndim else describe_object(item)
        raise UsageError(f"{name}: give an array of numbers as [height, width, channels], or a path, not {shape}")
    return array


def _check_function(name: str, function: Callable[[int], object]) -> Callable[[int], Any]:
    return lambda frame: check_binding(name, function(frame))


def _whole_number(name: str, number: object) -> int:
    if isinstance(number, bool):
        raise UsageError(f"{name}: give whole numbers, not {number}")
    try:
        return index(number)  # pyright: ignore[reportArgumentType]
    except Exception:  # TypeError, or anything from an object of anybody's
        raise UsageError(f"{name}: give whole numbers, not {describe_object(number)}") from None
