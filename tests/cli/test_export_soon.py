"""What shows a picture soon: functions copied for constants, and the draft of a large page."""

from __future__ import annotations

import json
from pathlib import Path

import moderngl
import numpy as np
import pytest
from exported_looks import LOOK, VALIDATOR, open_page, plan_presets, validate
from halation.export.package.dialects import COVERING_VERTEX, write_es300
from halation.export.package.specialization import specialize_functions
from halation.export.web import _turn_curves  # pyright: ignore[reportPrivateUsage]

CHOOSING = """#version 410 core
uniform sampler2D t0;
uniform int way;
layout(location = 0) out vec4 o0;
float mixed(int mode, float a, float b) {
    if (mode == 1) return a * b;
    if (mode == 2) return a + b;
    return a;
}
vec2 mixed(int mode, vec2 a) { return vec2(mixed(mode, a.x, a.y), 0.0); }
void shade(int mode, bool clipped, vec4 c, out float result) {
    result = mixed(mode, c.x, mixed(2, c.y, 0.5));
    if (clipped) result = min(result, 1.0);
}
float count(int steps, float c) {
    while (steps > 0) { --steps; c *= 0.5; }
    return c;
}
float never() { return 7.0; }
void main() {
    vec4 c = texelFetch(t0, ivec2(gl_FragCoord.xy), 0);
    float a, b;
    shade(1, true, c, a);
    shade(way, false, c, b);
    vec2 d = mixed(2, c.xy);
    o0 = vec4(a, b, count(3, c.x), d.x);
}
"""


def draw_pixel(program: str, pixel: tuple[float, ...], way: int) -> np.ndarray:
    """The four channels that a program makes of one pixel."""
    context = moderngl.create_standalone_context(backend="egl")
    built = context.program(COVERING_VERTEX, program)
    built["way"] = way
    context.texture((1, 1), 4, np.array(pixel, np.float32).tobytes(), dtype="f4").use(0)
    target = context.simple_framebuffer((1, 1), 4, dtype="f4")
    target.use()
    context.vertex_array(built, []).render(moderngl.TRIANGLES, vertices=3)
    shown = np.frombuffer(target.read(components=4, dtype="f4"), np.float32)
    context.release()
    return shown


def test_functions_are_copied_for_the_constants_of_their_calls() -> None:
    """What changes its parameter, has two forms or gets no constant stays, and what nobody calls is left out."""
    copied = specialize_functions(CHOOSING)
    for name in ("shade_at_1_true", "mixed_at_1", "mixed_at_2", "shade_at_false"):
        assert f"{name}(" in copied
    assert "const int mode = 1;" in copied and "count(3, c.x)" in copied and "never" not in copied
    for way in range(3):
        np.testing.assert_array_equal(*(draw_pixel(text, (0.9, 0.75, 0.0, 1.0), way) for text in (CHOOSING, copied)))


@pytest.mark.skipif(VALIDATOR is None, reason="glslangValidator is not installed")
def test_the_reference_compiler_takes_the_copies_of_all_presets(tmp_path: Path) -> None:
    sources = {each.shader.source for plan in plan_presets() for each in plan.passes}
    texts = {f"{at}.frag": write_es300(specialize_functions(text)) for at, text in enumerate(sorted(sources))}
    assert sum("_at_" in text for text in texts.values()) > 50
    assert not validate(texts, tmp_path)


def test_a_large_page_has_a_draft_of_the_same_programs(cli, graphs, tmp_path: Path) -> None:
    """It has the numbers of the graph as it is, and a page of 480x270 has none."""
    drafts = []
    for size in ("960x540", "480x270"):
        assert cli("export", graphs(**LOOK), "-o", tmp_path / "look.html", "--size", size).code == 0
        content, _ = open_page((tmp_path / "look.html").read_text())
        drafts.append(content["document"].get("draft"))
    draft, none = drafts
    assert none is None and draft["surfaces"][draft["output"]]["size"] == [240, 135]


def test_a_page_has_the_curves_of_a_folder_by_columns(cli, graphs, tmp_path: Path) -> None:
    for name in ("look.html", "look"):
        words = () if name.endswith("html") else ("--to", "glsl")
        assert cli("export", graphs(**LOOK), *words, "-o", tmp_path / name).code == 0
    slots = json.loads((tmp_path / "look" / "passes.json").read_text())["slots"]
    content, _ = open_page((tmp_path / "look.html").read_text())
    curves = list(zip(list_curves(slots), list_curves(content["document"]["slots"]), strict=True))
    assert len(curves) > 5
    for rows, columns in curves:
        repeated = [each if isinstance(each, list) else [each] * len(rows["at"]) for each in columns["columns"]]
        assert np.transpose(repeated).tolist() == rows["values"] and columns["at"] == rows["at"]
    still = {"base": [1.0, 2.0], "curves": [{"knob": "frame", "at": [1.0, 2.0], "values": [[3.0, 4.0], [5.0, 4.0]]}]}
    assert _turn_curves(still)["curves"] == [{"knob": "frame", "at": [1.0, 2.0], "columns": [(3.0, 5.0), 4.0]}]


def list_curves(slots: list[dict]) -> list[dict]:
    return [curve for slot in slots for curve in slot.get("curves", ())]


def test_a_folder_has_no_draft(cli, graphs, tmp_path: Path) -> None:
    assert cli("export", graphs(**LOOK), "--to", "glsl", "-o", tmp_path / "look", "--size", "960x540").code == 0
    assert "draft" not in (tmp_path / "look" / "passes.json").read_text()
