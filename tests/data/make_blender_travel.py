"""Makes blender_travel.npz: what Blender (Cycles) makes of moving things that a camera moves past, and of small lamps
far out of focus.

Scenes of another kind than those of make_blender_lens.py, which says how to run it. Light is stored as half floats
without their last bits, which hold nothing but noise; depth and velocity with 16 bits of digits.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np
from make_blender_lens import Array, glowing, made, moved, rendered, started

HERE = Path(__file__).parent


def shortened(array: Array, lost: int) -> Array:
    """Floats of 32 bits without the last ones, rounded."""
    bits = np.ascontiguousarray(array, np.float32).view(np.uint32).astype(np.uint64)
    return ((bits + (1 << (lost - 1))) >> lost << lost).astype(np.uint32).view(np.float32)


def light(array: Array, digits: int = 4) -> Array:
    """Half floats, with so few bits less."""
    return shortened(array[..., :3], 13 + digits).astype(np.float16)


def turned(thing, turns: list[tuple[float, float, float]]) -> None:
    """Turned so at frames 1, 2 and 3, in degrees."""
    for frame, turn in enumerate(turns, 1):
        thing.rotation_euler = tuple(math.radians(part) for part in turn)
        thing.keyframe_insert("rotation_euler", frame=frame)


def floor(scale: float) -> None:
    """Two units below the camera, out to the horizon."""
    tiles = glowing("tiles", (0.35, 0.3, 0.2), (0.5, 0.6, 0.65), 1.0, scale)
    made(bpy.ops.mesh.primitive_plane_add, tiles, size=80.0, location=(0.013, 30.0, -1.2))


def travel(folder: Path) -> dict[str, Array]:
    """A camera flies on and turns, over tiles; a box turns and a ball flies by; open from frame to frame, by half."""
    scene = started(1024, 176, 99)
    floor(1.1)
    box = made(bpy.ops.mesh.primitive_cube_add, glowing("box", (0.9, 0.2, 0.1), (0.1, 0.8, 0.3), 1.6, 1.51), size=1.6)
    box.location = (1.1, -1.2, -0.1)
    turned(box, [(10.0, -5.0, 12.0), (16.0, 0.0, 30.0), (22.0, 5.0, 48.0)])
    ball = made(
        bpy.ops.mesh.primitive_uv_sphere_add,
        glowing("ball", (0.2, 0.3, 0.9), (0.9, 0.8, 0.1), 1.5, 2.03),
        radius=0.6,
        segments=96,
        ring_count=48,
    )
    moved(ball, [(-1.15 + 0.28 * step, -2.0 + 0.1 * step, 0.35 - 0.22 * step) for step in (-1, 0, 1)])
    moved(scene.camera, [(0.1 * step, -8.0 + 0.12 * step, 0.02 * step) for step in (-1, 0, 1)], [-0.9, 0.0, 0.9])
    for thing in (box, ball, scene.camera):
        for layer in thing.animation_data.action.layers:
            for curve in (curve for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves):
                curve.extrapolation = "LINEAR"
                for key in curve.keyframe_points:
                    key.interpolation = "LINEAR"
    scene.frame_set(2)
    sharp = rendered(scene, folder)
    scene.cycles.samples = 4096
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    scene.render.motion_blur_position = "CENTER"
    blurred = rendered(scene, folder)
    return {
        "travel_image": light(sharp["Combined"]),
        "travel_depth": shortened(sharp["Depth"][..., 0], 8),
        "travel_velocity": sharp["Vector"].astype(np.float16),
        "travel_blurred": light(blurred["Combined"]),
    }


def lamps(folder: Path) -> dict[str, Array]:
    """A ball in focus over tiles, small bright lamps far behind it and close to the camera, before a dark sky."""
    scene = started(1024, 176, 99)
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.02, 0.02, 0.03, 1.0)
    floor(1.3)
    ball = glowing("ball", (0.2, 0.3, 0.9), (0.9, 0.8, 0.1), 1.2, 2.03)
    made(bpy.ops.mesh.primitive_uv_sphere_add, ball, radius=0.9, location=(0.4, -2.0, -0.3), segments=96, ring_count=48)
    pale = glowing("pale", (1.0, 0.8, 0.6), (1.0, 0.8, 0.6), 40.0, 1.0)
    for place, radius in (
        ((-7.0, 14.0, 3.4), 0.22),
        ((-1.5, 14.0, 4.4), 0.22),
        ((6.4, 14.0, 2.6), 0.22),
        ((-0.42, -5.6, 0.42), 0.024),
        ((0.35, -5.6, 0.4), 0.024),
        ((-0.55, -5.6, -0.3), 0.024),
    ):
        made(bpy.ops.mesh.primitive_uv_sphere_add, pale, radius=radius, location=place)
    sharp = rendered(scene, folder)
    scene.cycles.samples = 8192
    lens = scene.camera.data.dof
    lens.use_dof, lens.focus_distance, lens.aperture_fstop = True, 5.2, 0.036 / 0.4
    blurred = rendered(scene, folder)
    return {
        "lamps_image": light(sharp["Combined"], 1),
        "lamps_depth": shortened(sharp["Depth"][..., 0], 8),
        "lamps_blurred": light(blurred["Combined"], 2),
    }


def main() -> None:
    """Write blender_travel.npz beside this file."""
    with tempfile.TemporaryDirectory() as name:
        found = travel(Path(name)) | lamps(Path(name))
    np.savez_compressed(HERE / "blender_travel.npz", version=bpy.app.version_string, **found)


if __name__ == "__main__":
    main()
