"""The tasks by Blender's compositor, as the module bpy of 4.5 or 5: nothing is rendered, the tree has pictures only.

BLENDER_DEVICE is CPU or GPU. The operation in memory is a render with loaded pictures that writes nothing. Where a
task has a formula of its own, Blender's is another one: bloom, tone mapping, depth of field.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy

sys.path.append(str(Path(__file__).parents[2]))

from bench.peers.harness import print_seconds, read_arguments, time_runs
from bench.tasks import (
    FRAMES,
    PUSH,
    SEQUENCE,
    SIGMAS,
    STEPS,
    TASKS,
    Bloom,
    Lens,
    Reinhard,
    Ten,
    picture_path,
    scale_length,
)

NEW = bpy.app.version[0] >= 5
"""Menus became sockets, and the tree a group."""


class Tree:
    """A scene with nothing but a tree of nodes."""

    def __init__(self) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = bpy.context.scene
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        self.scene.collection.objects.link(camera)
        self.scene.camera = camera
        render = self.render = self.scene.render
        render.resolution_percentage, render.use_sequencer = 100, False
        render.threads_mode, render.threads = "FIXED", len(os.sched_getaffinity(0))
        render.compositor_device = os.environ.get("BLENDER_DEVICE", "CPU")
        render.compositor_precision = "FULL"
        self.scene.view_settings.view_transform = "Raw"
        settings = render.image_settings
        settings.file_format, settings.color_mode = "OPEN_EXR", "RGBA"
        settings.color_depth, settings.exr_codec = "16", "ZIP"
        if NEW:
            self.tree = self.scene.compositing_node_group = bpy.data.node_groups.new("tree", "CompositorNodeTree")
            self.tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        else:
            self.scene.use_nodes = True
            self.tree = self.scene.node_tree
            self.tree.nodes.clear()

    def add(self, kind: str, inputs: dict[Any, Any], **properties: Any) -> Any:
        """A node and its first output that counts. `inputs` are set or linked by name or number."""
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            if hasattr(node, name):
                setattr(node, name, value)
        for name, value in inputs.items():
            self.put(node, name, value)
        return next(output for output in node.outputs if output.enabled)

    def put(self, node: Any, name: Any, value: Any) -> None:
        """Set or link an input; one that this version does not have is left out."""
        if isinstance(name, str):
            found = [item for item in node.inputs if item.name == name and item.enabled]
            wide = [item for item in found if item.type == "RGBA" and isinstance(value, tuple)]
            socket = (wide or found or [None])[0]
        else:
            socket = node.inputs[name]
        if socket is None:
            return
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif hasattr(socket.default_value, "__len__") and not isinstance(socket.default_value, str):
            socket.default_value = tuple(value)[: len(socket.default_value)]
        else:
            socket.default_value = value

    def menu(self, kind: str, inputs: dict[Any, Any], name: str, value: str, label: str, socket: str = "Type") -> Any:
        """A node with a choice that is a property or, later, a socket."""
        node = self.tree.nodes.new(kind)
        if hasattr(node, name):
            setattr(node, name, value)
        else:
            self.put(node, socket, label)
        for item, setting in inputs.items():
            self.put(node, item, setting)
        return next(output for output in node.outputs if output.enabled)

    def picture(self, path: Path) -> Any:
        """A picture from a file."""
        image = bpy.data.images.load(str(path))
        return self.add("CompositorNodeImage", {}, image=image)

    def blur(self, image: Any, sigma: float) -> Any:
        """A Gaussian blur; it ends at three sigma."""
        made = self.menu("CompositorNodeBlur", {"Image": image}, "filter_type", "GAUSS", "Gaussian")
        size = round(3.0 * sigma)
        if made.node.inputs["Size"].type == "VECTOR":
            self.put(made.node, "Size", (size, size, 0))
        else:
            made.node.size_x = made.node.size_y = size
        return made

    def mix(self, blend: str, factor: float, a: Any, b: Any) -> Any:
        """Two pictures, or a picture and a color."""
        if NEW:
            node = self.tree.nodes.new("ShaderNodeMix")
            node.data_type, node.blend_type, node.clamp_factor = "RGBA", blend, False
            for name, value in (("Factor", factor), ("A", a), ("B", b)):
                self.put(node, name, value)
            return next(output for output in node.outputs if output.enabled)
        return self.add("CompositorNodeMixRGB", {0: factor, 1: a, 2: b}, blend_type=blend)

    def sobel(self, image: Any) -> Any:
        """Edges."""
        return self.menu("CompositorNodeFilter", {"Image": image}, "filter_type", "SOBEL", "Sobel")

    def output(self, made: Any) -> None:
        """What is rendered."""
        kind = "NodeGroupOutput" if NEW else "CompositorNodeComposite"
        self.put(self.tree.nodes.new(kind), 0, made)


def bloom(tree: Tree, a: Any) -> Any:
    """T2: the node Glare, in its fastest way, Bloom."""
    node = tree.tree.nodes.new("CompositorNodeGlare")
    menus = (("glare_type", "Type", "BLOOM", "Bloom"), ("quality", "Quality", "HIGH", "High"))
    for name, socket, value, label in menus:
        if hasattr(node, name):
            setattr(node, name, value)
        else:
            tree.put(node, socket, label)
    settings = {"Image": a, "Threshold": Bloom.threshold, "Strength": Bloom.strength, "Size": 0.6}
    for socket, setting in settings.items():
        tree.put(node, socket, setting)
    return node.outputs[0]


def tone_map(tree: Tree, a: Any) -> Any:
    """T3, by Blender's formula."""
    inputs = {"Image": a, "Key": Reinhard.key}
    return tree.menu("CompositorNodeTonemap", inputs, "tonemap_type", "RH_SIMPLE", "Rh Simple")


