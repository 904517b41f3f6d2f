"""Files and arrays for the inputs of a graph: their headers while it is compiled, their pixels while it renders."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from halation.nodes import Kind
from msgspec import Struct

from ..compiler import find_named_files
from ..errors import InputError, UsageError
from ..graph import INPUTS, OUTPUTS, Graph, Input, find_key_range
from ..graph.frames import is_video
from ..media.layers import split_layer
from ..resources.input_files import fingerprint
from ..resources.picture import NumberTable, Picture
from ..resources.provider import PictureProbe
from ..resources.sandbox import Sandbox

if TYPE_CHECKING:
    from fractions import Fraction

    import numpy as np
    from halation.nodes import ColorChange, ColorSettings, Missing, Render, Scene, TextBlock, TypesetText

    from ..color.management import ColorManager
    from ..media.layers import ImageInfo
    from ..resources.color_program import ColorProgram
    from ..resources.mesh import Mesh
    from ..resources.provider import FrameFile
    from ..resources.working_space import WorkingSpace
    from .prefetch import Prefetcher

    Array = np.ndarray
    Binding = str | Path | Array | float | tuple[float, ...]
    """What can be bound to a graph input: a path, `path:layer`, an array [h, w] or [h, w, c], the value of a Number or
    Color."""


class _Encoding(Struct, frozen=True):
    """The view that encodes the color of a file as the file has it, by its header and a color config."""

    info: ImageInfo
    manager: ColorManager
    view: str | None


class MediaProvider:
    """The `ResourceProvider` of one graph: bound arrays, files, meshes and colors. `ahead` prefetches some files."""

    def __init__(self, prefetcher: Prefetcher | None = None, *, sandbox: Sandbox) -> None:
        self.sandbox = sandbox
        self.prefetcher = prefetcher
        self.repaired_pixels: dict[str, int] = {}
        """How many pixels were repaired, by path."""
        self.warnings: dict[str, str] = {}
        """Unusable parts of headers, as the rest of a sentence, by path."""
        self.describer: Callable[[str, Mapping[str, str]], Render] | None = None
        """Replaces `read_render`, for callers that cannot wait for it."""
        self._infos: dict[str, ImageInfo] = {}
        self._earlier_infos: dict[str, ImageInfo] = {}
        """What the graph before read: a dragged value must not open every file again."""
        self._fingerprints: dict[str, str] = {}
        """Of arrays that are bound, by input."""
        self._encodings: dict[tuple[str, str, str, ColorSettings], _Encoding] = {}
        self._earlier_encodings: dict[tuple[str, str, str, ColorSettings], _Encoding] = {}

    def bind(self, graph: Graph, inputs: Mapping[str, Binding]) -> dict[str, Picture]:
        """Pictures for graph inputs by name. Raises UsageError for a name that the graph does not have."""
        self._fingerprints = {}
        self._earlier_infos, self._infos = self._infos or self._earlier_infos, {}
        self._earlier_encodings, self._encodings = self._encodings or self._earlier_encodings, {}
        bound = {name: self._bind_input(_find_input(graph, name), name, item) for name, item in inputs.items()}
        return bound | self._bind_siblings(graph, bound)

    def find_frames(self, graph: Graph, bound: Mapping[str, Picture]) -> tuple[int, int]:
        """The first and last frame of a graph: from its settings, else of the first sequence that it reads, else of
        keys.

        Raises InputError, UsageError for a sequence that cannot be looked at.
        """
        from ..media.sequences import find_sequence

        if graph.settings.frames is not None:
            return graph.settings.frames
        for path, _, _ in find_named_files(graph, bound):
            if (sequence := find_sequence(path, sandbox=self.sandbox)) and sequence.frames:
                return sequence.frames[0], sequence.frames[-1]
        return find_key_range(graph)

    def find_rate(self, graph: Graph, bound: Mapping[str, Picture]) -> Fraction | float:
        """Frames per second: from the settings, else of the first video that the graph reads, else the default."""
        from ..media.sequences import find_sequence

        usual = type(graph.settings)().rate
        for path, _, _ in find_named_files(graph, bound) if graph.settings.rate == usual else ():
            if is_video(path) and (sequence := find_sequence(path, sandbox=self.sandbox)) and sequence.rate:
                return sequence.rate
        return graph.settings.rate

    def check_frames(self, graph: Graph, frames: range) -> None:
        """Raise InputError for the first missing file of a sequence that the outputs of the graph need."""
        from ..media.sequences import find_sequence

        needed = graph.upstream(OUTPUTS)
        for path, owner, missing in find_named_files(graph, {}):
            used = owner.partition("/")[0] in needed or owner.startswith(f"{INPUTS}.")
            if used and missing == "error" and frames:
                # Only the first missing frame is sought: there may be a billion frames.
                sequence = find_sequence(path, sandbox=self.sandbox)
                there = sequence.names if sequence else frames
                frame = next((frame for frame in frames if frame not in there), frames[0])
                self.find_frame_file(path, frame, missing)

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        """The file of a frame. Raises InputError for a frame that has none."""
        from ..media.sequences import find_frame_file

        return find_frame_file(path, frame, missing, sandbox=self.sandbox)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        """Size and precision of a picture. Raises InputError if it cannot be read."""
        if picture.in_memory:
            array = cast("Array", picture.pixels)
            height, width = array.shape[:2]
            if picture.path not in self._fingerprints:  # many bindings are only asked for their files
                self._fingerprints[picture.path] = _array_fingerprint(array)
            return PictureProbe((width, height), array.dtype.name == "float16", self._fingerprints[picture.path])
        from .layer_choice import find_input_layer

        if picture.within:
            _check_within(picture.path, picture.within)
        header = self.find_info(picture.path)
        layer = find_input_layer(header, picture.layer, self.sandbox)
        color = picture.kind.is_color and not layer.is_data
        mark = _conversion_mark(picture, sandbox=self.sandbox) if color else ""
        half = layer.is_half and not (mark and _changes_numbers(picture, layer.full_name, sandbox=self.sandbox))
        details = header.by_rows, header.overscan, header.pixel_aspect
        return PictureProbe(header.size, half, header.fingerprint + mark, *details, finite=color)

    def find_plain_view(self, picture: Picture) -> str | None:
        """The view that encodes color as a picture for a screen has it, "" for light of a scene, None for data.

        Raises InputError for a file that cannot be read.
        """
        if picture.in_memory:
            return ""
        key = (picture.path, picture.layer, picture.space, picture.color)
        if key not in self._encodings:
            self._encodings[key] = self._find_encoding(picture, self._earlier_encodings.get(key))
        return self._encodings[key].view

    def load_pixels(self, picture: Picture) -> Array:
        """The pixels of a picture as [height, width, channels] of float16 or float32."""
        if picture.in_memory:
            import numpy as np

            pixels: Any = picture.pixels
            array = pixels
            if isinstance(pixels, NumberTable):
                array = np.frombuffer(pixels.content, np.float32).reshape(pixels.height, pixels.width, 4)
            return fit_channels(array, picture.kind, picture.width)
        from ..color.management import get_color_manager
        from ..media.convert import LayerRequest

        path = picture.path
        request = LayerRequest(
            picture.layer,
            picture.kind,
            picture.width,
            picture.space,
            get_color_manager(picture.color, self.sandbox),
            picture.overscan,
        )
        if picture.rows is not None:
            from ..media.pictures.row_reader import read_rows

            pixels = read_rows(path, request, *picture.rows, sandbox=self.sandbox)
            repaired = (
                self.repaired_pixels.get(path, 0) + pixels.repaired
            )  # rows of one picture are requested one after the other
        elif picture.reduction > 1:
            from ..media.pictures.reduced_reader import read_reduced

            pixels = read_reduced(path, request, picture.reduction, sandbox=self.sandbox)
            repaired = pixels.repaired
        else:
            from ..media.pixels import read_layers

            pixels = self.prefetcher and self.prefetcher.take((path, request))
            pixels = pixels or read_layers(path, [request], picture.frame, sandbox=self.sandbox)[0]
            repaired = pixels.repaired
        if pixels.repaired:
            self.repaired_pixels[path] = repaired
        if pixels.warning:
            self.warnings[path] = pixels.warning
        return pixels.array

    def write_color_program(self, change: ColorChange) -> ColorProgram:
        """The program of a color change. Raises InputError for a file that cannot be read."""
        from ..color.gpu_programs import write_color_change

        return write_color_change(change, self.sandbox)

    def find_working_space(self, color: ColorSettings) -> WorkingSpace | None:
        """The constants of the working space for shaders. Raises GraphError for an unknown space."""
        from ..color.management import get_color_manager
        from ..color.primaries import find_working_space

        return find_working_space(get_color_manager(color, self.sandbox))

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        """The layers of a render's file. Raises InputError for one that cannot be read."""
        from ..render_layers.render import read_render

        return self.describer(path, named) if self.describer else read_render(path, named, sandbox=self.sandbox)

    def load_mesh(self, scene: Scene) -> Mesh:
        """The triangles of a scene. Raises InputError for a file that cannot be read."""
        from ..media.meshes.load import load_mesh

        return load_mesh(scene, sandbox=self.sandbox)

    def typeset(self, block: TextBlock) -> TypesetText:
        """The outlines of a text. Raises InputError for a font that cannot be used."""
        from ..media.lettering.typesetting import typeset

        return typeset(block, self.sandbox)

    def read_attributes(self, path: str) -> Mapping[str, str]:
        """What the header of a picture says, as texts by name. Raises InputError for one that cannot be read."""
        from ..media.metadata import read_metadata

        attributes = read_metadata(path, sandbox=self.sandbox)
        return {name: str(getattr(content, "value", content)) for name, content in attributes.items()}

    def find_info(self, path: str) -> ImageInfo:
        """A file's header. It is read again if the file has changed since the graph before was bound."""
        if path not in self._infos:
            earlier = self._earlier_infos.get(path)
            if earlier is None or earlier.fingerprint != fingerprint(path, self.sandbox):
                from ..media.info import read_info

                earlier = read_info(path, sandbox=self.sandbox)
            self._infos[path] = earlier
        return self._infos[path]

    def has_header(self, path: str) -> bool:
        """True if the header of a file has been read for the graph that was bound last."""
        return path in self._infos

    def _find_encoding(self, picture: Picture, earlier: _Encoding | None) -> _Encoding:
        """The answer of `find_plain_view` for a file; `earlier` holds if file and color config are still the same."""
        from ..color.management import get_color_manager
        from ..media.color_spaces import find_plain_view
        from .layer_choice import find_input_layer

        info, manager = self.find_info(picture.path), get_color_manager(picture.color, self.sandbox)
        if earlier is not None and earlier.info is info and earlier.manager is manager:
            return earlier
        layer = find_input_layer(info, picture.layer, self.sandbox)
        view = (
            None
            if layer.is_data
            else find_plain_view(picture.path, layer, manager, picture.space, sandbox=self.sandbox)
        )
        return _Encoding(info, manager, view)

    def _bind_siblings(self, graph: Graph, bound: Mapping[str, Picture]) -> dict[str, Picture]:
        """Inputs whose default is another layer of a replaced file follow it to the new file.

        Otherwise a new picture would quietly be mixed with the depth of the sample.
        """
        replaced = {graph.inputs[name].file: picture for name, picture in bound.items() if graph.inputs[name].file}
        siblings: dict[str, Picture] = {}
        for name, socket in graph.inputs.items():
            new = replaced.get(socket.file)
            if name in bound or new is None:
                continue
            if new.in_memory:
                raise UsageError(
                    f"input '{name}' is a layer of {socket.file}, which input '{new.path}' no longer comes from: "
                    f"bind '{name}' too"
                )
            siblings[name] = Picture(
                new.path, self._choose_layer(new.path, socket, is_bound=False), socket.kind, socket.width
            )
        return siblings

    def _bind_input(self, socket: Input, name: str, item: Binding) -> Picture:
        if socket.kind.is_planned:
            noun = socket.kind.facts.noun
            raise UsageError(f"input '{name}' is a {noun}, which cannot be a file or a number: link one in the graph")
        if not isinstance(item, str | Path):
            array = _as_input_array(item, socket.kind.is_single)
            if array.ndim not in (2, 3) or not array.size or array.dtype.kind not in "fiub":
                shape = f"{array.dtype} {list(array.shape)}"
                raise UsageError(f"input '{name}': the array is {shape}; give numbers as [height, width, channels]")
            if array.dtype.kind == "u" and array.dtype.itemsize < 4:
                raise UsageError(
                    f"input '{name}': {array.dtype} pixels are those of a file and encoded for a display; give "
                    "scene-linear floats, or the path of the file"
                )
            return Picture(name, "", socket.kind, socket.width, in_memory=True, pixels=array)
        path, layer = split_layer(str(item))
        return Picture(path, layer or self._choose_layer(path, socket), socket.kind, socket.width)

    def _choose_layer(self, path: str, socket: Input, *, is_bound: bool = True) -> str:
        """The layer of a file for an input, by name or by role."""
        from .layer_choice import choose_layer

        if not socket.layer:
            return ""
        info = self.find_info(self.find_frame_file(path, 1, "nearest").path)
        return choose_layer(info, socket, self.sandbox, is_bound=is_bound)


