"""A graph as one shader in the Interactive Shader Format."""

from __future__ import annotations

import json
from collections.abc import Mapping

from halation.nodes import ColorChange, ColorSettings, Kind, Missing, Render, Scene, Size, TextBlock, TypesetText
from msgspec import Struct

from ...graph import Graph, Port
from ...resources.color_program import ColorProgram
from ...resources.mesh import Mesh
from ...resources.picture import Picture
from ...resources.provider import FrameFile, PictureProbe, ResourceProvider
from ...resources.working_space import WorkingSpace
from .. import graph_library
from ..fusion.fuse import fuse
from ..ir import LoweredProgram, Ref
from ..knobs import FRAME, GraphSampler, Point, find_control_name
from ..lowering.lower import lower
from ..request import Request
from ..target import NULL
from .affine import Anatomy, FittedKnob, take_apart
from .controls import Section, find_controls, make_identifier
from .model import HEIGHT, WIDTH, IsfModel, ModelSearch
from .passes import find_obstacles
from .writing import IsfWriter

_SIDE_STEP = 96.0
"""Pixels between two samples of the width or the height: whole blocks for pyramids of up to five halvings. Chosen by
judgement; the sizes of pictures have samples of their own."""

MAX_PASSES = 64
"""Passes that a shader may take. The format has no limit, but hosts compile all passes as one program. Of the 28
presets that can be exported none takes more than 39."""

MAX_PICTURES = 16
"""Pictures and buffers that a shader may read: OpenGL promises so many samplers to a fragment shader."""

SIZE: Size = (1280, 720)
"""The size of the picture where neither the user nor the graph names one."""


class IsfExport(Struct, frozen=True):
    """The text of a shader and what it cannot do that the graph can; or why there is none: nodes and reasons."""

    text: str
    notes: tuple[str, ...]
    reasons: tuple[tuple[str, str], ...]


class _BoundProvider(Struct, frozen=True):
    """A provider for which the picture of every bound input has the size of the export."""

    provider: ResourceProvider
    size: Size

    def find_frame_file(self, path: str, frame: int, missing: Missing) -> FrameFile:
        return self.provider.find_frame_file(path, frame, missing)

    def probe_picture(self, picture: Picture) -> PictureProbe:
        return (
            PictureProbe(self.size, False, picture.path) if picture.in_memory else self.provider.probe_picture(picture)
        )

    def write_color_program(self, change: ColorChange) -> ColorProgram:
        return self.provider.write_color_program(change)

    def find_working_space(self, color: ColorSettings) -> WorkingSpace | None:
        return self.provider.find_working_space(color)

    def describe_render(self, path: str, named: Mapping[str, str]) -> Render:
        return self.provider.describe_render(path, named)

    def load_mesh(self, scene: Scene) -> Mesh:
        return self.provider.load_mesh(scene)

    def typeset(self, block: TextBlock) -> TypesetText:
        return self.provider.typeset(block)

    def read_attributes(self, path: str) -> Mapping[str, str]:
        return self.provider.read_attributes(path)


def export_isf(
    graph: Graph, target: Port, provider: ResourceProvider, *, size: Size | None = None, doc: str = ""
) -> IsfExport:
    """Write the output `target` of a graph as one shader. Raises the errors of compiling a graph.

    Image inputs of the graph become pictures of the shader. Controls become inputs of the shader if they change
    nothing but numbers, along straight lines. `size` is the size of the picture, for what cannot follow it.
    """
    return _IsfExporter(graph, target, provider, size or graph.settings.size or SIZE).export(doc)


