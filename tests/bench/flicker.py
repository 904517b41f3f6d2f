"""How much traced light flickers over a shot, with and without accumulation, beside the render's own flicker.

    .venv/bin/python tests/bench/flicker.py shot/neon.####.exr 9-16

The residual of two frames is the root mean square of the difference between one and the one before, moved along its
motion by scipy, over pixels whose depth says that both show the same surface. Colors are c / (1 + c), as eyes see them.
"""

from __future__ import annotations

import argparse

import numpy as np
from halation.graph import Graph, Output, Port, Settings
from halation.nodes import Kind
from halation.nodes.input.read_render import ReadRender
from halation.nodes.light.ambient_occlusion import AmbientOcclusion
from halation.nodes.light.directional_occlusion import DirectionalOcclusion
from halation.nodes.light.screen_reflections import ScreenReflections
from halation.nodes.time.temporal_accumulation import TemporalAccumulation
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from scipy.ndimage import map_coordinates

Array = np.ndarray
EFFECTS = {
    "reflections of a polished floor": (ScreenReflections(reflectance=0.6, roughness=0.25), "reflection"),
    "the same, 2 rays": (ScreenReflections(reflectance=0.6, roughness=0.25, quality="preview"), "reflection"),
    "ambient occlusion": (AmbientOcclusion(), "out"),
    "light from around": (DirectionalOcclusion(), "light"),
}
"""Each effect and the output that flickers; the reflections are those whose noise was measured first."""

SAME = 0.05
"""The relative difference of depth up to which two pixels show one surface, as the node has it by default."""


def build(path: str, frames: tuple[int, int]) -> Graph:
    """A graph with the render's own layers, and the light of each effect as it is and accumulated."""
    graph = Graph(settings=Settings(frames=frames)).add("read", ReadRender(path=path))
    outputs = {layer: Port("read", layer) for layer in ("color", "depth", "velocity")}
    for number, (effect, light) in enumerate(EFFECTS.values()):
        plain, mean = f"effect_{number}", f"mean_{number}"
        graph = graph.add(plain, effect).add(mean, TemporalAccumulation())
        for layer, socket in (("color", "image"), ("depth", "depth"), ("normal", "normal"), ("camera", "camera")):
            if socket in effect.inputs:
                graph = graph.connect(Port("read", layer), Port(plain, socket))
        for layer in ("velocity", "depth", "normal"):
            graph = graph.connect(Port("read", layer), Port(mean, layer))
        graph = graph.connect(Port(plain, light), Port(mean, "image"))
        outputs |= {plain: Port(plain, light), mean: Port(mean, "out")}
    for name, port in outputs.items():
        output = {"depth": Output(Kind.FIELD), "velocity": Output(Kind.VECTOR, 4)}.get(name, Output())
        graph = graph.add_output(name, output).connect(port, Port("outputs", name))
    return graph


def residual(now: dict[str, Array], before: dict[str, Array], name: str) -> float:
    """The root mean square of what an output has changed along the motion."""
    motion = now["velocity"]
    rows, columns = np.indices(motion.shape[:2])
    places = np.stack([rows - motion[..., 1], columns - motion[..., 0]])
    depth = map_coordinates(before["depth"][..., 0], places, order=0, cval=np.inf)
    same = np.abs(depth - now["depth"][..., 0]) < SAME * now["depth"][..., 0]
    light = [np.maximum(picture[name][..., :3], 0.0).astype(np.float64) for picture in (now, before)]
    new, old = (picture / (1.0 + picture) for picture in light)
    moved = np.stack([map_coordinates(old[..., c], places, order=1, mode="nearest") for c in range(3)], axis=-1)
    return float(np.sqrt(((new - moved)[same] ** 2).mean()))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path", help="a sequence with layers, as read_render takes it")
    parser.add_argument("frames", help="the first and the last frame: 9-16")
    arguments = parser.parse_args()
    first, last = map(int, arguments.frames.split("-"))
    graph = build(arguments.path, (first, last))
    frame_renderer = FrameRenderer(Renderer(sandbox=UNRESTRICTED), graph, RenderRequest(precision="float"))
    pictures = [
        {name: picture.copy() for name, picture in frame_renderer.render_frame(frame).items()}
        for frame in range(first, last + 1)
    ]
    frame_renderer.close()

    def mean(name: str) -> float:
        pairs = zip(pictures[1:], pictures[:-1], strict=True)
        return float(np.mean([residual(now, before, name) for now, before in pairs]))

    print(f"| residual over frames {first} to {last} | plain | accumulated | last frame |\n|---|---|---|---|")
    print(f"| the render itself | {mean('color'):.4f} | | |")
    for number, label in enumerate(EFFECTS):
        end = residual(pictures[-1], pictures[-2], f"mean_{number}")
        print(f"| {label} | {mean(f'effect_{number}'):.4f} | {mean(f'mean_{number}'):.4f} | {end:.4f} |")


if __name__ == "__main__":
    main()
