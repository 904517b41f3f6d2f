"""Two graphs, rendered and compared picture by picture."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .options import report_problems, resolve_inputs
from .outcome import note
from .versions import load_version

if TYPE_CHECKING:
    from ..graph import Graph
    from ..media.comparison.metrics import PictureDifference

Pictures = Mapping[str, Any]
"""Arrays [h, w, c] by output."""

RenderChoices = tuple[Mapping[str, str], tuple[int, int] | None, float, int | None]
"""Files of inputs, size, scale and frame, of which the last may be left open."""


def render_and_compare(a: str, b: str, how: RenderChoices, output: Path | None) -> list[dict[str, Any]]:
    """How far every output of two graphs is apart; with `output` they are shown there side by side.

    Raises the errors of `app.errors`.
    """
    from ..media.comparison.metrics import compare_pictures
    from ..renderer import Renderer, open_device

    inputs, size, scale, frame = how
    graphs = [load_version(source, follow=True) for source in (a, b)]
    for source, graph in zip((a, b), graphs, strict=True):
        report_problems(Path(source), graph)
    bindings = _bindings(graphs, inputs)
    renderer = Renderer(open_device())
    note(renderer.device.description)
    both: list[Pictures] = []
    try:
        for graph, bound_inputs in zip(graphs, bindings, strict=True):
            pictures, frame = _render(renderer, graph, bound_inputs, (size, scale), frame)
            both.append(pictures)
    finally:
        renderer.close()
    before, after = both
    measurements: list[dict[str, Any]] = []
    for name in dict.fromkeys((*before, *after)):
        if name in before and name in after:
            measurements.append(
                _describe_difference(name, compare_pictures(after[name], before[name], linear=_is_color(graphs, name)))
            )
        else:
            measurements.append({"output": name, "same": False, "words": f"only {a if name in before else b} has it"})
    if output:
        _show(output, (a, b), graphs, before, after)
    return measurements


def _bindings(graphs: Sequence[Graph], inputs: Mapping[str, str]) -> list[dict[str, str]]:
    """The files for the inputs of both: an input that only one of them has is filled there."""
    if set(inputs) - {""} - set[str]().union(*(graph.inputs for graph in graphs)):
        resolve_inputs(graphs[0], inputs)
    return [
        resolve_inputs(graph, {name: file for name, file in inputs.items() if not name or name in graph.inputs})
        for graph in graphs
    ]


def _render(
    renderer: Any,
    graph: Graph,
    inputs: Mapping[str, str],
    canvas: tuple[tuple[int, int] | None, float],
    frame: int | None,
) -> tuple[Pictures, int]:
    """The outputs of a graph, and which frame it was."""
    from ..renderer import FrameRenderer, RenderRequest

    reel = FrameRenderer(renderer, graph, RenderRequest(inputs, size=canvas[0], scale=canvas[1]))
    try:
        chosen = reel.frames[0] if frame is None else frame
        return reel.render(chosen), chosen
    finally:
        reel.close()


def _describe_difference(name: str, far: PictureDifference) -> dict[str, Any]:
    """The measures of two pictures, and in words; what is not finite is null for machines."""
    if far.fault:
        return {
            "output": name,
            "same": False,
            "words": far.fault.replace("is expected", "before").replace("are expected", "before"),
        }
    measures = {"max_abs": far.max_abs, "rms": far.rms, "psnr": far.psnr, "ssim": far.ssim, "flip": far.flip}
    finite = {key: number if math.isfinite(number) else None for key, number in measures.items()}
    if far.equal:
        return {"output": name, "same": True, "words": "the same", **finite}
    worst = f" at {far.worst[0]},{far.worst[1]}" if far.worst else ""
    words = (
        f"max abs {far.max_abs:.3g}{worst}, RMS {far.rms:.3g}, PSNR {far.psnr:.1f} dB, SSIM {far.ssim:.4f}, "
        f"FLIP {far.flip:.4f}"
    )
    return {"output": name, "same": False, "words": words, **finite, "worst": far.worst}


def _is_color(graphs: Sequence[Graph], name: str) -> bool:
    from halation.nodes import Kind

    return all(graph.outputs[name].kind is Kind.IMAGE for graph in graphs if name in graph.outputs)


def _show(output: Path, names: tuple[str, str], graphs: Sequence[Graph], before: Pictures, after: Pictures) -> None:
    """A row for each output."""
    from ..media.comparison.side_by_side import PicturePair, write_side_by_side

    pairs: dict[str, PicturePair] = {}
    for name in dict.fromkeys((*before, *after)):
        view = next(graph.outputs[name].view for graph in graphs if name in graph.outputs)
        pairs[name] = PicturePair(before.get(name), after.get(name), _is_color(graphs, name), view)
    write_side_by_side(output, pairs, names)
    note(str(output))
