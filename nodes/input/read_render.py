from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    Camera,
    Doc,
    Draw,
    Drawn,
    Field,
    FilePath,
    Image,
    Meaning,
    Output,
    Render,
    Source,
    Vector,
    Viewpoint,
)

_KINDS = ("planar", "radial", "inverse", "negative", "normalized")
_PLAIN = {
    "color": "beauty", "albedo": "albedo", "emission": "emission", "occlusion": "occlusion", "position": "position",
    "object_id": "object_id", "material_id": "material_id", "uv": "uv",
}
"""Outputs that show a layer as it is, and its role."""


class ReadRender(Source):
    """Read a render: every layer finds its output by itself, whatever the renderer calls it.

    Names are those of Blender, Arnold, V-Ray, Karma, RenderMan, Redshift, Nuke and others, in files of one part or
    many; `halation info FILE` says what was found and why. Data is converted to one convention: depth along the
    camera's axis, normals in the world, motion in pixels since the frame before and until the next, y down. The camera
    is solved from positions, or named by the header. Where a guess is wrong, name the layer or the convention.
    """

    path: Annotated[FilePath, Doc("The render, relative to the graph's folder.")] = ""
    depth_is: Annotated[
        Literal["found", "planar", "radial", "inverse", "negative"], Doc("What the depth layer holds.")
    ] = "found"
    normal_is: Annotated[
        Literal["found", "world", "camera"], Doc("Whose axes normals refer to: x right, y up, z towards the viewer.")
    ] = "found"
    velocity_is: Annotated[
        Literal["found", "from previous", "to next", "to previous", "from next"],
        Doc("Which way the first two channels of the motion layer point, in pixels, y down."),
    ] = "found"
    color_layer: Annotated[str, Doc("The layer of the picture; empty for the one that was found.")] = ""
    depth_layer: str = ""
    normal_layer: str = ""
    position_layer: str = ""
    velocity_layer: str = ""
    albedo_layer: str = ""

    color = Output(Image())
    albedo = Output(Image())
    emission = Output(Image())
    depth = Output(Field(doc="Along the camera's axis."))
    normal = Output(Vector(doc="In the world."))
    position = Output(Vector())
    velocity = Output(Vector(width=4, doc="Pixels since the frame before, and until the next; y down."))
    occlusion = Output(Field())
    object_id = Output(Field())
    material_id = Output(Field())
    uv = Output(Vector(width=2))
    camera = Output(Viewpoint())

    def passes(self, draw: Draw) -> Mapping[str, Drawn | Camera]:
        render = draw.render(self.path)
        found: dict[str, Drawn | Camera] = {}
        for name, role in _PLAIN.items():
            layer = getattr(self, f"{name}_layer", "") or render.layers.get(role)
            if layer is not None:
                found[name] = draw.read(self.path, layer, self.outputs[name].socket)
        if render.camera:
            found["camera"] = render.camera
        for name, made in (("depth", self._depth), ("normal", self._normal), ("velocity", self._velocity)):
            layer = getattr(self, f"{name}_layer") or render.layers.get(name)
            if layer is not None:
                drawn = draw.read(self.path, layer, self.outputs[name].socket)
                found[name] = made(draw, render, drawn, render.meanings.get(name, Meaning("")))
        return found

    def _depth(self, draw: Draw, render: Render, stored: Drawn, meaning: Meaning) -> Drawn:
        if self.depth_is != "found":
            meaning = Meaning(self.depth_is, (-1.0,) if self.depth_is == "negative" else (1.0,))
        kind = meaning.kind if meaning.kind in _KINDS else "planar"
        focal, center = (render.camera.focal, render.camera.center) if render.camera else ((1.0, 1.0), (0.5, 0.5))
        if kind == "radial" and not render.camera:
            kind = "planar"  # nobody knows how wide the view is
        if kind == "planar" and (meaning.scale, meaning.offset) == ((1.0,), (0.0,)):
            return stored
        return draw.point(
            "read_render_depth", result=Field(), stored=stored, kind=_KINDS.index(kind), scale=meaning.scale[0],
            offset=meaning.offset[0], focal=focal, center=center,
        )

    def _normal(self, draw: Draw, render: Render, stored: Drawn, meaning: Meaning) -> Drawn:
        kind = meaning.kind if self.normal_is == "found" else self.normal_is
        scale, offset = _three(meaning.scale), _three(meaning.offset)
        right, down, ahead = (1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)
        if kind in ("camera", "camera_ahead") and render.camera:
            right, down, ahead = render.camera.right, render.camera.down, render.camera.forward
        elif (scale, offset) == (_three((1.0,)), _three((0.0,))):
            return stored
        towards = -1.0 if kind == "camera_ahead" else 1.0
        return draw.point(
            "read_render_normal", result=Vector(), stored=stored, scale=scale, offset=offset, right=right, down=down,
            ahead=ahead, towards=towards,
        )

    def _velocity(self, draw: Draw, render: Render, stored: Drawn, meaning: Meaning) -> Drawn:
        kind, scale = meaning.kind, meaning.scale
        if self.velocity_is != "found":
            kind = "to_next" if self.velocity_is in ("to next", "from next") else "from_previous"
            scale = (1.0,) if self.velocity_is in ("from previous", "to next") else (-1.0,)
        whole = scale if len(scale) == 4 else (*_two(scale), *_two(scale))
        return draw.point(
            "read_render_velocity", result=Vector(width=4), stored=stored, scale=whole,
            both=render.channels.get("velocity", 2) == 4, to_next=kind == "to_next",
        )


def _two(numbers: tuple[float, ...]) -> tuple[float, float]:
    """One number per axis, of one for all or of one each."""
    return (numbers[0], numbers[min(1, len(numbers) - 1)])


def _three(numbers: tuple[float, ...]) -> tuple[float, float, float]:
    last = len(numbers) - 1
    return (numbers[0], numbers[min(1, last)], numbers[min(2, last)])
