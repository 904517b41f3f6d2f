"""Nodes of user code against numpy, alone and among others."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Run
from halation import document
from halation.custom_nodes import Code, node_type
from halation.errors import GraphError, ShaderError
from halation.graph import Graph, Input, Output, Port, Unknown
from halation.renderer import Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED

PICTURE = np.random.default_rng(5).random((13, 21, 4)).astype(np.float32)
OTHER = np.random.default_rng(6).random((13, 21, 4)).astype(np.float32)


def node(text: str, **values: Any) -> Any:
    return node_type(Code("glsl", text))(**values)


def chain(*texts: str) -> Graph:
    """Code nodes one after the other: n0, n1, ..."""
    graph = Graph().add_input("image", Input()).add_output("out", Output(width=4))
    last = Port("inputs", "image")
    for number, text in enumerate(texts):
        graph = graph.add(f"n{number}", node(text)).connect(last, Port(f"n{number}", "image"))
        last = Port(f"n{number}", "out")
    return graph.connect(last, Port("outputs", "out"))


def test_pointwise_code(run: Run) -> None:
    text = """
    vec3 weights() { return vec3(0.25, 0.5, 0.25); }
    vec4 gray(vec4 image, float amount, // = 1
              int mode /* = weigh, one of max | weigh */, bool invert /* = false */, vec4 add /* = 0, color */) {
        float y = mode == MODE_WEIGH ? dot(image.rgb, weights()) : max(image.r, max(image.g, image.b));
        y = invert ? 1.0 - y : y;
        return vec4(mix(image.rgb, vec3(y), amount) + add.rgb, image.a);
    }"""
    rgb = PICTURE[..., :3]
    gray = rgb @ np.array([0.25, 0.5, 0.25], np.float32)
    made = run(node(text, amount=0.5, add=(0.1, 0.2, 0.3, 1.0)), {"image": PICTURE})
    wanted = rgb + (gray[..., None] - rgb) * 0.5 + np.array([0.1, 0.2, 0.3])
    assert np.abs(made[..., :3] - wanted).max() < 1e-6 and np.array_equal(made[..., 3], PICTURE[..., 3])
    made = run(node(text, mode="max", invert=True), {"image": PICTURE})
    assert np.abs(made[..., 0] - (1.0 - rgb.max(2))).max() < 1e-6


def test_a_value_can_be_wired(run: Run) -> None:
    made = run(
        node("vec4 f(vec4 image, float k /* = 1 */) { return image * k; }"), {"image": PICTURE, "k": OTHER[..., 0]}
    )
    assert np.abs(made - PICTURE * OTHER[..., :1]).max() < 1e-6


def test_code_that_looks_around(run: Run) -> None:
    """Neighbors beyond the edge, several pictures, filtered reads, and its own pixel as a parameter."""
    text = """vec4 f(vec4 image /* wrap */, vec4 other, float k /* = 2 */) {
        return image_at(pixel + ivec2(1, -2)) * k + other - other_near(vec2(pixel) + vec2(1.0, 0.5));
    }"""
    made = run(node(text), {"image": PICTURE, "other": OTHER})
    moved = np.roll(PICTURE, (2, -1), (0, 1))
    between = 0.5 * (OTHER + np.roll(OTHER, -1, 1))
    assert np.abs(made - (moved * 2 + OTHER - between)).max() < 1e-6


def test_several_outputs(run: Run) -> None:
    split = "void split(vec4 image, float at /* = 0.5 */, out vec4 low, out float high) {{ {} }}"
    for body in ("low = min(image, at); high = image.g;", "low = min(image_at(pixel), at); high = image.g;"):
        made = node(split.format(body), at=0.25)
        assert np.array_equal(run(made, {"image": PICTURE}, output="low"), np.minimum(PICTURE, np.float32(0.25)))
        assert np.array_equal(run(made, {"image": PICTURE}, output="high")[..., 0], PICTURE[..., 1])


def test_a_pattern_without_inputs(run: Run) -> None:
    made = run(node("vec4 f() { return vec4(pixel, extent); }"), size=(5, 3))
    assert np.array_equal(made[2, 4], [4, 2, 5, 3]) and made.shape == (3, 5, 4)


def test_lengths_follow_a_proxy(run: Run) -> None:
    made = node("float f(vec4 image, float r /* = 8, px */) { return r; }")
    assert np.allclose(run(made, {"image": PICTURE}, scale=0.5), 4.0)


def test_the_library_can_be_included(run: Run) -> None:
    made = run(
        node('#include "lib/color.glsl"\nfloat f(vec4 image) { return luminance(image.rgb); }'), {"image": PICTURE}
    )
    assert np.abs(made[..., 0] - PICTURE[..., :3] @ [0.2126, 0.7152, 0.0722]).max() < 1e-3


def test_equal_names_do_not_meet(run: Run, renderer: Renderer) -> None:
    """Two codes with helpers, constants and macros of the same names, and of the library's, share one pass."""
    one = """#define GAIN 2.0
    const float OFFSET = 0.25;
    float luminance(vec3 c) { return c.r; }
    vec4 f(vec4 image) { return image * GAIN + OFFSET * luminance(image.rgb); }"""
    two = one.replace("2.0", "0.5").replace("0.25", "0.125").replace("c.r;", "c.b;")
    graph = chain(one, two, one)
    before = renderer.runner.counters.passes
    made = run(graph, {"image": PICTURE})
    assert renderer.runner.counters.passes == before + 1

    def applied(picture: np.ndarray, gain: float, offset: float, channel: int) -> np.ndarray:
        return picture * gain + offset * picture[..., channel : channel + 1]

    wanted = applied(applied(applied(PICTURE, 2.0, 0.25, 0), 0.5, 0.125, 2), 2.0, 0.25, 0)
    assert np.abs(made - wanted).max() < 1e-5