def _as_input_array(item: Array | float | tuple[float, ...], single: bool) -> Array:
    """An array that is bound to an input. One number, or one per channel, is enough if the input takes one value."""
    import numpy as np

    array = np.asarray(item)
    return array.reshape(1, 1, -1) if single and array.ndim < 2 else array


def _conversion_mark(picture: Picture, sandbox: Sandbox) -> str:
    """A mark that changes when the color conversion of a file does."""
    from ..color.management import get_color_manager

    manager = get_color_manager(picture.color, sandbox)
    if picture.space:
        from ..color.file_space import find_requested_space

        find_requested_space(picture.space, manager)
    if not manager.is_plain:
        _ = manager.config, manager.working  # an invalid config is an error before anything is read
    return "" if manager.is_plain and not picture.space else f" {picture.space} {manager.mark}"


def _changes_numbers(picture: Picture, layer: str, sandbox: Sandbox) -> bool:
    """True if the numbers of a layer are changed: then half floats may not hold them."""
    from ..color.management import get_color_manager
    from ..color.transforms import is_in_working_space
    from ..media.color_spaces import find_layer_spaces

    manager = get_color_manager(picture.color, sandbox)
    try:
        space = find_layer_spaces(picture.path, manager, picture.space, sandbox=sandbox).get(layer)
    except InputError:  # reading the file raises the error again
        return True
    return space is not None and not is_in_working_space(space, manager)