def ten(tree: Tree, a: Any, b: Any) -> Any:
    """T5 in 16 nodes."""
    bright = tree.add("CompositorNodeExposure", {"Image": a, "Exposure": 0.5})
    settings = {"Image": bright, "Offset": (*Ten.lift, 1.0), "Slope": (*Ten.gain, 1.0), "Power": (1.0, 1.0, 1.0, 1.0)}
    method = ("correction_method", "OFFSET_POWER_SLOPE", "Offset/Power/Slope (ASC-CDL)")
    balanced = tree.menu("CompositorNodeColorBalance", settings, *method)
    power = {0: balanced, 1: 1.0 / Ten.gamma}
    graded = tree.add("ShaderNodeGamma" if NEW else "CompositorNodeGamma", power)
    gray = tree.add("CompositorNodeRGBToBW", {0: graded})
    rich = tree.mix("LIGHTEN", 1.0, tree.mix("MIX", Ten.saturation, gray, graded), (0.0, 0.0, 0.0, 0.0))
    top, bend = ((number,) * 3 + (1.0,) for number in Ten.curve)
    curved = tree.mix("MULTIPLY", 1.0, tree.mix("DIVIDE", 1.0, rich, tree.mix("ADD", 1.0, rich, bend)), top)
    apart = tree.tree.nodes.new("CompositorNodeSeparateColor")
    tree.put(apart, 0, a)
    inputs = {"Image": curved, "Alpha": apart.outputs[3]}
    color = tree.menu("CompositorNodeSetAlpha", inputs, "mode", "REPLACE_ALPHA", "Replace Alpha")
    soft = tree.mix("MIX", Ten.mix, color, tree.blur(color, Ten.sigma))
    drawn = tree.mix("ADD", Ten.edges, soft, tree.sobel(color))
    over = tree.tree.nodes.new("CompositorNodeAlphaOver")
    named = "Background" in over.inputs
    tree.put(over, "Background" if named else 1, b)
    tree.put(over, "Foreground" if named else 2, drawn)
    return over.outputs[0]


def displace(tree: Tree, a: Any, noise: Any) -> Any:
    """T6."""
    push = scale_length(PUSH, tree.render.resolution_x)
    if not NEW:
        inputs = {"Image": a, "Vector": noise, "X Scale": push, "Y Scale": push}
        return tree.add("CompositorNodeDisplace", inputs)
    away = tree.add("ShaderNodeVectorMath", {0: noise, "Scale": push}, operation="SCALE")
    return tree.add("CompositorNodeDisplace", {"Image": a, "Displacement": away})


def defocus(tree: Tree, a: Any, depth: Any) -> Any:
    """T8, by Blender's circle of confusion."""
    lens = tree.scene.camera.data.dof
    lens.use_dof, lens.focus_distance = True, Lens.focus
    settings = {"bokeh": "CIRCLE", "use_zbuffer": True, "f_stop": 2.8, "blur_max": Lens.largest}
    return tree.add("CompositorNodeDefocus", {"Image": a, "Z": depth}, **settings)


def blur_by_motion(tree: Tree, a: Any, velocity: Any, depth: Any) -> Any:
    """T9."""
    inputs = {"Image": a, "Z": depth, "Speed": velocity, "Samples": STEPS, "Shutter": 0.5}
    return tree.add("CompositorNodeVecBlur", inputs)


WORKS: dict[str, Callable[..., Any]] = {
    "copy": lambda tree, a: a,
    **{name: lambda tree, a, s=sigma: tree.blur(a, s) for name, sigma in SIGMAS.items()},
    "T2": bloom,
    "T3": tone_map,
    "T4": lambda tree, a: tree.sobel(a),
    "T5": ten,
    "T6": displace,
    "T8": defocus,
    "T9": blur_by_motion,
    "T10": ten,
}


def main() -> None:
    """As the other peers."""
    task, folder, out, repeat, listed = read_arguments()
    if listed:
        print("\n" + json.dumps({"tasks": list(WORKS), "version": bpy.app.version_string}))
        return
    tree = Tree()
    names = (*TASKS[task].inputs, *(["depth"] if task == "T9" else []))
    paths = [picture_path(folder, name) for name in names]
    if task == "T10":
        paths[0] = folder / SEQUENCE.format(1)
    given = [tree.picture(path) for path in paths]
    tree.render.resolution_x, tree.render.resolution_y = given[0].node.image.size
    tree.output(WORKS[task](tree, *given))
    tree.render.use_file_extension, tree.render.filepath = task == "T10", out.replace("{}", "####")
    if task == "T10":
        tree.render.filepath = out.replace("{}", "####").removesuffix(".exr")
        frames = given[0].node
        frames.image.source, frames.frame_duration, frames.frame_start = "SEQUENCE", FRAMES, 1
        tree.scene.frame_start, tree.scene.frame_end = 1, FRAMES
        bpy.ops.render.render(animation=True)
    elif out:
        bpy.ops.render.render(write_still=True)
    else:
        print_seconds(time_runs(lambda: bpy.ops.render.render(write_still=False), repeat))


if __name__ == "__main__":
    main()
