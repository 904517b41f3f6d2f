"""Makes blender_lens.npz: what Blender (Cycles) makes of moving things, of things out of focus and of a moving camera.

Run once with the module of Blender 5.0.1 in a Python of its own; Blender is only called:

    python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1 OpenImageIO
    blender/bin/python tests/data/make_blender_lens.py

Light is stored as half floats, in flat colors that compress well. `velocity` and `vector` are Blender's Vector pass.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np
import OpenImageIO as oiio

HERE = Path(__file__).parent

Array = np.ndarray


def glowing(name: str, first: tuple[float, ...], second: tuple[float, ...], strength: float, scale: float):
    """A material that gives off a checker of two colors."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    place, checker, light, out = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "TexChecker", "Emission", "OutputMaterial")
    )
    checker.inputs["Scale"].default_value = scale
    checker.inputs["Color1"].default_value, checker.inputs["Color2"].default_value = (*first, 1.0), (*second, 1.0)
    light.inputs["Strength"].default_value = strength
    tree.links.new(place.outputs["Object"], checker.inputs["Vector"])
    tree.links.new(checker.outputs[0], light.inputs["Color"])
    tree.links.new(light.outputs[0], out.inputs["Surface"])
    return material


def made(operator, material, **options):
    """A new object."""
    operator(**options)
    thing = bpy.context.object
    thing.data.materials.append(material)
    return thing


def moved(thing, places: list[tuple[float, float, float]], turns: list[float] | None = None) -> None:
    """Through these places, and turned so about the vertical, at frames 1, 2 and 3; straight between them."""
    for frame, place in enumerate(places, 1):
        thing.location = place
        thing.keyframe_insert("location", frame=frame)
        if turns:
            thing.rotation_euler = (math.radians(90.0), 0.0, math.radians(turns[frame - 1]))
            thing.keyframe_insert("rotation_euler", frame=frame)
    for layer in thing.animation_data.action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                for curve in bag.fcurves:
                    curve.extrapolation = "LINEAR"
                    for key in curve.keyframe_points:
                        key.interpolation = "LINEAR"


