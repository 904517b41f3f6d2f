"""The reference compiler of Khronos takes every program: drivers are stricter than Mesa's, each in its own way.

Skipped where glslangValidator is missing (Debian, Ubuntu: apt-get install glslang-tools).
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator

import pytest
from halation import document
from halation.compiler import NULL, Plan, Request, Target, compile_graph
from halation.graph import Graph, Output, Port
from halation.inputs.provider import MediaProvider
from halation.nodes import Kind, Light, LightKind, RotoShape, catalogue, name_lights, name_roto_shapes
from halation.nodes.input.roto import Roto
from halation.nodes.light.deferred_lighting import DeferredLighting
from halation.presets import paths
from halation.reference.specimen import drawable_outputs, plan_node
from halation.resources.sandbox import UNRESTRICTED
from selection import list_cases

VALIDATOR = shutil.which("glslangValidator")
TARGETS = {
    "gpu": Target("a card", 460, software=False, form="compute", precision="half"),
    "mac": Target("a Mac", 410, software=False, form="fragment", precision="half"),
    "software": NULL,
}
TOGETHER = 100
"""Programs that are checked by one process."""

AREAS = name_lights(window=Light(LightKind.RECTANGLE), plate=Light(LightKind.DISC), neon=Light(LightKind.TUBE, matte=1))
"""Lights with a size, which the node does not have by itself; one is in a pass with a mask."""


def make_narrow_mask() -> Graph:
    """A mask whose edge is about as wide as a pixel, which takes a program of its own."""
    shapes = name_roto_shapes(a=RotoShape(feather=0.001))
    graph = Graph().add("roto", Roto(shapes=shapes)).add_output("mask", Output(Kind.FIELD))
    return graph.connect(Port("roto", "mask"), Port("outputs", "mask"))


def plans(target: Target) -> Iterator[Plan]:
    for node in catalogue().values():
        if drawable_outputs(node):
            yield plan_node(node, (1920, 1080), target)
    yield plan_node(DeferredLighting, (1920, 1080), target, {"lights": AREAS})
    pictures = MediaProvider(sandbox=UNRESTRICTED)
    yield compile_graph(make_narrow_mask(), Request(), pictures, target=target)
    for path in paths():
        yield compile_graph(document.load(path, sandbox=UNRESTRICTED), Request(), pictures, target=target)


@pytest.mark.skipif(VALIDATOR is None, reason="glslangValidator is not installed")
@pytest.mark.parametrize("target", list_cases(("gpu", "mac"), ("software",)))
def test_the_reference_compiler_takes_all_programs(target, tmp_path):
    """Every day those of the targets that Mesa's software rasterizer does not run anyway."""
    found: dict[tuple[str, str], str] = {}
    for plan in plans(TARGETS[target]):
        for one in plan.passes:
            name = "_".join(one.functions)[:80]
            found.setdefault((one.shader.source, "comp" if one.shader.form == "compute" else "frag"), name)
            if one.shader.vertex:
                found.setdefault((one.shader.vertex, "vert"), name)
    assert len(found) > 200
    assert {"deferred_lighting_areas", "deferred_lighting_limited"} <= set(found.values())
    files = []
    for number, ((source, stage), name) in enumerate(found.items()):
        files.append(tmp_path / f"{number}_{name.replace('/', '_')}.{stage}")
        files[-1].write_text(source)
    faults = []
    for first in range(0, len(files), TOGETHER):
        some = map(str, files[first : first + TOGETHER])
        said = subprocess.run([str(VALIDATOR), *some], capture_output=True, text=True).stdout
        faults += [line for line in said.splitlines() if not line.startswith(str(tmp_path))]
    assert not faults, "\n".join(faults[:20])
