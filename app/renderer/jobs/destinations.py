"""Decides which outputs go into which files, and refuses invalid destinations before anything is rendered."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from halation.nodes import Kind, Socket
from msgspec import Struct
from msgspec.structs import replace

from ... import media
from ...color.encoding import Encoding
from ...color.management import get_color_manager
from ...compiler import Plan, Precision
from ...errors import OutputError, UsageError
from ...graph import OUTPUTS, Graph, Port, color_settings, did_you_mean
from ...graph.frames import Pattern, check_numbered, is_video
from ...inputs.default_view import PictureEncodings, choose_default_view
from ...resources.picture import Picture, PixelRectangle
from ...resources.render_choices import Dither
from ...resources.sandbox import Sandbox
from ..engine import RenderRequest


class OutputSettings(Struct, frozen=True):
    """Where and how results are written. `files` are pairs of an output's name and a file; "" stands for all outputs.

    Without a `view`, outputs are shown as they ask for themselves. `display`, `look` and `space` are those of
    `Encoding`.
    """

    files: Sequence[tuple[str, Path]]
    view: str = ""
    compression: str = "zip"
    precision: Precision = "half"
    display: str = ""
    look: str = ""
    space: str = ""
    codec: str = ""
    """The codec of videos; "" for the default of the file format."""
    dither: Dither = "blue"
    """How colors are rounded to 8 and 10 bits."""

    @property
    def videos(self) -> tuple[Path, ...]:
        """The files that hold all frames."""
        return tuple(path for _, path in self.files if is_video(str(path)))


class Destination(Struct, frozen=True):
    """A file to be written: the output for each of its layers, and the kinds of the layers."""

    path: Path
    layers: Mapping[str, str]
    kinds: Mapping[str, Kind]
    encoding: Encoding

    @property
    def data_outputs(self) -> tuple[str, ...]:
        """The outputs that are data, where the format shows color through a view; their numbers are written."""
        if media.holds_light(self.path):
            return ()
        return tuple(name for layer, name in self.layers.items() if not self.kinds[layer].is_color)

    @property
    def view(self) -> str:
        """The view through which its colors are converted for a display."""
        return self.encoding.view


def plan_destinations(
    graph: Graph, request: RenderRequest, settings: OutputSettings, frames: Sequence[int], sandbox: Sandbox
) -> dict[int, tuple[Destination, ...]]:
    """The files of every frame; an EXR may be named for several outputs.

    Raises UsageError, also where several frames would go into one file.
    """
    files = _group_outputs(graph, request, settings, sandbox)
    for file in files:
        check_numbered(str(file.path), frames)
    return {frame: tuple(replace(file, path=_name_at_frame(file.path, frame)) for file in files) for frame in frames}


def create_folders(files_by_frame: Mapping[int, Sequence[Destination]], sandbox: Sandbox) -> None:
    """Create the folders of files that are not there. Raises OutputError."""
    for folder in {file.path.parent for files in files_by_frame.values() for file in files}:
        if reason := sandbox.find_write_fault(folder):
            raise OutputError(f"{folder}: {reason}")
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as fault:
            sentence = f"the folder cannot be created ({fault.strerror}); choose another with -o"
            raise OutputError(f"{folder}: {sentence}") from None


def _name_at_frame(path: Path, frame: int) -> Path:
    """The name that a file has at a frame."""
    pattern = Pattern.parse(str(path))
    return path if pattern is None else Path(pattern.name(frame))


def _group_outputs(
    graph: Graph, request: RenderRequest, settings: OutputSettings, sandbox: Sandbox
) -> tuple[Destination, ...]:
    """The files of a job, as they are named on the command line."""
    names = tuple(request.targets or graph.outputs)
    files: dict[Path, tuple[str, ...]] = {}
    spellings: dict[str, Path] = {}
    for name, path in settings.files:
        if name and name not in names:
            hint = did_you_mean(name, names) or "; there is none at all"
            raise UsageError(f"-o {name}={path}: there is no output '{name}'{hint}")
        has_layers = path.suffix.casefold() == ".exr"
        if not name and len(names) > 1 and not has_layers:
            raise UsageError(
                f"{path}: {path.suffix or 'such a file'} holds one picture, but the graph has the outputs "
                f"{', '.join(names)}; choose one with -o {names[0]}={path}"
            )
        path_as_given = spellings.setdefault(os.path.realpath(path), path)
        if path_as_given in files and not (has_layers and name and name not in files[path_as_given]):
            raise UsageError(f"-o {path}: this file is given twice; give every output a file of its own")
        files[path_as_given] = (*files.get(path_as_given, ()), *((name,) if name else names))
    return tuple(_describe_destination(graph, request, settings, path, files[path], sandbox) for path in files)


def choose_views(files: Sequence[Destination], plan: Plan, encodings: PictureEncodings) -> tuple[Destination, ...]:
    """The files of a frame with the view that suits their pictures, where neither the user nor an output names one.

    Raises InputError for a picture that cannot be read.
    """
    return tuple(_choose_view(file, plan, encodings) for file in files)


def _choose_view(file: Destination, plan: Plan, encodings: PictureEncodings) -> Destination:
    encoding, layers = file.encoding, tuple(file.layers)
    is_chosen = encoding.view or encoding.display or encoding.look or encoding.space
    if is_chosen or len(layers) != 1 or media.holds_light(file.path) or not file.kinds[layers[0]].is_color:
        return file
    view = choose_default_view(plan, plan.outputs[file.layers[layers[0]]], encodings)
    return replace(file, encoding=replace(encoding, view=view))


def check_destinations(
    destinations: Sequence[Destination],
    plan: Plan,
    sources: Mapping[str, Picture],
    settings: OutputSettings,
    sandbox: Sandbox,
) -> None:
    """Raise UsageError or OutputError for a file that cannot be written, or that one of `sources` reads.

    `sources` are pictures by the input or node that reads them.
    """
    readers = {os.path.realpath(picture.path): node for node, picture in sources.items()}
    for file in destinations:
        if node := readers.get(os.path.realpath(file.path)):
            raise UsageError(f"{file.path}: this file is read by '{node.removeprefix('inputs.')}'; write to another")
        surfaces = {layer: plan.surfaces[plan.outputs[name]] for layer, name in file.layers.items()}
        sizes = {layer: surface.frame_size for layer, surface in surfaces.items()}
        if is_video(str(file.path)):
            media.check_video(
                file.path, file.kinds, sizes, codec=settings.codec, encoding=file.encoding, sandbox=sandbox
            )
            continue
        media.check_destination(
            file.path, file.kinds, sizes, compression=settings.compression, encoding=file.encoding, sandbox=sandbox
        )


def select_half_outputs(files: Sequence[Destination], settings: OutputSettings) -> frozenset[str]:
    """The outputs that every file stores as half floats without another conversion before."""
    half_outputs, other_outputs = set[str](), set[str]()
    for file in files:
        for layer, name in file.layers.items():
            rounds = media.stores_halves(
                file.path, file.kinds[layer], precision=settings.precision, encoding=file.encoding
            )
            (half_outputs if rounds else other_outputs).add(name)
    return frozenset(half_outputs - other_outputs)


def select_whole_outputs(graph: Graph, request: RenderRequest, files: Sequence[Destination]) -> frozenset[str]:
    """The outputs whose pixels beyond the frame are wanted, and that some file can hold."""
    exr_files = (file for file in files if file.path.suffix.casefold() == ".exr")
    ports = {name: _find_port(request, name) for file in exr_files for name in file.layers.values()}
    return frozenset(
        name for name, port in ports.items() if port.node == OUTPUTS and graph.outputs[port.socket].overscan
    )


def find_frames(file: Destination, plan: Plan) -> dict[str, PixelRectangle]:
    """Where the frame lies in those layers of which more pixels are made."""
    surfaces = {layer: plan.surfaces[plan.outputs[name]] for layer, name in file.layers.items()}
    return {
        layer: (-surface.window.x, -surface.window.y, *surface.frame)
        for layer, surface in surfaces.items()
        if surface.window and surface.frame
    }


def _describe_destination(
    graph: Graph, request: RenderRequest, settings: OutputSettings, path: Path, names: Sequence[str], sandbox: Sandbox
) -> Destination:
    """What a file holds, and how its colors are written.

    A file has one view: that of the command, else that of its first output. Scene-linear light and data are never
    dithered: their codes are not steps that are seen.
    """
    layers: dict[str, str] = {}
    kinds: dict[str, Kind] = {}
    for name in names:
        layer = name if name in request.targets else graph.outputs[name].layer or name
        if layer in layers:
            raise UsageError(
                f"{path}: the outputs '{layers[layer]}' and '{name}' have the same layer '{layer}'; write them to "
                "several files"
            )
        layers[layer], kinds[layer] = name, _find_kind(graph, _find_port(request, name))
    first = _find_port(request, names[0]) if names else Port("", "")
    own_view = graph.outputs[first.socket].view if first.node == OUTPUTS and not settings.space else ""
    manager = get_color_manager(color_settings(graph), sandbox)
    has_light = media.holds_light(path) or all(not kind.is_color for kind in kinds.values())
    encoding = Encoding(
        settings.view or own_view,
        settings.display,
        settings.look,
        settings.space,
        "none" if has_light else settings.dither,
        manager,
    )
    return Destination(path, layers, kinds, encoding)


def _find_port(request: RenderRequest, name: str) -> Port:
    return request.targets.get(name, Port(OUTPUTS, name))


def _find_kind(graph: Graph, port: Port) -> Kind:
    socket = graph.target(port) if port.node == OUTPUTS else graph.source(port)
    return socket.kind if isinstance(socket, Socket) else Kind.IMAGE