def started(samples: int, width: int, height: int):
    """An empty scene with a camera at (0, -8, 0) that looks along y, as many pixels to the unit as it is wide."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", samples, False, False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.frame_start, scene.frame_end = 1, 3
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_vector = True
    world = bpy.data.worlds.new("world")
    scene.world, world.use_nodes = world, True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.1, 0.1, 0.15, 1.0)
    bpy.ops.object.camera_add(location=(0.0, -8.0, 0.0), rotation=(math.radians(90.0), 0.0, 0.0))
    scene.camera = bpy.context.object
    scene.camera.data.lens = scene.camera.data.sensor_width = 36.0
    scene.frame_set(2)
    return scene


def rendered(scene, folder: Path) -> dict[str, Array]:
    """All passes by name."""
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER", "32"
    scene.render.filepath = str(folder / "out.exr")
    bpy.ops.render.render(write_still=True)
    found: dict[str, Array] = {}
    source, part = oiio.ImageInput.open(scene.render.filepath), 0
    while source.seek_subimage(part, 0):
        names = source.spec().channelnames
        found[names[0].split(".")[1]] = np.asarray(source.read_image(part, 0, 0, len(names), "float"))
        part += 1
    return found


def room() -> None:
    """A wall 16 units away."""
    wall = glowing("wall", (0.2, 0.25, 0.3), (0.6, 0.55, 0.5), 1.0, 1.0)
    made(bpy.ops.mesh.primitive_plane_add, wall, size=30.0, location=(0.0, 8.0, 0.0), rotation=(math.pi / 2, 0.0, 0.0))


def motion(folder: Path) -> dict[str, Array]:
    """A cube goes right past a wall, before it a ball flies up to the left; the shutter is open for half a frame."""
    scene = started(1024, 240, 135)
    room()
    cube = glowing("cube", (0.9, 0.2, 0.1), (0.1, 0.8, 0.3), 2.0, 2.01)
    ball = glowing("ball", (0.2, 0.3, 0.9), (0.9, 0.8, 0.1), 1.5, 2.03)
    moved(made(bpy.ops.mesh.primitive_cube_add, cube, size=2.0), [(0.6 + 0.5 * step, 0.0, 0.0) for step in (-1, 0, 1)])
    moved(
        made(bpy.ops.mesh.primitive_uv_sphere_add, ball, radius=0.7, segments=64, ring_count=32),
        [(-1.8 - 0.3 * step, -2.0, -0.2 + 0.25 * step) for step in (-1, 0, 1)],
    )
    scene.frame_set(2)
    sharp = rendered(scene, folder)
    scene.cycles.samples = 8192
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    scene.render.motion_blur_position = "CENTER"
    blurred = rendered(scene, folder)
    return {
        "motion_image": sharp["Combined"][..., :3].astype(np.float16),
        "motion_depth": sharp["Depth"][..., 0],
        "motion_velocity": sharp["Vector"],
        "motion_blurred": blurred["Combined"][..., :3].astype(np.float16),
    }


def focus(folder: Path, name: str, near: bool, width: int, height: int) -> dict[str, Array]:
    """A cube in focus before a wall; if `near`, with lamps on it, and a ball and a post nearer than the focus."""
    scene = started(1024, width, height)
    room()
    cube = glowing("cube", (0.9, 0.2, 0.1), (0.1, 0.8, 0.3), 2.0, 2.01)
    made(bpy.ops.mesh.primitive_cube_add, cube, size=2.0)
    if near:
        lamp = glowing("lamp", (1.0, 0.7, 0.3), (1.0, 0.7, 0.3), 30.0, 1.0)
        for x, z in ((-5.1, 2.9), (-2.6, 3.4), (3.1, 3.1), (5.9, 2.2), (3.4, -2.6)):
            made(bpy.ops.mesh.primitive_uv_sphere_add, lamp, radius=0.12, location=(x, 7.5, z))
        ball = glowing("ball", (0.2, 0.3, 0.9), (0.9, 0.8, 0.1), 1.0, 4.03)
        made(
            bpy.ops.mesh.primitive_uv_sphere_add,
            ball,
            radius=0.5,
            location=(-0.95, -4.0, -0.3),
            segments=64,
            ring_count=32,
        )
        post = glowing("post", (0.5, 0.1, 0.4), (0.3, 0.5, 0.5), 1.0, 3.0)
        made(bpy.ops.mesh.primitive_cube_add, post, size=1.0, location=(1.3, -3.5, 0.0), scale=(0.3, 0.3, 8.0))
    sharp = rendered(scene, folder)
    scene.cycles.samples = 8192
    lens = scene.camera.data.dof
    lens.use_dof, lens.focus_distance = True, 7.0
    lens.aperture_fstop = 0.036 / 0.5  # a lens half a unit wide
    blurred = rendered(scene, folder)
    return {
        f"{name}_image": sharp["Combined"][..., :3].astype(np.float16),
        f"{name}_depth": sharp["Depth"][..., 0],
        f"{name}_blurred": blurred["Combined"][..., :3].astype(np.float16),
    }


def camera(folder: Path) -> dict[str, Array]:
    """A camera that moves and turns, and where it stands in each frame: columns of the matrix to the world."""
    scene = started(1, 64, 36)
    room()
    made(bpy.ops.mesh.primitive_cube_add, glowing("cube", (1, 1, 1), (1, 1, 1), 1.0, 1.0), size=2.0)
    made(bpy.ops.mesh.primitive_uv_sphere_add, glowing("ball", (1, 1, 1), (1, 1, 1), 1.0, 1.0), location=(-2, -3, -0.5))
    moved(scene.camera, [(-0.4, -8.3, 0.1), (0.0, -8.0, 0.0), (0.5, -7.6, 0.2)], [1.5, 0.0, -2.0])
    stands = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        stands.append(np.array(scene.camera.matrix_world))
    scene.frame_set(2)
    seen = rendered(scene, folder)
    return {"camera_depth": seen["Depth"][..., 0], "camera_vector": seen["Vector"], "camera_stands": np.array(stands)}


def main() -> None:
    """Write blender_lens.npz beside this file."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        found = motion(folder) | focus(folder, "far", False, 160, 90)
        found |= focus(folder, "near", True, 176, 99) | camera(folder)
    np.savez_compressed(HERE / "blender_lens.npz", version=bpy.app.version_string, **found)


if __name__ == "__main__":
    main()
