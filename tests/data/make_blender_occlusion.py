"""Makes blender_occlusion.npz: ambient occlusion and bounced light by Blender (Cycles), and what a screen knows of it.

make_blender_lens.py says how to run it. `known` is how much of the light of each pixel depends on what the picture does
not show: rays in double precision say which directions are blocked, and the picture's own depth what it would say.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy  # pyright: ignore[reportMissingImports]
import numpy as np
from make_blender_lens import Array, rendered, started
from make_blender_travel import light, shortened
from mathutils import Vector  # pyright: ignore[reportMissingImports]

HERE = Path(__file__).parent
SIZE = (160, 90)
RADIUS = 0.6
BALL, BALL_RADIUS = np.array([1.0, 0.6, 0.35]), 0.35
LOW, HIGH = np.array([0.55, -0.75, 0.0]), np.array([1.05, -0.25, 0.45])


def plane(name: str, corners: list[tuple[float, float, float]], color: tuple[float, float, float]) -> None:
    """A matte rectangle."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    mesh.update()
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    matte, out = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    matte.inputs["Color"].default_value = (*color, 1.0)
    tree.links.new(matte.outputs[0], out.inputs["Surface"])
    mesh.materials.append(material)


def taken(scene, eye: tuple[float, ...], target: tuple[float, ...], focal: float) -> None:
    """Seen from there, in the middle of every pixel."""
    camera = scene.camera
    camera.location = eye
    camera.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = focal
    scene.cycles.filter_width = 0.01
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.0, 0.0, 0.0, 1.0)


def met(place: Array, way: Array) -> Array:
    """How far along rays the first surface of the scene of `open` is."""
    found = np.full(place.shape[:-1], np.inf)
    with np.errstate(divide="ignore", invalid="ignore"):
        for axis in (0, 2):
            far = -place[..., axis] / way[..., axis]
            found = np.fmin(found, np.where(far > 1e-6, far, np.inf))
        away = place - BALL
        b, c = (away * way).sum(-1), (away * away).sum(-1) - BALL_RADIUS**2
        far = -b - np.sqrt(b * b - c)
        found = np.fmin(found, np.where(far > 1e-6, far, np.inf))
        one, two = (LOW - place) / way, (HIGH - place) / way
        enter, leave = np.minimum(one, two).max(-1), np.maximum(one, two).min(-1)
        return np.fmin(found, np.where((enter < leave) & (enter > 1e-6), enter, np.inf))


def known(position: Array, normal: Array, depth: Array, eye: Array, rows: Array, counts: int = 24) -> Array:
    """The part of all light, by the cosine, of which depth and rays say the same: 0 to 255."""
    height, width = depth.shape
    across = np.cross(normal, np.where(np.abs(normal[..., 2:]) < 0.7, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)))
    across /= np.linalg.norm(across, axis=-1, keepdims=True)
    beside, same, random = np.cross(normal, across), np.zeros(depth.shape), np.random.default_rng(1)
    lifted = position + 1e-4 * normal
    for i in range(counts * counts):
        u, turn = ((part + random.random((*depth.shape, 1))) / counts for part in divmod(i, counts))
        spread = np.cos(2.0 * np.pi * turn) * across + np.sin(2.0 * np.pi * turn) * beside
        way = np.sqrt(u) * spread + np.sqrt(1.0 - u) * normal
        blocked = met(lifted, way) < RADIUS
        guess, beyond = np.zeros(depth.shape, bool), np.zeros(depth.shape, bool)
        for step in (np.arange(24) + 0.5) / 24 * RADIUS:
            place = lifted + step * way
            seen = place @ rows[:, :3].T + rows[:, 3]
            x, y = (np.floor(seen[..., i] / seen[..., 2] * size).astype(int) for i, size in enumerate((width, height)))
            outside = (x < 0) | (y < 0) | (x >= width) | (y >= height)
            there = depth[np.clip(y, 0, height - 1), np.clip(x, 0, width - 1)]
            beyond |= outside
            guess |= ~outside & (seen[..., 2] > 1.003 * there)
        same += (guess == blocked) & ~(beyond & ~guess & blocked)
    return np.rint(255.0 * same / counts**2).astype(np.uint8)


