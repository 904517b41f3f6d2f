"""Makes blender_slow.npz: slow motion by Cycles, and by the node Vector Blur of Blender 5 from the same layers.

A checkered ball moves 2 and 6 pixels before a floor and the sky while the shutter is open. For each there are the sharp
layers, what Cycles makes of 512 samples, and what Vector Blur makes of the layers. make_blender_lens.py says how to run
it. Light is stored as half floats.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 144, 96


def make_material(name: str, one: tuple[float, ...], other: tuple[float, ...], scale: float):
    """A glowing checkerboard."""
    checkered = bpy.data.materials.new(name)
    checkered.use_nodes = True
    tree = checkered.node_tree
    tree.nodes.clear()
    names = ("ShaderNodeTexCoord", "ShaderNodeTexChecker", "ShaderNodeEmission", "ShaderNodeOutputMaterial")
    place, checker, glow, output = (tree.nodes.new(name) for name in names)
    for socket, number in zip(list(checker.inputs)[1:], ((*one, 1.0), (*other, 1.0), scale), strict=True):
        socket.default_value = number
    tree.links.new(place.outputs["Object"], checker.inputs[0])
    tree.links.new(checker.outputs[0], glow.inputs[0])
    tree.links.new(glow.outputs[0], output.inputs[0])
    return checkered


def build(pixels: float):
    """The scene, with a ball that moves so many pixels from frame to frame."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", 64
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    for name in ("z", "vector"):
        setattr(scene.view_layers[0], f"use_pass_{name}", True)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.5, 0.6, 0.8, 1.0)
    bpy.ops.mesh.primitive_plane_add(size=30)
    bpy.context.object.data.materials.append(make_material("floor", (0.7, 0.65, 0.55), (0.6, 0.55, 0.5), 1.0))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, location=(0, 0, 1), segments=128, ring_count=64)
    ball = bpy.context.object
    ball.data.materials.append(make_material("ball", (0.5, 0.06, 0.05), (0.45, 0.1, 0.05), 2.01))
    step = pixels * 7.0 / WIDTH
    for frame in (1, 2, 3):
        ball.location = (0.8 * (frame - 2) * step, 0, 1 + 0.6 * (frame - 2) * step)
        ball.keyframe_insert("location", frame=frame)
    for layer in ball.animation_data.action.layers:
        for curve in layer.strips[0].channelbags[0].fcurves:
            curve.extrapolation = "LINEAR"
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"
    bpy.ops.object.camera_add(location=(0, -7, 2.0), rotation=(math.radians(82), 0, 0))
    scene.camera, scene.camera.data.lens = bpy.context.object, 36
    scene.frame_set(2)
    return scene


def write(scene, path: Path, form: str) -> dict[str, np.ndarray]:
    """Renders into a file, and reads the layers of it."""
    image = scene.render.image_settings
    if form == "OPEN_EXR_MULTILAYER":
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth, scene.render.filepath = form, "32", str(path)
    bpy.ops.render.render(write_still=True)
    file, part, layers = oiio.ImageInput.open(str(path)), 0, {}
    while file.seek_subimage(part, 0):
        names = file.spec().channelnames
        layers[names[0].split(".")[-2] if "." in names[0] else "Combined"] = file.read_image(
            part, 0, 0, len(names), "float"
        )
        part += 1
    return layers


def blur(layers: Path, path: Path) -> np.ndarray:
    """What Vector Blur makes of a file of layers."""
    scene = build(0.0)
    scene.cycles.samples = 1
    tree = bpy.data.node_groups.new("blur", "CompositorNodeTree")
    scene.compositing_node_group = tree
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    names = ("CompositorNodeImage", "CompositorNodeVecBlur", "NodeGroupOutput")
    image, vector_blur, output = (tree.nodes.new(name) for name in names)
    image.image = bpy.data.images.load(str(layers))
    for source, target in (("Combined", "Image"), ("Depth", "Z"), ("Vector", "Speed")):
        tree.links.new(image.outputs[source], vector_blur.inputs[target])
    vector_blur.inputs["Samples"].default_value, vector_blur.inputs["Shutter"].default_value = 64, 0.5
    tree.links.new(vector_blur.outputs[0], output.inputs[0])
    return write(scene, path, "OPEN_EXR")["Combined"]


def main() -> None:
    arrays = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for pixels in (2, 6):
            scene = build(2.0 * pixels)
            sharp = write(scene, folder / "sharp.exr", "OPEN_EXR_MULTILAYER")
            scene.cycles.samples, scene.render.use_motion_blur, scene.render.motion_blur_shutter = 512, True, 0.5
            moving = write(scene, folder / "moving.exr", "OPEN_EXR_MULTILAYER")["Combined"]
            light = {
                "image": sharp["Combined"],
                "cycles": moving,
                "vector_blur": blur(folder / "sharp.exr", folder / "b.exr"),
            }
            for key, array in light.items():
                arrays[f"{key}_{pixels}"] = np.asarray(array)[..., :3].astype(np.float16)
            arrays[f"vector_{pixels}"] = np.asarray(sharp["Vector"], np.float32)
            arrays[f"depth_{pixels}"] = np.asarray(sharp["Depth"], np.float32)[..., 0]
    np.savez_compressed(Path(__file__).with_name("blender_slow.npz"), **arrays)


if __name__ == "__main__":
    main()