def _array_fingerprint(array: Array) -> str:
    """A fingerprint of the pixels: the same array may hold others in the next render.

    Processors of the last years have instructions for SHA-256, which make it twice as fast as other hashes of Python.
    """
    import numpy as np

    digest = sha256(np.ascontiguousarray(array).data).hexdigest()[:32]
    return f"array {array.shape} {array.dtype} {digest}"


def _check_within(path: str, folder: str) -> None:
    """Raise InputError for a file outside of the folder after links are resolved."""
    try:
        inside = Path(path).resolve().is_relative_to(Path(folder).resolve())
    except (OSError, RuntimeError, ValueError):
        inside = False
    if not inside:
        raise InputError(f"{path}: does not lie in the folder '{folder}', which it may not leave")


def fit_channels(array: Array, kind: Kind, width: int) -> Array:
    """An array with this many channels: missing alpha is 1, a single channel is gray, other missing ones are 0."""
    import numpy as np

    if array.ndim == 2:
        array = array[..., None]
    have = array.shape[2]
    if have >= width:
        return array[..., :width]
    if kind is Kind.IMAGE and have == 1:
        array, have = np.repeat(array, 3, axis=2), 3
    fill = np.zeros((*array.shape[:2], width - have), array.dtype)
    if kind is Kind.IMAGE:
        fill[..., -1] = 1.0
    return np.concatenate([array, fill], axis=2)


def _find_input(graph: Graph, name: str) -> Input:
    if name not in graph.inputs:
        names = ", ".join(graph.inputs) or "none"
        raise UsageError(f"the graph has no input '{name}': its inputs are {names}")
    return graph.inputs[name]
