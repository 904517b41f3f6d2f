"""`halation gallery`: contact sheets of presets, animated presets and nodes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated

import typer
from msgspec import Struct

from ..resources.sandbox import UNRESTRICTED, read_process_sandbox
from .batch import find_middle_frame, open_batch
from .options import AsJson
from .outcome import print_json
from .plugins import describe_refused_plugins, print_refused_plugins

if TYPE_CHECKING:
    from halation.nodes import Kind, Node

    from ..color.transforms import Array
    from ..graph import Graph
    from ..inputs.provider import Binding
    from ..renderer import Renderer

Step = Callable[[str], None]
"""Called with the name of what is rendered next."""

_COLUMNS = 6
_WIDTH = 256
_LETTERS = 18
"""Pictures in a row, pixels of a picture's width and of a letter's height. Chosen by eye for a web page."""

_FRAMES_SHOWN = 6
"""Frames per animated preset, from the first to the last: as many as fit in a row of the sheet."""


class Sheet(Struct, frozen=True):
    """A contact sheet: its display colors, and the names of its pictures in order."""

    light: Array
    names: tuple[str, ...]


def gallery(
    output: Annotated[Path, typer.Option("-o", "--output", help="The folder to write to.")] = Path("out"),
    as_json: AsJson = False,
) -> int:
    """Render contact sheets of presets and nodes.

    Writes one sheet of all presets, one of the animated presets, and one of all nodes at their defaults, each rendered
    on the sample frame.
    """
    from halation.nodes import catalogue
    from halation.presets import paths

    from ..media.comparison.contact_sheet import write_sheet
    from ..reference.specimen import drawable_outputs

    sandbox = read_process_sandbox()
    rows: list[dict[str, object]] = []
    picture_count = (
        len(paths()) + len(load_animated_presets()) + sum(bool(drawable_outputs(node)) for node in catalogue().values())
    )
    with open_batch(output, picture_count, sandbox=sandbox) as batch:
        for name, make_sheet in (("presets", make_preset_sheet), ("time", make_time_sheet), ("nodes", make_node_sheet)):
            if make_sheet is make_time_sheet and not load_animated_presets():
                continue
            started, file = time.perf_counter(), output / f"{name}.jpg"
            sheet = make_sheet(batch.renderer, batch.step)
            write_sheet(file, sheet.light, ", ".join(sheet.names), sandbox=sandbox)
            seconds = time.perf_counter() - started
            batch.say(f"{name:<24} {len(sheet.names):>3} pictures  {seconds:5.2f} s  {file}")
            rows.append({"sheet": str(file), "pictures": list(sheet.names), "seconds": round(seconds, 3)})
    if as_json:
        print_json({"device": batch.device, "sheets": rows, **describe_refused_plugins()})
    else:
        print_refused_plugins()
    return 0


def make_preset_sheet(renderer: Renderer, step: Step = lambda name: None) -> Sheet:
    """The sheet of all presets on their own samples; of an animated preset the frame in the middle."""
    from halation.presets import paths

    from .. import document
    from ..media.comparison.contact_sheet import make_grouped_sheet

    pictures: dict[str, Array] = {}
    for path in paths():
        step(path.stem)
        graph = document.load(path, sandbox=UNRESTRICTED)
        (pictures[path.stem],) = render_display_frames(graph, renderer, (find_middle_frame(renderer, graph),)).values()
    return Sheet(make_grouped_sheet({"": pictures}, 5, _WIDTH, letters=_LETTERS), tuple(pictures))


def make_time_sheet(renderer: Renderer, step: Step = lambda name: None) -> Sheet:
    """The sheet of animated presets: a row for each, with frames from the first to the last."""
    from ..media.comparison.contact_sheet import make_grouped_sheet

    rows: dict[str, dict[str, Array]] = {}
    for name, graph in load_animated_presets().items():
        step(name)
        first, last = renderer.find_frames(graph)
        frames = [first + round((last - first) * part / (_FRAMES_SHOWN - 1)) for part in range(_FRAMES_SHOWN)]
        rows[name] = {str(frame): picture for frame, picture in render_display_frames(graph, renderer, frames).items()}
    return Sheet(make_grouped_sheet(rows, _FRAMES_SHOWN, _WIDTH, letters=_LETTERS), tuple(rows))


def load_animated_presets() -> dict[str, Graph]:
    """The presets that have a range of frames, by name."""
    from halation.presets import paths

    from .. import document

    return {
        path.stem: graph for path in paths() if (graph := document.load(path, sandbox=UNRESTRICTED)).settings.frames
    }


def render_display_frames(graph: Graph, renderer: Renderer, frames: Iterable[int]) -> dict[int, Array]:
    """The first output of a graph at some frames, in display colors."""
    from ..media.comparison.contact_sheet import show_light
    from ..renderer import FrameRenderer, RenderRequest

    name, output = next(iter(graph.outputs.items()))
    frame_renderer = FrameRenderer(renderer, graph, RenderRequest())
    try:
        return {frame: show_light(frame_renderer.render_frame(frame)[name], output.view) for frame in frames}
    finally:
        frame_renderer.close()


def make_node_sheet(renderer: Renderer, step: Step = lambda name: None, ids: tuple[str, ...] = ()) -> Sheet:
    """The sheet of all nodes that draw, or of `ids`, by category, each at its defaults on the sample."""
    from halation.nodes import catalogue
    from halation.presets import sample

    from ..media.comparison.category_colors import category_color
    from ..media.comparison.contact_sheet import make_grouped_sheet
    from ..reference.specimen import drawable_outputs

    nodes = [node for id, node in catalogue().items() if drawable_outputs(node) and (not ids or id in ids)]
    groups: dict[str, dict[str, Array]] = {node.category: {} for node in nodes}
    for node in nodes:
        step(node.id)
        groups[node.category][node.id] = render_node(node, renderer, sample())
    colors = {name: category_color(name) for name in groups}
    light = make_grouped_sheet(groups, _COLUMNS, _WIDTH, letters=_LETTERS, colors=colors)
    return Sheet(light, tuple(node.id for node in nodes))


def render_node(node: type[Node], renderer: Renderer, sample: Path) -> Array:
    """The first image that a node makes of the sample, else its data made visible, in display colors."""
    from ..reference.specimen import show_on_sample

    return render_specimen(node, show_on_sample(node, sample), renderer, sample)


def render_specimen(
    node: type[Node],
    graph: Graph,
    renderer: Renderer,
    sample: Path,
    inputs: Mapping[str, Binding] = MappingProxyType({}),
) -> Array:
    """The same of a graph that `show_on_sample` made, with other values or inputs."""
    from halation.nodes import Kind

    from ..reference.specimen import CANVAS, name_specimen, sample_graph
    from ..renderer import RenderRequest

    with name_specimen(node):
        outputs = renderer.render(graph, RenderRequest(inputs))
    name = next((name for name, end in graph.outputs.items() if end.kind is Kind.IMAGE), next(iter(outputs)))
    if graph.outputs[name].kind is Kind.NUMBER:
        from ..media.comparison.contact_sheet import make_caption, show_light

        numbers = [
            f"{name.replace('_', ' ')}  {array.item():.4g}" for name, array in outputs.items() if array.size == 1
        ]
        return make_caption(show_light(renderer.render(sample_graph(sample))["image"]), numbers)
    if graph.outputs[name].kind is Kind.COLOR:
        outputs[name] = outputs[name].repeat(CANVAS[0], axis=1).repeat(CANVAS[1], axis=0)
    return to_display_light(graph.outputs[name].kind, outputs[name])


def to_display_light(kind: Kind, array: Array) -> Array:
    """An output in display colors; a picture that stays within 0..1 is taken as it is."""
    from halation.nodes import Kind

    from ..media.comparison.contact_sheet import show_any_light, show_data, show_over_checker
    from ..media.comparison.data_range import are_normals, balance_range, find_data_range

    if kind.is_color:
        return show_over_checker(array, "none" if array[..., :3].max() <= 1.0 else "")
    array = array.astype("float32")
    low, high = find_data_range(array)
    if low >= 0.0 and high > 1.0:
        return show_any_light(array)
    if kind is Kind.VECTOR:
        return show_data(array, *((-1.0, 1.0) if are_normals(array) else balance_range(low, high)))
    return show_data(array, low, high)
