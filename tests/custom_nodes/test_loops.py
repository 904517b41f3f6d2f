"""Loops of user code: those that might not end do, and pixels of all others stay what they are."""

from __future__ import annotations

import re

import numpy as np
import pytest
from conftest import Run, graph_of
from halation.custom_nodes import Code, node_type
from halation.errors import ShaderError
from halation.glsl import blank_comments
from halation.glsl.loops import COUNTER, guard_loops
from halation.renderer import Renderer, RenderRequest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

CHECK = re.compile(rf"(?: |\{{ )if \(\+\+{COUNTER} > \d+\) break; ")
PICTURE = np.random.default_rng(7).random((3, 5, 4)).astype(np.float32)


def checks(text: str) -> int:
    """How many loops are counted."""
    return len(CHECK.findall(guard_loops(text)))


@pytest.mark.parametrize(
    "loop",
    [
        "for (int i = 0; i < 8; ++i) n++;",
        "for (int i = 8; i > 0; i -= 3) { n++; }",
        "for (int i = -3; i <= 3; i++) n++;",
        "for (float t = 0.0; t < 1.0; t += 0.125) n++;",
        "for (int i = 0; i < N * 4; i++) n++;",
        "for (int i = 0; i < M; i++) n++;",
        "for (int i = 0; i < 64 && n < m; i++) n++;",
        "for (uint i = 0u; i < 9u; i++) n++;",
        "for (int i = 0; i != 8; i += 2) n++;",
        "for (int y = 0; y < 99; y++) for (int x = 0; x < 99; x++) n += x * y;",
        "for (int i = 0; i < 8; i++) { if (i == 3) continue; n = i; }",
        "// while (true) n++;\n",
        "/* for (;;) */ n++;",
    ],
)
def test_loops_that_say_how_often_they_run_are_left_alone(loop: str) -> None:
    text = f"#define N 8\nconst int M = 3 + 4;\nvoid f(int m) {{ int n = 0; {loop} }}"
    assert guard_loops(text) == blank_comments(text)


@pytest.mark.parametrize(
    "loop",
    [
        "while (true) n++;",
        "while (n < m) { n++; }",
        "do n++; while (n < m);",
        "do { n++; } while (true);",
        "for (;;) { n++; }",
        "for (int i = 0; i < m; i++) n++;",
        "for (int i = 0; i < 8; i++) { i--; }",
        "for (int i = 0; i < 8; i++) { i = 0; }",
        "for (int i = 0; i < 8; i--) n++;",
        "for (int i = 0; i < 8; i += 0) n++;",
        "for (int i = 0; i < 8; i += 1 / 2) n++;",
        "for (uint i = 8u; i >= 0u; i--) n++;",
        "for (int i = 0; i != 7; i += 2) n++;",
        "for (float t = 1e9; t < 1e9 + 9.0; t += 1.0) n++;",
        "for (int i = 0; i < 100000000; i++) n++;",
        "for (int i = 0; i < 8 || n < m; i++) n++;",
        "for (int i = 0; n < 8; i++) m++;",
        "for (int i = 0; i < 8; change(i)) n++;",
        "for (int i = 0; i < 8; i++) change(i);",
        "for (int i = 0; i < K; i++) n++;",
        "int i = 0; for (; i < 8;) n++;",
        "for (int i = 0, j = 3; i < 8; i++) n++;",
        "for (int i = 0; i < 8; i++, n++) m++;",
        "while (n < 8 && i-- > 0) ;",
    ],
)
def test_loops_that_might_not_end_are_counted(loop: str) -> None:
    head = "#define K 8\n#undef K\n#define K m\nvoid change(inout int i) { i = 0; }\n"
    text = f"{head}void f(int m) {{ int n = 0; {loop} }}"
    assert checks(text) == 1
    assert guard_loops(text).count("\n") == text.count("\n")


def test_every_loop_of_a_nest_is_counted_once() -> None:
    nest = "if (a) while (b) for (int i = 0; i < 4; i++) do if (c) x++; else y++; while (d); else for (;;) { }"
    text = f"void f() {{ {nest} }}"
    assert checks(text) == 3
    assert CHECK.sub("", guard_loops(text)).replace(" }", "").replace("{", "") == text.replace(" }", "").replace(
        "{", ""
    )
    thousands = "for (int i = 0; i < 3000; i++) "
    assert checks(f"void f() {{ {thousands} n++; }}") == 0
    assert checks(f"void f() {{ {thousands * 2} n++; }}") == 1


@pytest.mark.parametrize("text", ["void f() { for (", "while", "do", "void f() { while (a", "}{", "for (;;", ""])
def test_text_that_is_no_code_stays(text: str) -> None:
    assert guard_loops(text) == text


@given(st.text(st.sampled_from("whiledofr()[]{};,<>=+- \n#\\'\"/*0123456789i"), max_size=80))
def test_any_text_keeps_its_lines(text: str) -> None:
    assert guard_loops(text).count("\n") == blank_comments(text).count("\n")


