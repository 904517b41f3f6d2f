"""The report on a render, in rows of words: for the command line and for the editor."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import cast

from halation.nodes import CameraModel

from ..media.color_spaces import describe_color_spaces
from ..media.header import PartHeader
from ..media.metadata import is_structural
from .analysis import RenderAnalysis, RenderCamera
from .conventions import Convention

_WIDEST = 84
"""Letters of an attribute in the report. Chosen by judgement: with its name it fits into 120 columns."""

_SHORT = {"float16": "half", "float32": "float"}


def format_report(analysis: RenderAnalysis) -> Iterator[str]:
    """The whole report, line by line, in columns."""
    yield f"{analysis.header.info.path}\n  {describe_size(analysis)}"
    yield f"  {describe_maker(analysis)}"
    yield from _format_section("parts", list_parts(analysis))
    yield from _format_section(
        "layers",
        [
            (
                item.layer.name,
                "".join(item.layer.channels),
                _SHORT.get(item.layer.format, item.layer.format),
                item.role.words if item.role else "-",
                item.reason,
            )
            for item in analysis.passes
        ],
    )
    yield from _format_section("color", describe_color_spaces(analysis.header.info.path, sandbox=analysis.sandbox))
    yield from _format_section("to be decided", _list_open_questions(analysis))
    yield from _format_section(
        "conventions",
        [
            (role.words, rule.words, describe_certainty(rule), rule.reason)
            for role, rule in analysis.conventions.items()
        ],
    )
    yield from _format_section("camera", list_camera(analysis.camera))
    yield from _format_section("metadata", [(name, _shorten(value)) for name, value in list_metadata(analysis)])


def describe_size(analysis: RenderAnalysis) -> str:
    """Size, format, and how many parts and layers."""
    info = analysis.header.info
    counts = f"{_format_count(len(analysis.header.parts), 'part')}, {_format_count(len(info.layers), 'layer')}"
    shape = f", pixel aspect {info.pixel_aspect:g}" if info.pixel_aspect != 1.0 else ""
    return f"{info.size[0]} x {info.size[1]}{shape}, {info.format}, {counts}"


def describe_maker(analysis: RenderAnalysis) -> str:
    """The renderer, and the reason."""
    return f"made by {analysis.maker.renderer or 'an unknown program'}: {analysis.maker.reason}"


def list_parts(analysis: RenderAnalysis) -> list[tuple[str, ...]]:
    """The parts: number, name, channels, types, compression, storage, color space, window, why it was left out."""
    used = {layer.part for layer in analysis.header.info.layers}
    return [_describe_part(part, part.index in used) for part in analysis.header.parts]


def list_metadata(analysis: RenderAnalysis) -> list[tuple[str, str]]:
    """Attributes of the header that do not describe how the file is stored, one per line."""
    attributes = analysis.header.attributes.items()
    return [(name, " ".join(_format_value(value).split())) for name, value in attributes if not is_structural(name)]


def describe_certainty(rule: Convention) -> str:
    """How certain a convention is."""
    return "measured" if rule.is_measured else "assumed" if rule.kind else "open"


def join_choices(words: Sequence[str]) -> str:
    """The row of a convention."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _format_section(title: str, rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """A heading, and rows with aligned columns, without empty columns; nothing if there are no rows."""
    if not rows:
        return
    yield f"\n{title}"
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = [f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True) if width]
        yield f"  {'  '.join(cells)}".rstrip()


def _describe_part(part: PartHeader, used: bool) -> tuple[str, ...]:
    channels = " ".join(name.rpartition(".")[2] for name in part.channels)
    channels_text = channels if len(part.channels) <= 4 else f"{len(part.channels)} channels"
    types = "/".join(dict.fromkeys(part.formats))
    window = "" if part.data == part.display else f"data {_format_window(part.data)} of {_format_window(part.display)}"
    name = f"{part.name} ({part.view})" if part.view else part.name
    left_out = "" if used else "left out: of another size"
    return str(part.index), name, channels_text, types, part.compression, part.storage, part.tag, window, left_out


def _format_window(window: tuple[int, int, int, int]) -> str:
    left, top, width, height = window
    return f"{width}x{height}{left:+}{top:+}"


def _list_open_questions(analysis: RenderAnalysis) -> list[tuple[str, str]]:
    """Choices that the user has to make: layers with several possible roles, and roles with several layers."""
    rows = [
        (item.layer.name, f"may be {join_choices([role.words for role in item.candidates])}")
        for item in analysis.passes
        if item.role is None and item.candidates
    ]
    rivals = [
        (role.words, f"may be {join_choices([layer.name for layer in layers])}")
        for role, layers in analysis.rivals.items()
    ]
    return rows + rivals


def list_camera(render_camera: RenderCamera) -> list[tuple[str, str]]:
    """The camera, and its precision."""
    camera, solved = render_camera.camera, render_camera.solution
    if camera is None:
        return [("none", render_camera.reason)]
    across, down = measure_field_of_view(camera)
    rows = [
        ("found", render_camera.reason),
        ("eye", _format_numbers(camera.eye)),
        ("looks along", _format_numbers(camera.forward)),
        ("field of view", f"{across:.4g} x {down:.4g} degrees"),
        ("axis meets", f"{_format_numbers(camera.center)} of the picture"),
    ]
    if solved is not None:
        share = f"{100.0 * solved.share:.3g} % of the pixels that show a surface"
        rows.append(("residual", f"{solved.residual:.1g} px, 99 % below {solved.worst:.1g} px, for {share}"))
    return rows


def measure_field_of_view(camera: CameraModel) -> tuple[float, float]:
    """Horizontal and vertical field of view in degrees, as if the axis met the center."""
    across, down = (math.degrees(2.0 * math.atan(0.5 / focal)) for focal in camera.focal)
    return across, down


def _shorten(text: str) -> str:
    """A line, shortened if it is too long."""
    return text if len(text) <= _WIDEST else f"{text[: _WIDEST - 3]}..."


def _format_value(value: object) -> str:
    return _format_numbers(cast("tuple[object, ...]", value)) if isinstance(value, tuple) else str(value)


def _format_numbers(values: Sequence[object]) -> str:
    return ", ".join(f"{value:.5g}" if isinstance(value, float) else str(value) for value in values)


def _format_count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