def open_(folder: Path) -> dict[str, Array]:
    """A box and a ball before a wall: how much of the sky is open within a radius."""
    scene = started(1024, *SIZE)
    far = 100.0
    white = (0.8, 0.8, 0.8)
    plane("floor", [(0, -far, 0), (far, -far, 0), (far, far, 0), (0, far, 0)], white)
    plane("wall", [(0, -far, 0), (0, far, 0), (0, far, far), (0, -far, far)], white)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=7, radius=BALL_RADIUS, location=BALL)
    bpy.ops.object.shade_smooth()
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(LOW + HIGH) / 2, scale=HIGH - LOW)
    taken(scene, (4.2, -0.4, 2.6), (0.6, 0.05, 0.25), 42.0)
    layer = scene.view_layers[0]
    layer.use_pass_normal = layer.use_pass_position = layer.use_pass_ambient_occlusion = True
    scene.world.light_settings.distance = RADIUS
    found = rendered(scene, folder)
    depth, position = found["Depth"][..., 0].astype(float), found["Position"].astype(float)
    stand = np.array(scene.camera.matrix_world)
    turned = stand[:3, :3].T * [[1.0], [-1.0], [-1.0]]
    focal = 42.0 / 36.0
    lens = np.array([[focal, 0.0, 0.5], [0.0, focal * SIZE[0] / SIZE[1], 0.5], [0.0, 0.0, 1.0]])
    rows = lens @ np.column_stack([turned, -turned @ stand[:3, 3]])
    normal = found["Normal"].astype(float)
    return {
        "open_rows": rows,
        "open_radius": RADIUS,
        "open_depth": shortened(found["Depth"][..., 0], 4),
        "open_normal": found["Normal"].astype(np.float16),
        "open_share": found["Ambient Occlusion"][..., 0].astype(np.float16),
        "open_known": known(position, normal, depth, stand[:3, 3], rows),
    }


def bounced(folder: Path) -> dict[str, Array]:
    """Three sides of a box in three colors, all of which are seen, under a sun: light that bounces once."""
    scene = started(4096, *SIZE)
    plane("floor", [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], (0.8, 0.8, 0.8))
    plane("red", [(0, 0, 0), (0, 2, 0), (0, 2, 1.2), (0, 0, 1.2)], (0.9, 0.15, 0.1))
    plane("green", [(0, 0, 0), (0, 0, 1.2), (2, 0, 1.2), (2, 0, 0)], (0.15, 0.7, 0.2))
    taken(scene, (4.6, 4.2, 3.2), (0.72, 0.8, 0.32), 50.0)
    bpy.ops.object.light_add(type="SUN")
    sun = bpy.context.object
    sun.data.energy, sun.data.angle = 4.0, 0.0
    sun.rotation_euler = Vector((-0.5, -0.35, -0.6)).to_track_quat("-Z", "Y").to_euler()
    cycles = scene.cycles
    cycles.max_bounces = cycles.diffuse_bounces = 1
    layer = scene.view_layers[0]
    layer.use_pass_normal = layer.use_pass_position = True
    layer.use_pass_diffuse_direct = layer.use_pass_diffuse_indirect = layer.use_pass_diffuse_color = True
    found = rendered(scene, folder)
    stand = np.array(scene.camera.matrix_world)
    turned = stand[:3, :3].T * [[1.0], [-1.0], [-1.0]]
    focal = 50.0 / 36.0
    lens = np.array([[focal, 0.0, 0.5], [0.0, focal * SIZE[0] / SIZE[1], 0.5], [0.0, 0.0, 1.0]])
    return {
        "bounced_rows": lens @ np.column_stack([turned, -turned @ stand[:3, 3]]),
        "bounced_image": light(found["Diffuse Direct"] * found["Diffuse Color"], 0),
        "bounced_depth": shortened(found["Depth"][..., 0], 4),
        "bounced_normal": found["Normal"].astype(np.float16),
        "bounced_light": light(found["Diffuse Indirect"], 3),
    }


def main() -> None:
    """Write blender_occlusion.npz beside this file."""
    with tempfile.TemporaryDirectory() as name:
        found = open_(Path(name)) | bounced(Path(name))
    np.savez_compressed(HERE / "blender_occlusion.npz", version=bpy.app.version_string, **found)


if __name__ == "__main__":
    main()