def test_code_without_an_end_is_not_a_number(run: Run) -> None:
    text = """
    void turn(inout int n) { while (n < 10) { n = (n + 1) & 7; } }
    vec4 hang(vec4 image) { int n = 0; if (image.r > 0.5) turn(n); return image + float(n); }"""
    made = run(node_type(Code("glsl", text))(), {"image": PICTURE})
    hung = PICTURE[..., 0] > 0.5
    assert 0 < hung.sum() < hung.size
    assert np.isnan(made[hung]).all() and np.array_equal(made[~hung], PICTURE[~hung])
    text = """void hang(vec4 image, out vec4 a, out float b) {
        a = image; b = image.r; for (int i = 0; b > 0.5; i++) a.g = float(i); }"""
    kind = node_type(Code("glsl", text))
    made = run(kind(), {"image": PICTURE}, output="b")
    assert np.isnan(made[hung]).all() and np.array_equal(made[~hung][..., 0], PICTURE[~hung][..., 0])


def test_a_counted_neighborhood_is_what_numpy_says(run: Run) -> None:
    text = """vec4 box(vec4 image, int radius /* = 1 */) {
        vec4 sum = vec4(0.0);
        for (int y = -radius; y <= radius; y++)
            for (int x = -radius; x <= radius; x++)
                sum += image_at(pixel + ivec2(x, y));
        return sum / float((2 * radius + 1) * (2 * radius + 1)); }"""
    assert checks(text) == 2
    made = run(node_type(Code("glsl", text))(), {"image": PICTURE})
    wide = np.pad(PICTURE.astype(np.float64), ((1, 1), (1, 1), (0, 0)), "edge")
    wanted = sum(wide[y : y + 3, x : x + 5] for y in range(3) for x in range(3)) / 9.0
    assert np.abs(made - wanted).max() < 1e-6


def test_a_driver_names_lines_and_functions_as_they_were_written(run: Run) -> None:
    text = "vec4 hang(vec4 image) {\n  while (image.r > 0.0) { image -= 0.1; }\n  return wrong(image);\n}"
    with pytest.raises(ShaderError, match=r"the code of 'hang', line 3: .*wrong") as fault:
        run(node_type(Code("glsl", text))(), {"image": PICTURE})
    assert "x_hang" not in str(fault.value)


def _choice(first: tuple[str, str], second: tuple[str, str]) -> tuple[str, str]:
    glsl = f"if (n % 2 == 0) {first[0]} else {second[0]}"
    return f"{{ {glsl} }}", f"if n % 2 == 0:\n{_in(first[1])}\nelse:\n{_in(second[1])}"


def _counted(rounds: int, inner: tuple[str, str]) -> tuple[str, str]:
    return f"for (int i = 0; i < {rounds}; ++i) {inner[0]}", f"for _ in range({rounds}):\n{_in(inner[1])}"


def _until(rounds: int, first: bool, inner: tuple[str, str]) -> tuple[str, str]:
    """A loop whose end only running it tells; `k` counts afresh for each."""
    body = f"{{ {inner[0]} k++; }}"
    loop = f"while (k < {rounds}) {body}" if first else f"do {body} while (k < {rounds});"
    return f"{{ int k = 0; {loop} }}", f"for _ in range({rounds}):\n{_in(inner[1])}"


def _in(text: str) -> str:
    return "\n".join("    " + line for line in text.split("\n"))


STEPS = st.integers(1, 9).map(lambda k: (f"n = (n * 3 + {k}) % 4093;", f"n = (n * 3 + {k}) % 4093"))
STATEMENTS = st.recursive(
    STEPS,
    lambda inner: st.one_of(
        st.builds(_choice, inner, inner),
        st.builds(_counted, st.integers(0, 3), inner),
        st.builds(_until, st.integers(1, 3), st.booleans(), inner),
    ),
    max_leaves=4,
)


@settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(STATEMENTS, min_size=1, max_size=2))
def test_random_loops_make_what_python_makes(renderer: Renderer, parts: list[tuple[str, str]]) -> None:
    made: dict[str, int] = {"n": 1}
    exec("\n".join(python for _, python in parts), made)
    code = " ".join(glsl for glsl, _ in parts)
    kind = node_type(Code("glsl", f"vec4 f(vec4 image) {{ int n = 1; {code} return image * float(n); }}"))
    ones = {"image": np.ones_like(PICTURE)}
    found = renderer.render(graph_of(kind(), ones), RenderRequest(ones))["out"]
    assert (found == made["n"]).all(), code


def test_loops_that_make_a_million_rounds_together_are_believed() -> None:
    """2^20 of them, 1024 times 1024 with the last test of each loop; one more is counted at run time."""
    nest = "for (int i = 0; i < 1023; i++) for (int j = 0; j < %d; j++) n += i;"
    assert (checks(nest % 1023), checks(nest % 1024)) == (0, 1)
