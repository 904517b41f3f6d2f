"""The page about writing nodes names what GLSL can use, and a pass has it all."""

from __future__ import annotations

import re

import node_reference
import numpy as np
import pytest
from halation.custom_nodes import Code, node_type
from halation.glsl import parse
from halation.graph import Graph, Input, Output, Port
from halation.nodes import Draw
from halation.renderer import RenderRequest

LIBRARIES = node_reference.list_libraries()

CODE = """vec4 probe(vec4 image, int mode // = screen, one of add | screen
) {
    ivec2 p = pixel + 0 * extent + 0 * image_size;
    vec4 c = image_at(p) + image_near(vec2(p) + 0.5) + image_raw(p);
    bool fine = inside(p, image_size) && image_has(p) && !is_hole(c) && mode == MODE_SCREEN;
    return fine ? c + vec4(float(frame) * proxy) : vec4(0.0);
}"""


def test_every_built_in_can_be_used(renderer) -> None:
    graph = Graph().add_input("image", Input()).add_output("out", Output(width=4))
    graph = graph.add("probe", node_type(Code("glsl", CODE))())
    graph = graph.connect(Port("inputs", "image"), Port("probe", "image"))
    graph = graph.connect(Port("probe", "out"), Port("outputs", "out"))
    picture = np.full((4, 6, 4), 0.25, np.float32)
    pixels = renderer.render(graph, RenderRequest({"image": picture}, frame=3))["out"]
    assert (pixels == 3 * 0.25 + 3.0).all()
    names = {re.findall(r"\w+", name.partition("(")[0])[-1] for name, _ in node_reference.BUILT_INS}
    used = {name.replace("NAME", "image").replace("VALUE_CHOICE", "MODE_SCREEN") for name in names}
    assert used <= set(re.findall(r"\w+", CODE)), "the code here uses what the page names"


@pytest.mark.parametrize("file", LIBRARIES, ids=lambda file: file.stem)
def test_every_function_of_a_library_is_described(file) -> None:
    source = file.read_text(encoding="utf-8")
    functions = parse(file.stem, source).all_functions
    comments = node_reference.find_comments(source.split("\n"), functions)
    assert not [item.name for item, comment in zip(functions, comments, strict=True) if not comment]
    assert source.startswith("//"), "a library begins with what it is for"


def test_the_page_has_every_draw_and_every_library() -> None:
    page = node_reference.write_reference()
    for name in vars(Draw):
        if not name.startswith("_"):
            assert f"draw.{name}" in page
    for file in LIBRARIES:
        assert f"### lib/{file.name}\n" in page
