import math
from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import (
    BuiltInScene,
    CameraModel,
    CameraSocket,
    Doc,
    Draw,
    Drawn,
    Field,
    Fraction,
    Image,
    Motion,
    OutputSocket,
    SceneFile,
    ScenePath,
    Slider,
    Source,
    Vector,
    orbit_camera,
)

_NEAR = 0.01
"""What is nearer than this part of the distance to the target is cut off. A choice."""

_JITTERS = 16
"""Frames until the samples of a pixel start again: as many as antialiasing over time remembers well."""

_SENSOR_WIDTH = 36.0
"""Millimeters: the full frame of 35 mm film, for which focal lengths are usually told; Blender's default too."""


class Scene(Source):
    """Draw meshes into every channel that effects need: albedo, normals, depth, position, velocity, ids and more.

    All channels come from one pass. The camera moves around its target. Movable objects (all objects of a file, the red
    ball of the stage) rotate around the vertical axis of the world and drift. Positions are in world units, z up. Depth
    is measured along the camera's axis and is 1e10 on the background. Velocity is in pixels, y down: since the previous
    frame, and until the next one. Pixels are sampled at their centers, so that edges are hard and data is exact; with
    jitter, the place changes with each frame (Halton 1960).
    """

    aliases = (
        "3d scene", "mesh", "geometry", "obj", "gltf", "fbx", "read geo", "3d", "model", "scanline render",
        "renderer 3d", "import 3d", "shape 3d", "card", "cube", "sphere",
    )  # fmt: skip

    scene: Annotated[
        Literal["stage", "corner", "blocks", "file"],
        Doc("A still life, a corner of a room, a town, or the meshes of a file."),
    ] = "stage"
    file: Annotated[ScenePath, Doc("Meshes: .glb, .gltf, .obj, .ply or .stl, with their materials' plain colors.")] = ""
    up: Annotated[Literal["y", "z"], Doc("The axis that points up in the file: y in glTF and OBJ.")] = "y"
    target: Annotated[
        tuple[float, float, float], Slider(-10.0, 10.0, unit="scene"), Doc("What the camera looks at.")
    ] = (0.1, 0.2, 0.75)
    distance: Annotated[
        float, Slider(0.5, 50.0, unit="scene", minimum=1e-3, maximum=1e6, doc="How far away the camera is.")
    ] = 6.5
    azimuth: Annotated[
        float,
        Slider(-180.0, 180.0, unit="deg", doc="The direction of the camera from the target; at 0 it looks along y."),
    ] = 8.0
    elevation: Annotated[
        float,
        Slider(-89.0, 89.0, unit="deg", minimum=-90.0, maximum=90.0, doc="The angle of the camera above the ground."),
    ] = 14.0
    focal: Annotated[
        float,
        Slider(
            12.0,
            200.0,
            unit="mm",
            minimum=1.0,
            maximum=10000.0,
            doc="Focal length in millimeters, on a sensor 36 mm wide.",
        ),
    ] = 50.0
    orbit: Annotated[
        float, Slider(-10.0, 10.0, unit="deg", doc="How far the camera moves around the target in each frame.")
    ] = 0.0
    turn: Annotated[float, Slider(-30.0, 30.0, unit="deg", doc="How far movable objects turn in each frame.")] = 0.0
    drift: Annotated[
        tuple[float, float, float], Slider(-0.5, 0.5, unit="scene"), Doc("How far movable objects move in each frame.")
    ] = (0.0, 0.0, 0.0)
    jitter: Annotated[
        Fraction,
        Doc(
            "How far from its center a pixel is sampled, for Temporal AA: 1 is anywhere in the "
            "pixel. The camera and velocity outputs are those of the center."
        ),
    ] = 0.0

    color = OutputSocket(Image(doc="The scene in the light of one soft lamp and the sky, as a preview."))
    albedo = OutputSocket(Image())
    normal = OutputSocket(Vector(doc="Normals of length 1 in the axes of the world, on the side of the camera."))
    position = OutputSocket(Vector(doc="In the world."))
    depth = OutputSocket(Field(doc="Depth along the camera's axis; 1e10 on the background."))
    emission = OutputSocket(Image())
    material = OutputSocket(Vector(width=2, doc="Metal and roughness, 0..1."))
    velocity = OutputSocket(
        Vector(width=4, doc="Motion in pixels: x and y since the previous frame, z and w until the next one; y down.")
    )
    uv = OutputSocket(Vector(width=2))
    object_id = OutputSocket(Field(doc="A whole number for every object, from 1."))
    material_id = OutputSocket(Field(doc="A whole number for every material, from 1."))
    camera = OutputSocket(CameraSocket())
    camera_before = OutputSocket(CameraSocket(doc="The camera of the previous frame."))

    def passes(self, draw: Draw) -> Mapping[str, Drawn | CameraModel]:
        """Shift all three cameras by the same jitter, so that it is no motion. The cameras that come out are without
        it.
        """
        scene = SceneFile(self.file, self.up) if self.scene == "file" else BuiltInScene(self.scene)
        width, height = draw.size
        times = (draw.frame, draw.frame - 1, draw.frame + 1)
        camera, before, after = (self._camera(time, width / height) for time in times)
        first, second, third = (self._motion(time) for time in times)
        x, y = (self.jitter * part for part in _halton(draw.frame))
        at = (x / width, y / height)
        cameras = (camera.shift(*at), before.shift(*at), after.shift(*at))
        surfaces = draw.raster(scene, (first, second, third), cameras, _NEAR * self.distance)
        place, surface = surfaces["place"], surfaces["surface"]
        return {
            "color": draw.point(
                "scene_color",
                albedo=surfaces["albedo"],
                normal=surfaces["normal"],
                emission=surfaces["emission"],
                eye=camera.forward,
            ),
            "albedo": surfaces["albedo"],
            "normal": surfaces["normal"],
            "emission": surfaces["emission"],
            "position": draw.point("scene_position", result=Vector(), place=place),
            "depth": draw.point("scene_depth", result=Field(), place=place),
            "material": surfaces["metal_rough"],
            "velocity": surfaces["velocity"],
            "uv": draw.point("scene_uv", result=Vector(width=2), surface=surface),
            "object_id": draw.point("scene_object", result=Field(), surface=surface),
            "material_id": draw.point("scene_material", result=Field(), surface=surface),
            "camera": camera,
            "camera_before": before,
        }

    def _camera(self, frame: int, aspect: float) -> CameraModel:
        across, turn = self.focal / _SENSOR_WIDTH, self.azimuth + self.orbit * (frame - 1)
        return orbit_camera(self.target, self.distance, turn, self.elevation, (across, across * aspect))

    def _motion(self, frame: int) -> Motion:
        frames = frame - 1
        c, s = math.cos(self.turn * frames), math.sin(self.turn * frames)
        x, y, z = (part * frames for part in self.drift)
        return (c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, 1.0, z)


def _halton(frame: int) -> tuple[float, float]:
    """Where a pixel is sampled in a frame, from its middle: -0.5..0.5 by radical inverses of 2 and 3."""
    index = frame % _JITTERS + 1
    return _radical_inverse(index, 2) - 0.5, _radical_inverse(index, 3) - 0.5


def _radical_inverse(index: int, base: int) -> float:
    """The digits of a whole number, mirrored behind the point."""
    fraction, place = 0.0, 1.0 / base
    while index:
        index, digit = divmod(index, base)
        fraction += digit * place
        place /= base
    return fraction
