"""What there is to say of a render, in rows of words: for the command line and for the editor."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import cast

from halation.nodes import Camera

from ..media.color_spaces import describe_color_spaces
from ..media.header import PartHeader
from ..media.metadata import is_structural
from .analysis import FoundCamera, Survey
from .conventions import Convention

_WIDEST = 84
_SHORT = {"float16": "half", "float32": "float"}


def report(found: Survey) -> Iterator[str]:
    """All of it, line by line, in columns."""
    yield f"{found.header.info.path}\n  {size_line(found)}"
    yield f"  {maker_line(found)}"
    yield from _section("parts", part_rows(found))
    yield from _section(
        "layers",
        [
            (
                item.layer.name,
                "".join(item.layer.channels),
                _SHORT.get(item.layer.format, item.layer.format),
                item.role.words if item.role else "-",
                item.reason,
            )
            for item in found.passes
        ],
    )
    yield from _section("color", describe_color_spaces(found.header.info.path))
    yield from _section("to be decided", _open_rows(found))
    yield from _section(
        "conventions",
        [(role.words, rule.words, certainty(rule), rule.reason) for role, rule in found.conventions.items()],
    )
    yield from _section("camera", camera_rows(found.camera))
    yield from _section("metadata", [(name, _shortened(value)) for name, value in metadata_rows(found)])


def size_line(found: Survey) -> str:
    """Size, format, and how many parts and layers."""
    info = found.header.info
    counts = f"{_count(len(found.header.parts), 'part')}, {_count(len(info.layers), 'layer')}"
    return f"{info.size[0]} x {info.size[1]}, {info.format}, {counts}"


def maker_line(found: Survey) -> str:
    """Who made it, and how that is known."""
    return f"made by {found.maker.renderer or 'an unknown program'}: {found.maker.reason}"


def part_rows(found: Survey) -> list[tuple[str, ...]]:
    """The parts: number, name, channels, types, compression, storage, color space, window, why it was left out."""
    used = {layer.part for layer in found.header.info.layers}
    return [_part_row(part, part.index in used) for part in found.header.parts]


def metadata_rows(found: Survey) -> list[tuple[str, str]]:
    """What the header says that is not about how the file is stored, each on one line."""
    said = found.header.attributes.items()
    return [(name, " ".join(_text(value).split())) for name, value in said if not is_structural(name)]


def certainty(rule: Convention) -> str:
    """How sure a convention is."""
    return "measured" if rule.measured else "assumed" if rule.kind else "open"


def either(words: Sequence[str]) -> str:
    """One of them."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _section(title: str, rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """A heading, and rows under it whose columns line up, empty ones left out; nothing at all without rows."""
    if not rows:
        return
    yield f"\n{title}"
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = [f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True) if width]
        yield f"  {'  '.join(cells)}".rstrip()


def _part_row(part: PartHeader, used: bool) -> tuple[str, ...]:
    channels = " ".join(name.rpartition(".")[2] for name in part.channels)
    what = channels if len(part.channels) <= 4 else f"{len(part.channels)} channels"
    types = "/".join(dict.fromkeys(part.formats))
    window = "" if part.data == part.display else f"data {_window(part.data)} of {_window(part.display)}"
    name = f"{part.name} ({part.view})" if part.view else part.name
    left_out = "" if used else "left out: of another size"
    return str(part.index), name, what, types, part.compression, part.storage, part.tag, window, left_out


def _window(window: tuple[int, int, int, int]) -> str:
    left, top, width, height = window
    return f"{width}x{height}{left:+}{top:+}"


def _open_rows(found: Survey) -> list[tuple[str, str]]:
    """What a user has to say: layers that may be several things, and roles that several layers claim."""
    rows = [
        (item.layer.name, f"may be {either([role.words for role in item.candidates])}")
        for item in found.passes
        if item.role is None and item.candidates
    ]
    rivals = [
        (role.words, f"may be {either([layer.name for layer in layers])}") for role, layers in found.rivals.items()
    ]
    return rows + rivals


def camera_rows(found: FoundCamera) -> list[tuple[str, str]]:
    """The camera, and how exactly it was found."""
    camera, solved = found.camera, found.solved
    if camera is None:
        return [("none", found.reason)]
    across, down = field_of_view(camera)
    rows = [
        ("found", found.reason),
        ("eye", _numbers(camera.eye)),
        ("looks along", _numbers(camera.forward)),
        ("field of view", f"{across:.4g} x {down:.4g} degrees"),
        ("axis meets", f"{_numbers(camera.center)} of the picture"),
    ]
    if solved is not None:
        share = f"{100.0 * solved.share:.3g} % of the pixels that show a surface"
        rows.append(("residual", f"{solved.residual:.1g} px, 99 % below {solved.worst:.1g} px, for {share}"))
    return rows


def field_of_view(camera: Camera) -> tuple[float, float]:
    """Horizontal and vertical field of view in degrees, as if the axis met the middle."""
    across, down = (math.degrees(2.0 * math.atan(0.5 / focal)) for focal in camera.focal)
    return across, down


def _shortened(said: str) -> str:
    """A line that is not too long."""
    return said if len(said) <= _WIDEST else f"{said[: _WIDEST - 3]}..."


def _text(value: object) -> str:
    return _numbers(cast("tuple[object, ...]", value)) if isinstance(value, tuple) else str(value)


def _numbers(values: Sequence[object]) -> str:
    return ", ".join(f"{value:.5g}" if isinstance(value, float) else str(value) for value in values)


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
