"""`halation info`: what a picture holds, and what each of its layers is."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson
from .outcome import print_json

if TYPE_CHECKING:
    from ...nodes import Camera
    from ..media.camera import Solved
    from ..media.header import PartHeader
    from ..media.layers import Layer
    from ..media.survey import Survey

_WIDEST = 84
_SHORT = {"float16": "half", "float32": "float"}


def info(
    file: Annotated[Path, typer.Argument(help="A picture.")],
    before: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The same render one frame earlier: it shows which way motion points."),
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Show the parts, layers and metadata of a picture, what each layer of a render is, how its data are meant, and the
    camera."""
    from ..media.survey import survey

    found = survey(file, before)
    if as_json:
        print_json(_facts(found))
    else:
        print("\n".join(_page(found)))
    return 0


def _page(found: Survey) -> Iterator[str]:
    """The whole report, line by line."""
    header = found.header
    width, height = header.info.size
    counts = f"{_count(len(header.parts), 'part')}, {_count(len(header.info.layers), 'layer')}"
    yield f"{header.info.path}\n  {width} x {height}, {header.info.format}, {counts}"
    yield f"  made by {found.maker.renderer or 'an unknown program'}: {found.maker.reason}"
    used = {layer.part for layer in header.info.layers}
    yield from _section("parts", [_part_row(part, part.index in used) for part in header.parts])
    yield from _section("layers", [
        (
            item.layer.name, "".join(item.layer.channels), _SHORT.get(item.layer.format, item.layer.format),
            item.role.words if item.role else "-", item.reason,
        )
        for item in found.passes
    ])
    yield from _section("to be decided", _open_rows(found))
    yield from _section("conventions", [
        (role.words, rule.words, "measured" if rule.measured else "assumed" if rule.kind else "open", rule.reason)
        for role, rule in found.conventions.items()
    ])
    yield from _section("camera", _camera_rows(found))
    yield from _section("metadata", [(name, _line(value)) for name, value in _metadata(found).items()])


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
        (item.layer.name, f"may be {_either([role.words for role in item.candidates])}")
        for item in found.passes if item.role is None and item.candidates
    ]
    rivals = [
        (role.words, f"may be {_either([layer.name for layer in layers])}") for role, layers in found.rivals.items()
    ]
    return rows + rivals


def _camera_rows(found: Survey) -> list[tuple[str, str]]:
    camera, solved = found.camera.camera, found.camera.solved
    if camera is None:
        return [("none", found.camera.reason)]
    across, down = _fields(camera)
    rows = [
        ("found", found.camera.reason), ("eye", _numbers(camera.eye)), ("looks along", _numbers(camera.forward)),
        ("field of view", f"{across:.4g} x {down:.4g} degrees"),
        ("axis meets", f"{_numbers(camera.center)} of the picture"),
    ]
    if solved is not None:
        share = f"{100.0 * solved.share:.3g} % of the pixels that show a surface"
        rows.append(("residual", f"{solved.residual:.1g} px, 99 % below {solved.worst:.1g} px, for {share}"))
    return rows


def _fields(camera: Camera) -> tuple[float, float]:
    """Horizontal and vertical field of view in degrees, as if the axis met the middle."""
    across, down = (math.degrees(2.0 * math.atan(0.5 / focal)) for focal in camera.focal)
    return across, down


def _metadata(found: Survey) -> dict[str, Any]:
    """What the header says that is not about how the file is stored."""
    from ..media.metadata import is_structural

    return {name: value for name, value in found.header.attributes.items() if not is_structural(name)}


def _line(value: object) -> str:
    """A value on one line that is not too long."""
    said = " ".join((_numbers(value) if isinstance(value, tuple) else str(value)).split())
    return said if len(said) <= _WIDEST else f"{said[: _WIDEST - 3]}..."


def _numbers(values: Sequence[object]) -> str:
    return ", ".join(f"{value:.5g}" if isinstance(value, float) else str(value) for value in values)


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def _either(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _facts(found: Survey) -> dict[str, Any]:
    """Everything, for machines."""
    header = found.header
    return {
        "file": header.info.path, "format": header.info.format, "size": list(header.info.size),
        "renderer": found.maker.renderer, "renderer_reason": found.maker.reason,
        "parts": [
            {
                "index": part.index, "name": part.name, "view": part.view, "storage": part.storage,
                "compression": part.compression, "data_window": part.data, "display_window": part.display,
                "channels": dict(zip(part.channels, part.formats, strict=True)), "color_space": part.tag,
            }
            for part in header.parts
        ],
        "layers": [
            {
                **_layer_facts(item.layer), "role": item.role, "grounds": item.grounds.name.lower(),
                "reason": item.reason, "candidates": list(item.candidates),
            }
            for item in found.passes
        ],
        "roles": {role: layer.name if (layer := found.layer(role)) else None for role in found.roles},
        "undecided": {role: [layer.name for layer in layers] for role, layers in found.rivals.items()},
        "conventions": {
            role: {
                "kind": rule.kind, "measured": rule.measured, "reason": rule.reason, "scale": list(rule.scale),
                "offset": list(rule.offset),
            }
            for role, rule in found.conventions.items()
        },
        "camera": _camera_facts(found.camera.camera, found.camera.reason, found.camera.solved),
        "metadata": {name: _plain(value) for name, value in header.attributes.items()},
    }


def _layer_facts(layer: Layer) -> dict[str, Any]:
    return {
        "name": layer.name, "full_name": layer.full, "part": layer.part, "channels": list(layer.channels),
        "type": layer.format, "data": layer.data,
    }


def _camera_facts(camera: Camera | None, reason: str, solved: Solved | None) -> dict[str, Any]:
    if camera is None:
        return {"reason": reason}
    facts = {
        "reason": reason, "rows": list(camera.rows), "eye": camera.eye, "forward": camera.forward,
        "right": camera.right, "down": camera.down, "focal": camera.focal, "center": camera.center,
        "field_of_view": _fields(camera),
    }
    if solved is not None:
        facts |= {"residual_px": solved.residual, "worst_px": solved.worst, "share": solved.share}
    return facts


def _plain(value: object) -> object:
    """A value that JSON has words for: it knows no infinity."""
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    return value if not isinstance(value, float) or math.isfinite(value) else str(value)
