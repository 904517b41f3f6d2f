"""Helpers may be called as channels and members are."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Run
from halation.custom_nodes import Code, node_type
from halation.custom_nodes.prefixes import prefix_names

PICTURE = np.random.default_rng(3).random((3, 4, 4)).astype(np.float32)


@pytest.mark.parametrize("name", ["r", "g", "x", "a", "s", "rgb", "xy", "st", "rgba", "xyzw", "stpq"])
def test_a_helper_called_as_a_swizzle(run: Run, name: str) -> None:
    text = f"""float {name}(float v) {{ return v * 2.0; }}
    vec4 f(vec4 image) {{
        vec4 {"b" if name != "b" else "c"} = vec4({name}(image.r), image . g, image
            .b, image.rgba.a);
        image.{name} = image.{name};
        return {"b" if name != "b" else "c"};
    }}"""
    doubled = PICTURE * np.array([2, 1, 1, 1], np.float32)
    assert np.array_equal(run(node_type(Code("glsl", text))(), {"image": PICTURE}), doubled)


def test_a_constant_a_struct_and_its_members(run: Run) -> None:
    text = """const int N = 2;
    const float r = 0.5, rgb = 0.25;
    float g = 4.0;
    struct a { float r, g[N]; vec4 rgb; };
    vec4 f(vec4 image) {
        a x;
        x.r = image.r;
        x.g[0] = image.g;
        x.rgb = image;
        return vec4(x.r * r, x.g[N - 2] * g, x.rgb.b * rgb, x.rgb.a);
    }"""
    weighed = PICTURE * np.array([0.5, 4, 0.25, 1], np.float32)
    assert np.array_equal(run(node_type(Code("glsl", text))(), {"image": PICTURE}), weighed)


def test_what_is_prefixed() -> None:
    text = (
        "struct T { float r; }; struct S { highp float r; lowp T t; S2 q[N]; float r, g; }; "
        "const int N = 1, M[2] = int[2](N, 3); float g; T[N] h; float[2][N] l, m; "
        "float r(S s) { float k; return s.r + g + h[0].r + l[0][m]; }"
    )
    assert prefix_names(text, {"r"}, "w_") == (
        "struct w_T { float r; }; struct w_S { highp float r; lowp w_T t; S2 q[w_N]; float r, g; }; "
        "const int w_N = 1, w_M[2] = int[2](w_N, 3); float w_g; w_T[w_N] w_h; float[2][w_N] w_l, w_m; "
        "float w_r(w_S s) { float k; return s.r + w_g + w_h[0].r + w_l[0][w_m]; }"
    )


def test_what_the_driver_refuses_is_left_to_it() -> None:
    assert prefix_names("float[2 g; float h", {"h"}, "w_") == "float[2 g; float w_h"


def test_code_that_ends_anywhere_keeps_its_text() -> None:
    """The driver says what is missing; without the prefixes each start of a text is what it was."""
    text = (
        "struct T { float r; }; const int N = 1, M[2] = int[2](N, 3); float g; T[N] h; float r(T s) { return s.r + g; }"
    )
    for end in range(len(text) + 1):
        assert prefix_names(text[:end], {"r"}, "w_").replace("w_", "") == text[:end]