def test_a_driver_names_the_node_and_the_users_own_line(renderer: Renderer) -> None:
    graph = chain(
        "vec4 a(vec4 image) { return image; }",
        "// one\nfloat twice(float x) { return x * 2.0; }\nvec4 b(vec4 image) {\n    return twice(image);\n}",
    )
    with pytest.raises(ShaderError) as caught:
        renderer.render(graph, RenderRequest({"image": PICTURE}))
    fault = caught.value
    assert (fault.node, fault.line) == ("n1", 4)
    assert not re.search(r"w[0-9a-f]{8}", str(fault)) and "code of 'b'" in str(fault)


@pytest.mark.parametrize(("mode", "factor"), [("half", 0.5), ("twice", 2.0)])
def test_a_choice_of_code_that_reads_other_pixels(run: Run, mode: str, factor: float) -> None:
    code = """vec4 f(vec4 image, int mode // = half, one of half | twice
    ) { return image_at(pixel) * (mode == MODE_TWICE ? 2.0 : 0.5); }"""
    assert (run(node(code, mode=mode), {"image": PICTURE}) == PICTURE * factor).all()


def test_an_include_that_is_no_library_file_is_refused(renderer: Renderer) -> None:
    for name in ("/etc/passwd", "../../secret.glsl", "color/none"):
        with pytest.raises(ShaderError, match="names no shader file"):
            renderer.render(
                chain(f'#include "{name}"\nvec4 f(vec4 image) {{ return image; }}'), RenderRequest({"image": PICTURE})
            )


def test_code_with_a_fault_stands_in_the_graph_and_says_why(renderer: Renderer) -> None:
    text = """{"halation": 1, "inputs": {"image": {"type": "Image"}}, "outputs": {"out": {"type": "Image"}},
      "nodes": {"x": {"type": "glsl", "code": ["vec4 f(vec4 image,", " vec4 image) {", "return image; }"],
                      "values": {"a": 1.0}}},
      "links": {"x.image": "inputs.image", "outputs.out": "x.out"}}"""
    graph = document.loads(text, sandbox=UNRESTRICTED)
    assert isinstance(graph.nodes["x"], Unknown)
    with pytest.raises(GraphError, match="node 'x': its code, line 2: the name 'image' is used twice: choose another"):
        renderer.render(graph, RenderRequest({"image": PICTURE}))
    assert document.loads(document.dumps(graph), sandbox=UNRESTRICTED) == graph


def test_the_examples_of_the_manual(run: Run) -> None:
    """What docs/shaders.md shows works as it stands."""
    text = (Path(__file__).parents[2] / "docs" / "shaders.md").read_text(encoding="utf-8")
    tint = re.search(r"```json\n(.*?)\n```", text, re.DOTALL)
    smear = re.search(r"```glsl\n(.*?)\n```", text, re.DOTALL)
    assert tint and smear
    code = json.loads(f"{{{tint[1]}}}")["nodes"]["tint"]["code"]
    made = run(node("\n".join(code), amount=1.0), {"image": np.tile([0.0, 0.0, 0.0, 1.0], (3, 3, 1))})
    assert np.allclose(made, [0.0, 0.2, 1.0, 1.0])
    flat = np.full((9, 40, 4), 0.25, np.float32)
    assert np.allclose(run(node(smear[1], length=9.0), {"image": flat}), 0.25)
