"""Renders two graphs and compares their outputs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import report_problems, resolve_inputs
from .outcome import print_note
from .versions import load_version

if TYPE_CHECKING:
    from ..graph import Graph
    from ..media.comparison.metrics import PictureDifference
    from ..resources.sandbox import Sandbox

Pictures = Mapping[str, Any]
"""Arrays [h, w, c] by output."""

RenderChoices = tuple[Mapping[str, str], tuple[int, int] | None, float, int | None]
"""Files of inputs, size, scale, and the frame or None for the first of the first graph."""


def render_and_compare(
    a: str, b: str, choices: RenderChoices, output: Path | None, sandbox: Sandbox
) -> list[dict[str, Any]]:
    """Measure how much each output of two graphs differs; `output` is a file for the pictures side by side.

    Raises HalationError.
    """
    from ..media.comparison.metrics import compare_pictures
    from ..renderer import Renderer, open_device

    inputs, size, scale, frame = choices
    graphs = [load_version(source, follow=True, sandbox=sandbox) for source in (a, b)]
    for source, graph in zip((a, b), graphs, strict=True):
        report_problems(Path(source), graph)
    bindings = _resolve_both_inputs(graphs, inputs)
    renderer = Renderer(open_device(sandbox=sandbox), sandbox=sandbox)
    print_note(renderer.device.description)
    rendered: list[Pictures] = []
    try:
        for graph, bound_inputs in zip(graphs, bindings, strict=True):
            pictures, frame = _render_frame(renderer, graph, bound_inputs, (size, scale), frame)
            rendered.append(pictures)
    finally:
        renderer.close()
    before, after = rendered
    measurements: list[dict[str, Any]] = []
    for name in dict.fromkeys((*before, *after)):
        if name in before and name in after:
            measurements.append(
                _describe_difference(name, compare_pictures(after[name], before[name], linear=_is_color(graphs, name)))
            )
        else:
            measurements.append({"output": name, "same": False, "words": f"only {a if name in before else b} has it"})
    if output:
        _write_side_by_side(output, (a, b), graphs, before, after, sandbox)
    return measurements


def _resolve_both_inputs(graphs: Sequence[Graph], inputs: Mapping[str, str]) -> list[dict[str, str]]:
    """The input files of both graphs; an input that only one graph has is used there only."""
    if set(inputs) - {""} - set[str]().union(*(graph.inputs for graph in graphs)):
        resolve_inputs(graphs[0], inputs)
    return [
        resolve_inputs(graph, {name: file for name, file in inputs.items() if not name or name in graph.inputs})
        for graph in graphs
    ]


def _render_frame(
    renderer: Any,
    graph: Graph,
    inputs: Mapping[str, str],
    canvas: tuple[tuple[int, int] | None, float],
    frame: int | None,
) -> tuple[Pictures, int]:
    """The outputs of a graph at a frame, by default its first, and that frame."""
    from ..renderer import FrameRenderer, RenderRequest

    frame_renderer = FrameRenderer(renderer, graph, RenderRequest(inputs, size=canvas[0], scale=canvas[1]))
    try:
        chosen = frame_renderer.frames[0] if frame is None else frame
        return frame_renderer.render_frame(chosen), chosen
    finally:
        frame_renderer.close()


def _describe_difference(name: str, difference: PictureDifference) -> dict[str, Any]:
    """The measures of two pictures as JSON, where infinity is null, and as text in `words`."""
    if difference.fault:
        return {
            "output": name,
            "same": False,
            "words": difference.fault.replace("is expected", "before").replace("are expected", "before"),
        }
    measures = {
        "max_abs": difference.max_abs,
        "rms": difference.rms,
        "psnr": difference.psnr,
        "ssim": difference.ssim,
        "flip": difference.flip,
    }
    finite = {key: number if math.isfinite(number) else None for key, number in measures.items()}
    if difference.equal:
        return {"output": name, "same": True, "words": "the same", **finite}
    worst = f" at {difference.worst[0]},{difference.worst[1]}" if difference.worst else ""
    words = (
        f"max abs {difference.max_abs:.3g}{worst}, RMS {difference.rms:.3g}, PSNR {difference.psnr:.1f} dB, "
        f"SSIM {difference.ssim:.4f}, FLIP {difference.flip:.4f}"
    )
    return {"output": name, "same": False, "words": words, **finite, "worst": difference.worst}


def _is_color(graphs: Sequence[Graph], name: str) -> bool:
    from halation.nodes import Kind

    return all(graph.outputs[name].kind is Kind.IMAGE for graph in graphs if name in graph.outputs)


def _write_side_by_side(
    output: Path, names: tuple[str, str], graphs: Sequence[Graph], before: Pictures, after: Pictures, sandbox: Sandbox
) -> None:
    """Write both graphs' pictures side by side, in a row per output."""
    from ..media.comparison.side_by_side import PicturePair, write_side_by_side

    pairs: dict[str, PicturePair] = {}
    for name in dict.fromkeys((*before, *after)):
        view = next(graph.outputs[name].view for graph in graphs if name in graph.outputs)
        pairs[name] = PicturePair(before.get(name), after.get(name), _is_color(graphs, name), view)
    write_side_by_side(output, pairs, names, sandbox=sandbox)
    print_note(str(output))
