"""Makes blender_smaa.npz: what Blender's compositor node Anti-Aliasing (SMAA) makes of jagged edges.

Run once with the module of Blender 5.0.1 in a Python of its own; Blender is only called:

    python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1
    blender/bin/python tests/data/make_blender_smaa.py
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np

HERE = Path(__file__).parent


def jagged() -> np.ndarray:
    """Black and white: a star of 14 slopes, a disc in a ring, a box, a line and dust, within a margin."""
    y, x = np.mgrid[:56, :84]
    dx, dy = x - 27.3, y - 27.6
    star = (np.hypot(dx, dy) < 22.0) & ((np.arctan2(dy, dx) / (2.0 * np.pi) * 7.0 + 0.02) % 1.0 < 0.5)
    away = np.hypot(x - 62.3, y - 14.6)
    ring = (away < 9.0) & ((away < 3.6) | (away > 5.4))
    box = (x > 54) & (x < 66) & (y > 31) & (y < 40)
    line = (x > 52) & (x < 79) & (np.abs(y - 47 - 0.19 * (x - 66)) < 0.5)
    dust = (np.random.default_rng(3).random(x.shape) > 0.7) & (x > 70) & (x < 79) & (y > 26) & (y < 42)
    return star | ring | box | line | dust


def antialiased(picture: np.ndarray, folder: Path) -> np.ndarray:
    """What the node makes of a gray picture. Blender counts rows from below."""
    height, width = picture.shape
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    source = bpy.data.images.new("source", width, height, float_buffer=True, is_data=True)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = picture[::-1, :, None]
    source.pixels.foreach_set(pixels.ravel())
    nodes = bpy.data.node_groups.new("nodes", "CompositorNodeTree")
    scene.compositing_node_group = nodes
    nodes.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    image, node, out = (
        nodes.nodes.new(kind) for kind in ("CompositorNodeImage", "CompositorNodeAntiAliasing", "NodeGroupOutput")
    )
    image.image = source
    nodes.links.new(image.outputs[0], node.inputs["Image"])
    nodes.links.new(node.outputs[0], out.inputs[0])
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.compositor_device = "CPU"
    scene.view_settings.view_transform = "Standard"
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
    scene.render.filepath = str(folder / "out.exr")
    bpy.ops.render.render(write_still=True)
    found = np.empty(height * width * 4, np.float32)
    bpy.data.images.load(scene.render.filepath).pixels.foreach_get(found)
    return found.reshape(height, width, 4)[::-1, :, 0]


def main() -> None:
    """Write blender_smaa.npz beside this file."""
    picture = jagged()
    with tempfile.TemporaryDirectory() as folder:
        np.savez_compressed(
            HERE / "blender_smaa.npz",
            picture=picture,
            found=antialiased(picture, Path(folder)),
            version=bpy.app.version_string,
        )


if __name__ == "__main__":
    main()
