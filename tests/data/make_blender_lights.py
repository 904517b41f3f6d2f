"""Makes blender_lights.npz: a ball, a box and a rod on a floor, lit by Cycles in four ways, and their layers.

A sun and a point lamp without shadows, a white sky and the sky of a courtyard, all without bounces and unblocked, as
relighting sees them. The rod is six pixels wide. A second picture of each, with other samples, tells how noisy one of
64 samples is. make_blender_lens.py says how to run it; the last argument is an HDRI by longitude and latitude (the sky
of the file: Poly Haven, CC0, made smaller to 128 x 64). Light is stored as half floats.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np
import OpenImageIO as oiio

WIDTH, HEIGHT = 128, 96
LIGHTS = {"sun": 64, "lamp": 64, "white": 64, "sky": 2048}
"""How the scene is lit, and with how many samples: only those of the sky are noisy."""
AGAIN = 64
"""Samples of the second picture of each light, whose samples lie elsewhere."""


def make_material(name: str, color: tuple[float, float, float]):
    """A matte surface."""
    matte = bpy.data.materials.new(name)
    matte.use_nodes = True
    tree = matte.node_tree
    tree.nodes.clear()
    diffuse, output = (tree.nodes.new(kind) for kind in ("ShaderNodeBsdfDiffuse", "ShaderNodeOutputMaterial"))
    diffuse.inputs["Color"].default_value = (*color, 1.0)
    tree.links.new(diffuse.outputs[0], output.inputs[0])
    return matte


def finish_object(name: str, color: tuple[float, float, float]) -> None:
    """Give the new object a material, and let it block no light."""
    thing = bpy.context.object
    thing.data.materials.append(make_material(name, color))
    thing.visible_shadow = thing.visible_diffuse = thing.visible_glossy = False


def build():
    """The scene without light."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 0
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.film_transparent = True
    for name in ("z", "normal", "diffuse_color"):
        setattr(scene.view_layers[0], f"use_pass_{name}", True)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.0, 0.0, 0.0, 1.0)
    bpy.ops.mesh.primitive_plane_add(size=9)
    finish_object("floor", (0.7, 0.65, 0.55))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, location=(-0.9, 0, 1), segments=256, ring_count=128)
    bpy.ops.object.shade_smooth()
    finish_object("ball", (0.6, 0.1, 0.08))
    bpy.ops.mesh.primitive_cube_add(size=1.4, location=(1.2, 0.6, 0.7), rotation=(0, 0, 0.6))
    finish_object("box", (0.1, 0.25, 0.7))
    bpy.ops.mesh.primitive_cylinder_add(
        radius=0.16, depth=3, location=(0.3, -1.2, 1.2), rotation=(0.5, 0.3, 0), vertices=64
    )
    bpy.ops.object.shade_smooth_by_angle()  # `shade_smooth` would bend the normals of the sides toward the caps
    finish_object("rod", (0.8, 0.8, 0.8))
    bpy.ops.object.camera_add(location=(0, -8, 2.6), rotation=(math.radians(80), 0, 0))
    scene.camera, scene.camera.data.lens = bpy.context.object, 38
    return scene


def add_light(scene, kind: str, sky: str) -> None:
    """A sun of 3 W/m2, a lamp of 400 W, a white sky, or that of a picture."""
    tree = scene.world.node_tree
    background = tree.nodes["Background"]
    if kind == "sun":
        bpy.ops.object.light_add(type="SUN", rotation=(math.radians(50), math.radians(-25), 0))
        bpy.context.object.data.energy, bpy.context.object.data.angle = 3.0, 0.0
    elif kind == "lamp":
        bpy.ops.object.light_add(type="POINT", location=(1.5, -3, 3))
        bpy.context.object.data.energy, bpy.context.object.data.shadow_soft_size = 400.0, 0.0
    elif kind == "white":
        background.inputs[0].default_value = (1.0, 1.0, 1.0, 1.0)
    else:
        picture = tree.nodes.new("ShaderNodeTexEnvironment")
        picture.image, picture.interpolation = bpy.data.images.load(sky), "Linear"
        tree.links.new(picture.outputs[0], background.inputs[0])
    if kind in ("sun", "lamp"):
        bpy.context.object.data.use_shadow = False


def render(scene, path: Path) -> dict[str, np.ndarray]:
    """All layers by name."""
    image = scene.render.image_settings
    image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.color_depth, scene.render.filepath = "OPEN_EXR_MULTILAYER", "32", str(path)
    bpy.ops.render.render(write_still=True)
    file, part, layers = oiio.ImageInput.open(str(path)), 0, {}
    while file.seek_subimage(part, 0):
        names = file.spec().channelnames
        pixels = file.read_image(part, 0, 0, len(names), "float")
        layers[names[0].split(".")[-2] if "." in names[0] else "Combined"] = np.asarray(pixels)
        part += 1
    return layers


def render_again(scene, path: Path) -> np.ndarray:
    """The light of the same scene from other samples."""
    scene.cycles.samples, scene.cycles.seed = AGAIN, 1
    return render(scene, path)["Combined"][..., :3].astype(np.float16)


def main() -> None:
    arrays = {}
    with tempfile.TemporaryDirectory() as name:
        small = Path(name) / "sky.exr"
        sky = oiio.ImageBufAlgo.resize(oiio.ImageBuf(sys.argv[-1]), "box", 0, oiio.ROI(0, 128, 0, 64, 0, 1, 0, 3))
        sky.write(str(small), "half")
        arrays["environment"] = sky.get_pixels(oiio.FLOAT).astype(np.float16)
        for kind, samples in LIGHTS.items():
            scene = build()
            add_light(scene, kind, str(small))
            scene.cycles.samples = samples
            layers = render(scene, Path(name) / "layers.exr")
            arrays[kind] = layers["Combined"][..., :3].astype(np.float16)
            arrays[f"{kind}_again"] = render_again(scene, Path(name) / "again.exr")
            if kind == "sun":
                way = bpy.context.object.matrix_world.to_3x3().col[2]
                arrays["sun_direction"] = -np.asarray(way, np.float64)
                arrays["alpha"] = layers["Combined"][..., 3].astype(np.float16)
                arrays["depth"] = layers["Depth"][..., 0].astype(np.float32)
                arrays["normal"] = layers["Normal"].astype(np.float16)
                arrays["albedo"] = layers["Diffuse Color"].astype(np.float16)
    np.savez_compressed(Path(__file__).with_name("blender_lights.npz"), **arrays)


if __name__ == "__main__":
    main()
