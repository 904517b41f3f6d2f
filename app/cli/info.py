"""`halation info`: what a picture file holds, and what each of its layers is; what a graph takes and gives."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..resources.sandbox import Sandbox
from .graph_facts import find_graph_facts, format_graph_facts
from .options import AsJson, expand_preset
from .outcome import print_json

if TYPE_CHECKING:
    from halation.nodes import CameraModel

    from ..media.header import PartHeader
    from ..media.layers import Layer
    from ..media.sequences import FrameSequence
    from ..render_layers.analysis import RenderAnalysis
    from ..render_layers.camera import CameraSolution


def info(
    file: Annotated[
        Path,
        typer.Argument(
            help="A picture, a sequence such as shot.####.exr, the folder of one, a graph, or the name of a preset.",
        ),
    ],
    before: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="The same render one frame earlier; it shows which way motion vectors point."
        ),
    ] = None,
    as_json: AsJson = False,
    *,
    sandbox: Sandbox,
) -> int:
    """Show the layers of a picture, or the controls of a graph.

    For a render it also shows what each layer is (color, depth, normal, ...) and the conventions of its data.
    """
    graph = expand_preset(str(file))
    if graph.suffix.lower() == ".json":
        facts = find_graph_facts(graph, sandbox)
        print_json(facts) if as_json else print(format_graph_facts({**facts, "graph": str(file)}))
        return 0
    from ..media.sequences import check_has_files, find_sequence
    from ..render_layers.analysis import analyze_render
    from ..render_layers.report import format_report

    sequence = find_sequence(str(file), sandbox=sandbox)
    if sequence is not None:
        check_has_files(sequence, sandbox=sandbox)
    analysis = analyze_render(sequence.path(sequence.frames[0]) if sequence else file, before, sandbox=sandbox)
    if as_json:
        print_json({**(_sequence_facts(sequence) if sequence else {}), **_analysis_facts(analysis, sandbox=sandbox)})
        return 0
    first_block, gap, rest = "\n".join(format_report(analysis)).partition("\n\n")
    print(
        f"{_format_sequence(sequence)}\n\n{first_block}"
        if sequence
        else f"{first_block}{_describe_neighbors(str(file), sandbox=sandbox)}",
        rest,
        sep=gap,
    )
    return 0


def _format_sequence(sequence: FrameSequence) -> str:
    """Lines about a sequence: its pattern, its frames, and the frames missing between them."""
    lines = [sequence.pattern.text, f"  {_describe_frames(sequence)}"]
    return "\n".join([*lines, f"  {sequence.missing} missing: {sequence.gaps_text}"] if sequence.missing else lines)


def _describe_neighbors(path: str, sandbox: Sandbox) -> str:
    """A line about the sequence that a picture is part of; empty for a single picture."""
    from ..media.sequences import find_sequence, suggest_pattern

    pattern = suggest_pattern(path, sandbox=sandbox)
    sequence = find_sequence(pattern, sandbox=sandbox) if pattern else None
    return (
        f"\n  one of {len(sequence.frames)} frames of {sequence.pattern.text}: {sequence.frames_text}"
        if sequence
        else ""
    )


def _describe_frames(sequence: FrameSequence) -> str:
    count = len(sequence.frames)
    return f"{count} frame{'s' if count > 1 else ''}: {sequence.frames_text}"


def _sequence_facts(sequence: FrameSequence) -> dict[str, Any]:
    return {
        "sequence": {
            "pattern": sequence.pattern.text,
            "count": len(sequence.frames),
            "first": sequence.frames[0],
            "last": sequence.frames[-1],
            "frames": list(sequence.frames),
            "gaps": [list(gap) for gap in sequence.gaps],
            "missing": sequence.missing,
        }
    }


def _analysis_facts(analysis: RenderAnalysis, sandbox: Sandbox) -> dict[str, Any]:
    """All facts about a picture, as JSON."""
    from ..media.color_spaces import describe_color_spaces

    header = analysis.header
    return {
        "file": header.info.path,
        "format": header.info.format,
        "size": list(header.info.size),
        "pixel_aspect": header.info.pixel_aspect,
        "renderer": analysis.maker.renderer,
        "renderer_reason": analysis.maker.reason,
        "parts": [_part_facts(part) for part in header.parts],
        "layers": [
            {
                **_layer_facts(item.layer),
                "role": item.role,
                "grounds": item.grounds.name.lower(),
                "reason": item.reason,
                "candidates": list(item.candidates),
            }
            for item in analysis.passes
        ],
        "color_spaces": [list(row) for row in describe_color_spaces(header.info.path, sandbox=sandbox)],
        "roles": {role: layer.name if (layer := analysis.find_layer(role)) else None for role in analysis.roles},
        "undecided": {role: [layer.name for layer in layers] for role, layers in analysis.rivals.items()},
        "conventions": {
            role: {
                "kind": rule.kind,
                "measured": rule.is_measured,
                "reason": rule.reason,
                "scale": list(rule.scale),
                "offset": list(rule.offset),
            }
            for role, rule in analysis.conventions.items()
        },
        "camera": _camera_facts(analysis.camera.camera, analysis.camera.reason, analysis.camera.solution),
        "metadata": {name: _make_json_safe(value) for name, value in header.attributes.items()},
    }


def _part_facts(part: PartHeader) -> dict[str, Any]:
    return {
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


def _make_json_safe(value: object) -> object:
    """A value with infinities and NaN as text, because JSON has no such numbers."""
    if isinstance(value, tuple):
        return [_make_json_safe(part) for part in value]
    return value if not isinstance(value, float) or math.isfinite(value) else str(value)
