"""Makes blender_keying.npz: the errors of Blender's compositor node Keying on the plates of tests/green_screens.py.

The key color is the mean of the empty screen. Of all settings in `SETTINGS` each error is that of the best, chosen for
every plate and every error. The PSNR of the composite is the best of all these together with all of `DESPILLS`: the
node gives the despilled picture times the matte, which is checked, so that both can be rendered by themselves. Run once
with the module of Blender 5.0.1 in a Python of its own; Blender is only called:

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
from green_screens import HEIGHT, SUBJECTS, WIDTH, Plate, make_plate, measure_composite, measure_matte  # noqa: E402

SETTINGS = tuple(
    itertools.product(
        (0.0, 0.25, 0.5, 0.75, 1.0), (0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4), (0.5, 0.6, 0.7, 0.8, 0.9, 1.0), (0, 1)
    )
)
"""Balance, black level, white level, and the size of the blur before the key."""

DESPILLS = tuple(itertools.product((0.0, 0.25, 0.5, 0.75, 1.0), (0.0, 0.25, 0.5, 0.75, 1.0)))
"""Strength and balance of the despill."""


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
    nodes.links.new(node.outputs["Image"], out.inputs[0])
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.compositor_device = "CPU"
    scene.view_settings.view_transform = "Standard"
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
    settings.color_mode = "RGBA"
    return source, node


def render(folder: Path) -> np.ndarray:
    """The picture of the node, [h, w, 4], whose alpha is the matte. Blender counts rows from below."""
    settings = bpy.context.scene.render
    settings.filepath = str(folder / "out.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(settings.filepath, check_existing=False)
    pixels = np.empty(HEIGHT * WIDTH * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(HEIGHT, WIDTH, 4)[::-1].copy()


def set_matte(node, setting: tuple[float, ...]) -> None:
    """Set what the matte follows."""
    node.inputs[3].default_value, node.inputs["Black Level"].default_value = setting[:2]
    node.inputs["White Level"].default_value, node.inputs[2].default_value = setting[2:]


def set_despill(node, strength: float, balance: float) -> None:
    """Set the strength and the balance of the despill; the second input of that name is its balance."""
    node.inputs["Strength"].default_value, node.inputs[15].default_value = strength, balance


def render_despilled(node, folder: Path) -> dict[tuple[float, float], np.ndarray]:
    """The picture where the matte is 1 everywhere, by strength and balance of the despill."""
    pictures = {}
    node.inputs["Core Matte"].default_value = 1.0
    for despill in DESPILLS:
        set_despill(node, *despill)
        pictures[despill] = render(folder)
    node.inputs["Core Matte"].default_value = 0.0
    return pictures


def measure_composites(node, plate: Plate, mattes: list[np.ndarray], folder: Path) -> tuple[float, tuple[float, ...]]:
    """The highest PSNR of a composite with all mattes and all despills, and its settings."""
    despilled = render_despilled(node, folder)
    best = (0.0, ())
    for setting, matte in zip(SETTINGS, mattes, strict=True):
        for despill, picture in despilled.items():
            decibels = measure_composite(picture * matte[..., None], plate)
            best = max(best, (decibels, (*setting, *despill)))
    set_matte(node, best[1][:4])
    set_despill(node, *best[1][4:])
    rendered = measure_composite(render(folder), plate)
    assert abs(rendered - best[0]) < 1e-3, (rendered, best)
    return best


def main() -> None:
    """Write blender_keying.npz beside this file."""
    source, node = build_scene()
    errors = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for subject in SUBJECTS:
            plate = make_plate(subject)
            source.pixels.foreach_set(plate.picture[::-1].ravel())
            source.update()
            node.inputs["Key Color"].default_value = (*plate.screen_color, 1.0)
            mattes = list[np.ndarray]()
            for setting in SETTINGS:
                set_matte(node, setting)
                mattes.append(render(folder)[..., 3])
            measured = [measure_matte(matte, plate.coverage) for matte in mattes]
            best = np.argmin(measured, 0)
            print(subject, np.min(measured, 0), [SETTINGS[index] for index in best], file=sys.stderr)
            errors[subject] = np.min(measured, 0)
            composite = measure_composites(node, plate, mattes, folder)
            print(subject, composite, file=sys.stderr)
            errors[f"{subject} composite"] = composite[0]
    np.savez_compressed(HERE / "blender_keying.npz", version=bpy.app.version_string, **errors)


if __name__ == "__main__":
    main()
