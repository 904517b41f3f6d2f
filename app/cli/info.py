"""`halation info`: what a picture holds, and what each of its layers is."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson
from .outcome import print_json

if TYPE_CHECKING:
    from halation.nodes import CameraModel

    from ..media.layers import Layer
    from ..media.sequences import FrameSequence
    from ..render_layers.analysis import RenderAnalysis
    from ..render_layers.camera import CameraSolution


def info(
    file: Annotated[Path, typer.Argument(help="A picture, a sequence such as shot.####.exr, or its folder.")],
    before: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="The same render one frame earlier: it shows which way motion points."),
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Show the parts, layers and metadata of a picture, what each layer of a render is, how its data are meant, and the
    camera."""
    from ..media.sequences import check_has_files, find_sequence
    from ..render_layers.analysis import analyze_render
    from ..render_layers.report import format_report

    shot = find_sequence(str(file))
    if shot is not None:
        check_has_files(shot)
    survey_result = analyze_render(shot.path(shot.frames[0]) if shot else file, before)
    if as_json:
        print_json({**(_shot_facts(shot) if shot else {}), **_facts(survey_result)})
        return 0
    head, gap, rest = "\n".join(format_report(survey_result)).partition("\n\n")
    print(f"{_shot_lines(shot)}\n\n{head}" if shot else f"{head}{_neighbors(str(file))}", rest, sep=gap)
    return 0


def _shot_lines(shot: FrameSequence) -> str:
    """A sequence: how many frames, which, and what is missing between them."""
    lines = [shot.pattern.text, f"  {_frames(shot)}"]
    return "\n".join([*lines, f"  {shot.missing} missing: {shot.gaps_text}"] if shot.missing else lines)


def _neighbors(path: str) -> str:
    """A line for a picture that is one of a sequence, else nothing."""
    from ..media.sequences import find_sequence, suggest_pattern

    pattern = suggest_pattern(path)
    shot = find_sequence(pattern) if pattern else None
    return f"\n  one of {len(shot.frames)} frames of {shot.pattern.text}: {shot.frames_text}" if shot else ""


def _frames(shot: FrameSequence) -> str:
    count = len(shot.frames)
    return f"{count} frame{'s' if count > 1 else ''}: {shot.frames_text}"


def _shot_facts(shot: FrameSequence) -> dict[str, Any]:
    return {
        "sequence": {
            "pattern": shot.pattern.text,
            "count": len(shot.frames),
            "first": shot.frames[0],
            "last": shot.frames[-1],
            "frames": list(shot.frames),
            "gaps": [list(gap) for gap in shot.gaps],
            "missing": shot.missing,
        }
    }


def _facts(survey: RenderAnalysis) -> dict[str, Any]:
    """Everything, for machines."""
    from ..media.color_spaces import describe_color_spaces

    header = survey.header
    return {
        "file": header.info.path,
        "format": header.info.format,
        "size": list(header.info.size),
        "renderer": survey.maker.renderer,
        "renderer_reason": survey.maker.reason,
        "parts": [
            {
                "index": part.index,
                "name": part.name,
                "view": part.view,
                "storage": part.storage,
                "compression": part.compression,
                "data_window": part.data,
                "display_window": part.display,
                "channels": dict(zip(part.channels, part.formats, strict=True)),
                "color_space": part.tag,
            }
            for part in header.parts
        ],
        "layers": [
            {
                **_layer_facts(item.layer),
                "role": item.role,
                "grounds": item.grounds.name.lower(),
                "reason": item.reason,
                "candidates": list(item.candidates),
            }
            for item in survey.passes
        ],
        "color_spaces": [list(row) for row in describe_color_spaces(header.info.path)],
        "roles": {role: layer.name if (layer := survey.find_layer(role)) else None for role in survey.roles},
        "undecided": {role: [layer.name for layer in layers] for role, layers in survey.rivals.items()},
        "conventions": {
            role: {
                "kind": rule.kind,
                "measured": rule.is_measured,
                "reason": rule.reason,
                "scale": list(rule.scale),
                "offset": list(rule.offset),
            }
            for role, rule in survey.conventions.items()
        },
        "camera": _camera_facts(survey.camera.camera, survey.camera.reason, survey.camera.solution),
        "metadata": {name: _plain(value) for name, value in header.attributes.items()},
    }


def _layer_facts(layer: Layer) -> dict[str, Any]:
    return {
        "name": layer.name,
        "full_name": layer.full_name,
        "part": layer.part,
        "channels": list(layer.channels),
        "type": layer.format,
        "data": layer.is_data,
    }


def _camera_facts(camera: CameraModel | None, reason: str, solved: CameraSolution | None) -> dict[str, Any]:
    if camera is None:
        return {"reason": reason}
    from ..render_layers.report import measure_field_of_view

    facts = {
        "reason": reason,
        "rows": list(camera.rows),
        "eye": camera.eye,
        "forward": camera.forward,
        "right": camera.right,
        "down": camera.down,
        "focal": camera.focal,
        "center": camera.center,
        "field_of_view": measure_field_of_view(camera),
    }
    if solved is not None:
        facts |= {"residual_px": solved.residual, "worst_px": solved.worst, "share": solved.share}
    return facts


def _plain(value: object) -> object:
    """A value that JSON has words for: it knows no infinity."""
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    return value if not isinstance(value, float) or math.isfinite(value) else str(value)
