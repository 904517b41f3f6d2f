"""`halation gallery`: contact sheets of all presets, of those that move, and of all nodes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .batch import middle_frame, open_batch
from .options import AsJson
from .outcome import print_json

if TYPE_CHECKING:
    from halation.nodes import Kind, Node

    from ..color.transforms import Array
    from ..graph import Graph
    from ..renderer import Renderer

Step = Callable[[str], None]
"""Called with the name of what is rendered next."""

_COLUMNS = 6
_WIDTH = 256
_LETTERS = 18
_MOMENTS = 6
"""How many frames of a preset are shown, from the first to the last."""


@dataclass(frozen=True)
class Sheet:
    """A contact sheet: light of the display, and the names of what it shows, in order."""

    light: Array
    names: tuple[str, ...]


def gallery(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder to write to.")] = Path("out"),
    as_json: AsJson = False,
) -> int:
    """Make contact sheets of all presets, of those that move, and of all nodes at their defaults, over the sample."""
    from halation.nodes import catalogue
    from halation.presets import paths

    from ..media.comparison.contact_sheet import write_sheet
    from .specimen import drawable_outputs

    rows: list[dict[str, object]] = []
    pictures = (
        len(paths()) + len(animated_presets()) + sum(bool(drawable_outputs(node)) for node in catalogue().values())
    )
    with open_batch(output, pictures) as work:
        for name, make_sheet in (("presets", preset_sheet), ("time", time_sheet), ("nodes", node_sheet)):
            if make_sheet is time_sheet and not animated_presets():
                continue
            started, file = time.perf_counter(), output / f"{name}.jpg"
            sheet = make_sheet(work.renderer, work.step)
            write_sheet(file, sheet.light, ", ".join(sheet.names))
            spent = time.perf_counter() - started
            work.say(f"{name:<24} {len(sheet.names):>3} pictures  {spent:5.2f} s  {file}")
            rows.append({"sheet": str(file), "pictures": list(sheet.names), "seconds": round(spent, 3)})
    if as_json:
        print_json({"device": work.device, "sheets": rows})
    return 0


def preset_sheet(renderer: Renderer, step: Step = lambda name: None) -> Sheet:
    """Every preset on its own sample; of those that move, the frame in the middle."""
    from halation.presets import paths

    from .. import document
    from ..media.comparison.contact_sheet import make_grouped_sheet

    pictures: dict[str, Array] = {}
    for path in paths():
        step(path.stem)
        graph = document.load(path)
        (pictures[path.stem],) = frames_of(graph, renderer, (middle_frame(renderer, graph),)).values()
    return Sheet(make_grouped_sheet({"": pictures}, 5, _WIDTH, letters=_LETTERS), tuple(pictures))


def time_sheet(renderer: Renderer, step: Step = lambda name: None) -> Sheet:
    """A row for every preset that moves: some of its frames, from the first to the last."""
    from ..media.comparison.contact_sheet import make_grouped_sheet

    rows: dict[str, dict[str, Array]] = {}
    for name, graph in animated_presets().items():
        step(name)
        first, last = renderer.frames(graph)
        frames = [first + round((last - first) * part / (_MOMENTS - 1)) for part in range(_MOMENTS)]
        rows[name] = {str(frame): picture for frame, picture in frames_of(graph, renderer, frames).items()}
    return Sheet(make_grouped_sheet(rows, _MOMENTS, _WIDTH, letters=_LETTERS), tuple(rows))


def animated_presets() -> dict[str, Graph]:
    """The presets that have frames, by name."""
    from halation.presets import paths

    from .. import document

    return {path.stem: graph for path in paths() if (graph := document.load(path)).settings.frames}


def frames_of(graph: Graph, renderer: Renderer, frames: Iterable[int]) -> dict[int, Array]:
    """What the first output of a graph is at frames, as light of the display."""
    from ..media.comparison.contact_sheet import show_light
    from ..renderer import FrameRenderer, RenderRequest

    name, output = next(iter(graph.outputs.items()))
    reel = FrameRenderer(renderer, graph, RenderRequest())
    try:
        return {frame: show_light(reel.render(frame)[name], output.view) for frame in frames}
    finally:
        reel.close()


def node_sheet(renderer: Renderer, step: Step = lambda name: None, ids: tuple[str, ...] = ()) -> Sheet:
    """Every node that draws, at its defaults over the sample, by category; or only these."""
    from halation.nodes import catalogue
    from halation.presets import sample

    from ..media.comparison.category_colors import category_color
    from ..media.comparison.contact_sheet import make_grouped_sheet
    from .specimen import drawable_outputs

    nodes = [node for id, node in catalogue().items() if drawable_outputs(node) and (not ids or id in ids)]
    groups: dict[str, dict[str, Array]] = {node.category: {} for node in nodes}
    for node in nodes:
        step(node.id)
        groups[node.category][node.id] = picture_of(node, renderer, sample())
    colors = {name: category_color(name) for name in groups}
    light = make_grouped_sheet(groups, _COLUMNS, _WIDTH, letters=_LETTERS, colors=colors)
    return Sheet(light, tuple(node.id for node in nodes))


def picture_of(node: type[Node], renderer: Renderer, sample: Path) -> Array:
    """What a node makes of the sample, as light of the display: its first picture, else its data made visible."""
    from halation.nodes import Kind

    from .specimen import CANVAS, sample_graph, show_on_sample

    graph = show_on_sample(node, sample)
    outputs = renderer.render(graph)
    name = next((name for name, end in graph.outputs.items() if end.kind is Kind.IMAGE), next(iter(outputs)))
    if graph.outputs[name].kind is Kind.NUMBER:
        from ..media.comparison.contact_sheet import make_caption, show_light

        numbers = [
            f"{name.replace('_', ' ')}  {array.item():.4g}" for name, array in outputs.items() if array.size == 1
        ]
        return make_caption(show_light(renderer.render(sample_graph(sample))["image"]), numbers)
    if graph.outputs[name].kind is Kind.COLOR:
        outputs[name] = outputs[name].repeat(CANVAS[0], axis=1).repeat(CANVAS[1], axis=0)
    return light_of(graph.outputs[name].kind, outputs[name])


def light_of(kind: Kind, array: Array) -> Array:
    """An output as light of the display, which a picture that stays within 0..1 is taken to be already."""
    from halation.nodes import Kind

    from ..media.comparison.contact_sheet import show_any_light, show_data, show_over_checker
    from ..media.comparison.data_range import are_normals, balance_range, find_data_range

    if kind in (Kind.IMAGE, Kind.COLOR):
        return show_over_checker(array, "none" if array[..., :3].max() <= 1.0 else "")
    array = array.astype("float32")
    low, high = find_data_range(array)
    if low >= 0.0 and high > 1.0:
        return show_any_light(array)
    if kind is Kind.VECTOR:
        return show_data(array, *((-1.0, 1.0) if are_normals(array) else balance_range(low, high)))
    return show_data(array, low, high)
