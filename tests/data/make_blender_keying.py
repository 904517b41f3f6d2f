"""Makes blender_keying.npz: the errors of Blender's compositor node Keying on the plates of tests/green_screens.py.

The key color is the mean of the empty screen. Of all settings in `SETTINGS` each error is that of the best, chosen for
every plate and every error. Run once with the module of Blender 5.0.1 in a Python of its own; Blender is only called:

    python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1 scipy
    blender/bin/python tests/data/make_blender_keying.py
"""

from __future__ import annotations

import itertools
import sys
import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))
from green_screens import HEIGHT, SUBJECTS, WIDTH, make_plate, measure_matte  # noqa: E402

SETTINGS = tuple(
    itertools.product(
        (0.0, 0.25, 0.5, 0.75, 1.0), (0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4), (0.5, 0.6, 0.7, 0.8, 0.9, 1.0), (0, 1)
    )
)
"""Balance, black level, white level, and the size of the blur before the key."""


def build_scene():
    """A scene whose compositor keys the image `source`; returns the image and the node."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    source = bpy.data.images.new("source", WIDTH, HEIGHT, float_buffer=True, is_data=True)
    nodes = bpy.data.node_groups.new("nodes", "CompositorNodeTree")
    scene.compositing_node_group = nodes
    nodes.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    image, node, out = (
        nodes.nodes.new(kind) for kind in ("CompositorNodeImage", "CompositorNodeKeying", "NodeGroupOutput")
    )
    image.image = source
    nodes.links.new(image.outputs[0], node.inputs["Image"])
    nodes.links.new(node.outputs["Matte"], out.inputs[0])
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.compositor_device = "CPU"
    scene.view_settings.view_transform = "Standard"
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
    return source, node


def render_matte(folder: Path) -> np.ndarray:
    """The matte of the node. Blender counts rows from below."""
    render = bpy.context.scene.render
    render.filepath = str(folder / "out.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(render.filepath, check_existing=False)
    pixels = np.empty(HEIGHT * WIDTH * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(HEIGHT, WIDTH, 4)[::-1, :, 0]


def main() -> None:
    """Write blender_keying.npz beside this file."""
    source, node = build_scene()
    errors = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in SUBJECTS:
            plate = make_plate(name)
            source.pixels.foreach_set(plate.picture[::-1].ravel())
            source.update()
            node.inputs["Key Color"].default_value = (*plate.screen_color, 1.0)
            measured = []
            for balance, black, white, blur in SETTINGS:
                node.inputs[2].default_value = blur
                node.inputs[3].default_value = balance
                node.inputs["Black Level"].default_value = black
                node.inputs["White Level"].default_value = white
                measured.append(measure_matte(render_matte(Path(folder)), plate.coverage))
            best = np.argmin(measured, 0)
            print(name, np.min(measured, 0), [SETTINGS[index] for index in best], file=sys.stderr)
            errors[name] = np.min(measured, 0)
    np.savez_compressed(HERE / "blender_keying.npz", version=bpy.app.version_string, **errors)


if __name__ == "__main__":
    main()
