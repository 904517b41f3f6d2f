from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    CameraModel,
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Image,
    Meaning,
    OfLayer,
    OfSpace,
    OutputSocket,
    Reader,
    Render,
    RenderPath,
    Vector,
)

_KINDS = ("planar", "radial", "inverse", "negative", "normalized")
_PLAIN = {
    "color": "beauty",
    "albedo": "albedo",
    "emission": "emission",
    "occlusion": "occlusion",
    "position": "position",
    "object_id": "object_id",
    "material_id": "material_id",
    "uv": "uv",
}
"""Outputs that show a layer as it is, and its role."""
_FOUND = "empty for the one that was found"


class ReadRender(Reader):
    """Read a render and recognize its layers, whatever names the renderer gives them.

    Recognizes the names of Blender, Arnold, V-Ray, Karma, RenderMan, Redshift, Nuke and others, in files of one part or
    many. `halation info FILE` prints what was recognized, and why. Data is converted to one convention: depth along the
    camera's axis, normals in the world, motion in pixels from the previous frame and to the next one, y down. The
    camera is solved from positions, or read from the header. If a guess is wrong, name the layer or the convention.
    """

    aliases = (
        "render layers", "read", "load", "loader", "exr", "multilayer exr", "aov", "passes", "render passes",
        "extractor", "3d channel extract", "import render", "g-buffer", "gbuffer", "open exr", "open render",
        "load render", "load exr", "view layer",
    )  # fmt: skip

    path: Annotated[RenderPath, Doc("The render, relative to the graph's folder.")] = ""
    color_layer: Annotated[str, OfLayer("beauty"), Doc(f"The layer of the picture; {_FOUND}.")] = ""
    albedo_layer: Annotated[str, OfLayer("albedo"), Doc(f"The layer of the surfaces' own color; {_FOUND}.")] = ""
    emission_layer: Annotated[str, OfLayer("emission"), Doc(f"The layer of light that surfaces give; {_FOUND}.")] = ""
    depth_layer: Annotated[str, OfLayer("depth"), Doc(f"The layer of depth; {_FOUND}.")] = ""
    depth_is: Annotated[
        Literal["found", "planar", "radial", "inverse", "negative"],
        OfLayer("depth"),
        Doc("What the depth layer holds."),
    ] = "found"
    normal_layer: Annotated[str, OfLayer("normal"), Doc(f"The layer of normals; {_FOUND}.")] = ""
    normal_is: Annotated[
        Literal["found", "world", "camera"],
        OfLayer("normal"),
        Doc("The axes of normals: x right, y up, z toward the viewer."),
    ] = "found"
    position_layer: Annotated[
        str,
        OfLayer("position"),
        Doc(f"The layer of positions in the world, from which the camera is solved; {_FOUND}."),
    ] = ""
    velocity_layer: Annotated[str, OfLayer("velocity"), Doc(f"The layer of motion; {_FOUND}.")] = ""
    velocity_is: Annotated[
        Literal["found", "from previous", "to next", "to previous", "from next"],
        OfLayer("velocity"),
        Doc("The direction of the first two channels of the motion layer, in pixels, y down."),
    ] = "found"
    occlusion_layer: Annotated[str, OfLayer("occlusion"), Doc(f"The layer of ambient occlusion; {_FOUND}.")] = ""
    object_id_layer: Annotated[str, OfLayer("object_id"), Doc(f"The layer of object numbers; {_FOUND}.")] = ""
    material_id_layer: Annotated[str, OfLayer("material_id"), Doc(f"The layer of material numbers; {_FOUND}.")] = ""
    uv_layer: Annotated[str, OfLayer("uv"), Doc(f"The layer of texture coordinates; {_FOUND}.")] = ""
    color_space: Annotated[
        str,
        OfSpace(),
        Doc(
            "The color space of the picture, by a name or role of the color config, such as "
            "ACEScg. If empty, it is recognized."
        ),
    ] = ""

    color = OutputSocket(Image())
    albedo = OutputSocket(Image())
    emission = OutputSocket(Image())
    depth = OutputSocket(Field(doc="Along the camera's axis."))
    normal = OutputSocket(Vector(doc="In the world."))
    position = OutputSocket(Vector())
    velocity = OutputSocket(
        Vector(width=4, doc="Motion in pixels: x and y since the previous frame, z and w until the next one; y down.")
    )
    occlusion = OutputSocket(Field())
    object_id = OutputSocket(Field())
    material_id = OutputSocket(Field())
    uv = OutputSocket(Vector(width=2))
    camera = OutputSocket(CameraSocket())

    def passes(self, draw: Draw) -> Mapping[str, Drawn | CameraModel]:
        render = draw.render(self.path, self._list_chosen_layers())
        outputs: dict[str, Drawn | CameraModel] = {}
        for name, role in _PLAIN.items():
            if (layer := render.layers.get(role)) is not None:
                outputs[name] = draw.read(self.path, layer, self.outputs[name].socket, self.color_space)
        if render.camera:
            outputs["camera"] = render.camera
        for name, convert in (("depth", self._depth), ("normal", self._normal), ("velocity", self._velocity)):
            if (layer := render.layers.get(name)) is not None:
                stored = draw.read(self.path, layer, self.outputs[name].socket)
                outputs[name] = convert(draw, render, stored, render.meanings.get(name, Meaning("")))
        return outputs

    def _list_chosen_layers(self) -> dict[str, str]:
        """The layers that the user chose, by role."""
        chosen = {value.role: str(getattr(self, value.name)) for value in self.values.values() if value.type == "text"}
        return {role: layer for role, layer in chosen.items() if role and layer}

    def _depth(self, draw: Draw, render: Render, stored: Drawn, meaning: Meaning) -> Drawn:
        if self.depth_is != "found":
            meaning = Meaning(self.depth_is, (-1.0,) if self.depth_is == "negative" else (1.0,))
        kind = meaning.kind if meaning.kind in _KINDS else "planar"
        focal, center = (render.camera.focal, render.camera.center) if render.camera else ((1.0, 1.0), (0.5, 0.5))
        if kind == "radial" and not render.camera:
            kind = "planar"  # without a camera the width of the view is unknown
        if kind == "planar" and (meaning.scale, meaning.offset) == ((1.0,), (0.0,)):
            return stored
        return draw.point(
            "read_render_depth",
            result=Field(),
            stored=stored,
            kind=_KINDS.index(kind),
            scale=meaning.scale[0],
            offset=meaning.offset[0],
            focal=focal,
            center=center,
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
            "read_render_normal",
            result=Vector(),
            stored=stored,
            scale=scale,
            offset=offset,
            right=right,
            down=down,
            ahead=ahead,
            towards=towards,
        )

    def _velocity(self, draw: Draw, render: Render, stored: Drawn, meaning: Meaning) -> Drawn:
        kind, scale = meaning.kind, meaning.scale
        if self.velocity_is != "found":
            kind = "to_next" if self.velocity_is in ("to next", "from next") else "from_previous"
            scale = (1.0,) if self.velocity_is in ("from previous", "to next") else (-1.0,)
        whole = scale if len(scale) == 4 else (*_two(scale), *_two(scale))
        return draw.point(
            "read_render_velocity",
            result=Vector(width=4),
            stored=stored,
            scale=whole,
            both=render.channels.get("velocity", 2) == 4,
            to_next=kind == "to_next",
        )


def _two(numbers: tuple[float, ...]) -> tuple[float, float]:
    """One number per axis, of one for all or of one each."""
    return (numbers[0], numbers[min(1, len(numbers) - 1)])


def _three(numbers: tuple[float, ...]) -> tuple[float, float, float]:
    last = len(numbers) - 1
    return (numbers[0], numbers[min(1, last)], numbers[min(2, last)])