class _IsfExporter:
    """Exports one output of a graph: its pictures, its controls, and the notes so far."""

    def __init__(self, graph: Graph, target: Port, provider: ResourceProvider, size: Size) -> None:
        self.graph, self.target, self.provider, self.size = graph, target, provider, size
        self.library = graph_library(graph, provider)
        self.first = (graph.settings.frames or (1, 1))[0]
        self.pictures = _name_pictures([name for name, end in graph.inputs.items() if end.kind is Kind.IMAGE])
        self.controls, notes = find_controls(graph, self.pictures.values())
        self.notes = notes
        self.sampler = GraphSampler(graph, [item.control for item in self.controls], self._lower)

    def export(self, doc: str) -> IsfExport:
        """The shader, or why there is none."""
        program = self.sampler.take({}).program
        passes = fuse(program, NULL, gathers=False)
        obstacles = [*self._find_data_inputs(program), *find_obstacles(program, passes, self._find_sources(program))]
        count = sum(len(fused.writes) for fused in passes)
        if count > MAX_PASSES:
            obstacles.append(("", f"takes {count} passes: {MAX_PASSES} are the most"))
        if obstacles:
            return IsfExport("", (), tuple(dict.fromkeys(obstacles)))
        model = ModelSearch(self.sampler, self._make_knobs(), self.size).find_model()
        self._add_notes(model)
        inputs: list[Section] = [{"NAME": name, "TYPE": "image"} for name in self.pictures.values()]
        inputs += [
            control.entry for control in self.controls if {knob.name for knob in control.knobs} & model.used_knobs
        ]
        writer = IsfWriter(
            model, self.library, self._find_sources(model.program), tuple(self.pictures.values()), self.size
        )
        text, targets = writer.write(self.first)
        count = len(self.pictures) + len({target["TARGET"] for target in targets if target})
        if count > MAX_PICTURES:
            why = f"needs {count} pictures at once: shaders read {MAX_PICTURES} at most"
            return IsfExport("", (), (("", why),))
        head: Section = {
            "ISFVSN": "2",
            "DESCRIPTION": doc or "Made by Halation.",
            "CATEGORIES": ["Halation"],
            "INPUTS": inputs,
            **({"PASSES": targets} if targets != [{}] else {}),
        }
        comment = json.dumps(head, indent=2).replace("*/", "*\\/")
        return IsfExport(f"/*{comment}*/\n\n{text}", tuple(self.notes), ())

    def _lower(self, graph: Graph, point: Point) -> Anatomy:
        """The graph as operations, at the frame and the size of a point."""
        size = (round(point.get(WIDTH, self.size[0])), round(point.get(HEIGHT, self.size[1])))
        bindings = {name: Picture(name, "", Kind.IMAGE, 4, in_memory=True) for name in self.pictures}
        request = Request({"made": self.target}, bindings, size, frame=round(point.get(FRAME, self.first)))
        return take_apart(lower(graph, request, self.library, _BoundProvider(self.provider, size)).program)

    def _make_knobs(self) -> dict[str, FittedKnob]:
        width, height = (float(side) for side in self.size)
        return {
            **{knob.name: knob for control in self.controls for knob in control.knobs},
            FRAME: FittedKnob(FRAME, f"float(@FRAMEINDEX + {self.first})", self.first, self.first, 1.0, 3),
            WIDTH: FittedKnob(WIDTH, "@halation_canvas.x", width, width, _SIDE_STEP, resizes=True),
            HEIGHT: FittedKnob(HEIGHT, "@halation_canvas.y", height, height, _SIDE_STEP, resizes=True),
        }

    def _add_notes(self, model: IsfModel) -> None:
        """Say what the shader does not follow."""
        for control in self.controls:
            if held := [knob.name for knob in control.knobs if knob.name in model.held_knobs]:
                name = find_control_name(held[0])
                self.notes.append(f"control '{name}' keeps its value: it changes more than numbers")
        if FRAME in model.held_knobs:
            self.notes.append(f"it always shows frame {self.first}: more than numbers change with time")
        if WIDTH in model.held_knobs:
            width, height = self.size
            self.notes.append(f"it is made for {width}x{height} pixels, and looks different at others: see --size")

    def _find_sources(self, program: LoweredProgram) -> dict[Ref, str]:
        """The pictures of the graph's inputs, by the names that the shader gives them."""
        return {
            Ref(at): self.pictures[picture.path]
            for at, op in enumerate(program.ops)
            if (picture := op.find_upload(0)) and picture.in_memory and picture.path in self.pictures
        }

    def _find_data_inputs(self, program: LoweredProgram) -> list[tuple[str, str]]:
        """Inputs that are files of data."""
        return [
            (op.owner, f"is a {self.graph.inputs[name].kind}: the format has pictures of display values only")
            for op in program.ops
            if op.find_upload(0)
            for node, _, name in [op.owner.partition(".")]
            if node == "inputs" and name in self.graph.inputs and name not in self.pictures
        ]


def _name_pictures(names: list[str]) -> dict[str, str]:
    """What a shader calls the pictures of a graph: the only one is `inputImage`, as in every filter."""
    if len(names) == 1:
        return {names[0]: "inputImage"}
    shader_names: dict[str, str] = {}
    for name in names:
        shader_names[name] = make_identifier(name, shader_names.values())
    return shader_names
