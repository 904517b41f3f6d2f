"""Makes blender_passes.npz: a small picture and all its light passes, by Blender (Cycles).

Run once with the module of Blender 5.0.1 in a Python of its own; Blender is only called:

    python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1 OpenImageIO
    blender/bin/python tests/data/make_blender_passes.py
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np
import OpenImageIO as oiio

LIGHT = ("diffuse", "glossy", "transmission")


def material(name: str, color: tuple[float, float, float], **values: float) -> bpy.types.Material:
    """Blender's principled surface."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    for key, value in values.items():
        shader.inputs[key.replace("_", " ").title()].default_value = value
    return made


def add(operator, look: bpy.types.Material, **where) -> bpy.types.Object:
    """A new object."""
    operator(**where)
    bpy.context.object.data.materials.append(look)
    return bpy.context.object


def scene(width: int, height: int) -> bpy.types.Scene:
    """Something of every pass: dull, polished, glass, metal, a lamp, smoke and sky."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    made = bpy.context.scene
    made.render.engine = "CYCLES"
    made.cycles.samples, made.cycles.use_denoising, made.cycles.use_adaptive_sampling = 64, False, False
    made.cycles.sample_clamp_indirect = 0.0
    made.render.resolution_x, made.render.resolution_y = width, height
    world = made.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.2, 0.35, 0.6, 1.0)
    mesh = bpy.ops.mesh
    add(mesh.primitive_plane_add, material("floor", (0.5, 0.45, 0.4), roughness=0.3), size=14.0)
    add(mesh.primitive_uv_sphere_add, material("red", (0.8, 0.1, 0.1), roughness=0.2), location=(-1.6, 0, 1))
    add(
        mesh.primitive_uv_sphere_add,
        material("glass", (0.7, 0.9, 0.8), roughness=0.05, transmission_weight=1.0),
        location=(0.6, -1.2, 0.8),
        radius=0.8,
    )
    add(mesh.primitive_cube_add, material("gold", (0.9, 0.6, 0.2), roughness=0.25, metallic=1.0), location=(2, 1, 0.8))
    lamp = material("lamp", (0.2, 0.5, 1.0), emission_strength=6.0)
    lamp.node_tree.nodes["Principled BSDF"].inputs["Emission Color"].default_value = (0.2, 0.5, 1.0, 1.0)
    add(mesh.primitive_torus_add, lamp, location=(-0.3, 2.0, 1.4), major_radius=0.9, minor_radius=0.15)
    smoke = bpy.data.materials.new("smoke")
    smoke.use_nodes = True
    tree = smoke.node_tree
    tree.nodes.clear()
    scatter, out = tree.nodes.new("ShaderNodeVolumeScatter"), tree.nodes.new("ShaderNodeOutputMaterial")
    scatter.inputs["Density"].default_value = 0.25
    tree.links.new(scatter.outputs[0], out.inputs["Volume"])
    add(mesh.primitive_cube_add, smoke, location=(2.2, 0.5, 1.5), size=3.4)
    bpy.ops.object.light_add(type="SUN", rotation=(math.radians(40), math.radians(25), 0))
    bpy.context.object.data.energy = 3.0
    bpy.ops.object.camera_add(location=(0, -7.5, 2.6), rotation=(math.radians(78), 0, 0))
    made.camera = bpy.context.object
    return made


def main(target: Path) -> None:
    made = scene(36, 24)
    layer = made.view_layers[0]
    for name in LIGHT:
        for part in ("direct", "indirect", "color"):
            setattr(layer, f"use_pass_{name}_{part}", True)
    layer.use_pass_emit = layer.use_pass_environment = True
    layer.cycles.use_pass_volume_direct = layer.cycles.use_pass_volume_indirect = True
    image = made.render.image_settings
    image.media_type, image.file_format, image.color_depth = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER", "32"
    found: dict[str, np.ndarray] = {}
    with tempfile.TemporaryDirectory() as folder:
        made.render.filepath = f"{folder}/passes.exr"
        bpy.ops.render.render(write_still=True)
        (file,) = Path(folder).iterdir()
        handle = oiio.ImageInput.open(str(file))
        part = 0
        while handle.seek_subimage(part, 0):
            spec = handle.spec()
            name = spec.channelnames[0].split(".")[1].lower().replace(" ", "_")
            found[name] = np.asarray(handle.read_image(part, 0, 0, spec.nchannels, "float"))
            part += 1
    found.pop("noisy_image", None)
    np.savez_compressed(target, **found)
    for name, array in found.items():
        print(f"{name:24}{array.shape} up to {array.max():.3f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "blender_passes.npz")
