"""Shaders in the Interactive Shader Format against numpy: what they read, where, and what they are told."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from conftest import Run
from halation import document
from halation.custom_nodes import CustomNode
from halation.custom_nodes.isf.header import IsfInput
from halation.custom_nodes.isf.inputs import is_position, make_isf_value, make_uniform
from halation.errors import InputError, ShaderError
from halation.graph import Output, Port
from halation.nodes import Kind
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from halation.resources.sandbox import UNRESTRICTED
from isf_files import IMAGE, decode_srgb, encode_srgb, graph_of_node, isf, node, opaque, shader

H, W = 13, 21
PICTURE = opaque(H, W)
OTHER = opaque(H, W, 2)
ROWS, COLUMNS = np.mgrid[0:H, 0:W].astype(np.float32)
UP = H - ROWS - 0.5
"""Where rows are, counted from the bottom, in pixels."""
ACROSS = COLUMNS + 0.5


def close(a: Any, b: Any, far: float = 2e-6) -> bool:
    return bool(np.abs(np.asarray(a) - np.asarray(b)).max() <= far)


def test_positions_run_from_the_bottom_left(run: Run) -> None:
    made = run(node("gl_FragColor = vec4(gl_FragCoord.xy, isf_FragNormCoord.y, 1.0);"), size=(W, H))
    assert close(made[..., :2], np.stack([ACROSS, UP], 2)) and close(made[..., 2], UP / H)


@pytest.mark.parametrize(
    "read",
    [
        "IMG_THIS_PIXEL(inputImage)",
        "IMG_THIS_NORM_PIXEL(inputImage)",
        "IMG_NORM_THIS_PIXEL(inputImage)",
        "IMG_NORM_PIXEL(inputImage, isf_FragNormCoord)",
        "IMG_PIXEL(inputImage, gl_FragCoord.xy)",
        "IMG_PIXEL(inputImage, isf_FragNormCoord.xy * (IMG_SIZE(inputImage)))",
        "texture2D(inputImage, vec2((isf_FragNormCoord.x), isf_FragNormCoord.y))",
        "texelFetch(inputImage, ivec2(gl_FragCoord.xy), 0)",
        "IMG_PIXEL(inputImage, gl_FragCoord.xy / RENDERSIZE * _inputImage_imgRect.zw)",
    ],
)
def test_every_way_to_read_its_own_pixel(run: Run, read: str) -> None:
    made = run(node(f"gl_FragColor = {read}; // IMG_PIXEL(( unbalanced in a comment", IMAGE), {"inputImage": PICTURE})
    assert close(made, PICTURE, 1e-5)


def test_neighbors_and_the_edge(run: Run) -> None:
    text = "gl_FragColor = IMG_PIXEL(inputImage, gl_FragCoord.xy + vec2(1.0, 2.0));"
    made = run(node(text, IMAGE), {"inputImage": PICTURE})
    rows, columns = np.clip(np.arange(H) - 2, 0, H - 1), np.clip(np.arange(W) + 1, 0, W - 1)
    assert close(made, PICTURE[rows][:, columns], 1e-5)
    made = run(
        node("gl_FragColor = IMG_PIXEL(inputImage, gl_FragCoord.xy + vec2(0.5, 0.0));", IMAGE), {"inputImage": PICTURE}
    )
    assert close(made, 0.5 * (PICTURE + PICTURE[:, np.clip(np.arange(W) + 1, 0, W - 1)]), 2e-3)


def test_derivatives_run_upward(run: Run) -> None:
    made = run(
        node("gl_FragColor = vec4(dFdx(gl_FragCoord.x), dFdy(gl_FragCoord.y), dFdy(-gl_FragCoord.xy).y, 1.0);"),
        size=(8, 8),
    )
    assert close(made, np.broadcast_to([1.0, 1.0, -1.0, 1.0], (8, 8, 4)))


def test_every_type_of_value(run: Run) -> None:
    inputs: list[dict[str, Any]] = [
        {"NAME": "level", "TYPE": "float", "DEFAULT": 0.25, "MIN": 0.0, "MAX": 2.0, "LABEL": "How Much"},
        {"NAME": "flag", "TYPE": "bool", "DEFAULT": 1},
        {"NAME": "hit", "TYPE": "event"},
        {"NAME": "mode", "TYPE": "long", "VALUES": [3, 7, 9], "LABELS": ["Three", "Same", "Same"], "DEFAULT": 7},
        {"NAME": "count", "TYPE": "long", "DEFAULT": 4, "MIN": 1, "MAX": 8},
        {"NAME": "tint", "TYPE": "color", "DEFAULT": [0.5, 0.0, 1.0, 0.75]},
        {"NAME": "spot", "TYPE": "point2D", "DEFAULT": [0.25, 0.125], "MIN": [0, 0], "MAX": [1, 1]},
        {"NAME": "step", "TYPE": "point2D", "DEFAULT": [-3.0, 40.0]},
    ]
    kind = shader(
        isf(
            "gl_FragColor = vec4(level, float(mode) + (flag ? 0.5 : 0.0) + (hit ? 0.25 : 0.0), float(count), 1.0);"
            "if (gl_FragCoord.x > 1.0) gl_FragColor = vec4(tint.rgb, 1.0);"
            "if (gl_FragCoord.x > 2.0) gl_FragColor = vec4(tint.a, spot, 1.0);"
            "if (gl_FragCoord.x > 3.0) gl_FragColor = vec4(step + vec2(10.0, 0.0), 0.0, 1.0);",
            *inputs,
        )
    )
    made = run(kind(light="linear"), size=(4, 1))[0]
    assert close(made[0], [0.25, 7.5, 4.0, 1.0]) and close(made[2, :3], [0.75, 0.25, 0.125])
    assert close(made[3, :3], [7.0, 40.0, 0.0]) and close(made[1, :3], decode_srgb(np.array([0.5, 0.0, 1.0])), 1e-6)
    made = run(
        kind(light="linear", level=1.5, mode="Same (2)", flag=False, hit=True, count=2, spot=(0.5, 1.0)), size=(4, 1)
    )[0]
    assert close(made[0], [1.5, 9.25, 2.0, 1.0]) and close(made[2, :3], [0.75, 0.5, 0.0])
    values = kind.values
    assert values["mode"].choices == ("Three", "Same", "Same (2)") and values["mode"].default == "Same"
    assert values["level"].label == "How Much" and (values["level"].low, values["level"].high) == (0.0, 2.0)
    assert values["spot"].handle and values["spot"].default == (0.25, 0.875) and not values["step"].handle


def test_defaults_that_nobody_wrote() -> None:
    """The middle of a point's range, opaque black, of a number 0 or the end of the range that is nearest to it, and the
    first of several choices, as of one that is none of them.
    """
    kind = shader(
        isf(
            "gl_FragColor = vec4(1.0);",
            {"NAME": "point", "TYPE": "point2D", "MIN": [2.0, -10.0], "MAX": [6.0, 30.0]},
            {"NAME": "free", "TYPE": "point2D"},
            {"NAME": "tint", "TYPE": "color"},
            {"NAME": "number", "TYPE": "float"},
            {"NAME": "above", "TYPE": "float", "MIN": 2.0, "MAX": 5.0},
            {"NAME": "below", "TYPE": "float", "MIN": -5.0, "MAX": -1.0},
            {"NAME": "how_much_noise", "TYPE": "float", "MIN": 0.0, "MAX": 1.0},
            {"NAME": "mode", "TYPE": "long", "VALUES": [7, 3], "LABELS": ["Seven", "Three"]},
            {"NAME": "other", "TYPE": "long", "VALUES": [7, 3], "LABELS": ["Seven", "Three"], "DEFAULT": 5},
        )
    )
    assert kind.values["how_much_noise"].label == "how much noise"
    assert {name: value.default for name, value in kind.values.items() if name != "light"} == {
        "point": (4.0, 10.0),
        "free": (0.0, 0.0),
        "tint": (0.0, 0.0, 0.0, 1.0),
        "number": 0.0,
        "above": 2.0,
        "below": -1.0,
        "how_much_noise": 0.0,
        "mode": "Seven",
        "other": "Seven",
    }


def test_values_change_no_program(renderer: Renderer) -> None:
    body = "gl_FragColor = vec4(level + TIME * float(PASSINDEX));"
    level = {"NAME": "level", "TYPE": "float", "DEFAULT": 0.5}
    texts = set()
    for value, frame in ((0.1, 1), (0.9, 7)):
        plan = renderer.compile(
            graph_of_node(node(body, level, values={"level": value}), (4, 4)), RenderRequest(frame=frame)
        )
        texts.add(tuple(one.shader for one in plan.passes))
    assert len(texts) == 1


def test_what_a_shader_is_told_of_time(renderer: Renderer) -> None:
    body = """gl_FragColor = vec4(TIME, TIMEDELTA, float(FRAMEINDEX), 1.0);
    if (gl_FragCoord.x > 1.0) gl_FragColor = vec4(DATE.xyz / 1000.0, 1.0);
    if (gl_FragCoord.x > 2.0) gl_FragColor = vec4(DATE.w, float(PASSINDEX), 0.0, 1.0);"""
    reel = FrameRenderer(renderer, graph_of_node(node(body), (3, 1), (5, 90), 20.0), RenderRequest(precision="float"))
    first, later = reel.render_frame(5)["out"][0], reel.render_frame(15)["out"][0]
    assert close(first[0, :3], 0.0) and close(later[0, :3], [0.5, 0.05, 10.0])
    assert close(later[1, :3], [2.0, 0.001, 0.001]) and close(later[2, :3], [0.5, 0.0, 0.0])


def test_what_does_not_ask_the_time_is_the_same_at_every_frame(renderer: Renderer) -> None:
    graph = graph_of_node(node("gl_FragColor = vec4(RENDERSIZE, 0.0, 1.0);"), (4, 4))
    plans = [renderer.compile(graph, RenderRequest(frame=frame)) for frame in (1, 5)]
    assert len({plan.surfaces[plan.outputs["out"]].key for plan in plans}) == 1


def test_display_values_and_straight_alpha(run: Run) -> None:
    """A shader that passes its picture on changes nothing; one that halves display values halves those."""
    soft = PICTURE * OTHER[..., :1]
    kind = shader(
        isf(
            "gl_FragColor = IMG_THIS_PIXEL(inputImage) * vec4(vec3(k), 1.0);",
            IMAGE,
            {"NAME": "k", "TYPE": "float", "DEFAULT": 1.0},
        )
    )
    bright = soft * np.array([4.0, 4.0, 4.0, 1.0], np.float32)
    assert close(run(kind(), {"inputImage": bright}), bright, 2e-5)
    assert close(run(kind(light="linear"), {"inputImage": bright}), bright, 2e-5)
    color = soft[..., :3] / soft[..., 3:]
    wanted = decode_srgb(0.5 * encode_srgb(color)) * soft[..., 3:]
    assert close(run(kind(k=0.5), {"inputImage": soft})[..., :3], wanted, 2e-5)


def test_color_that_nothing_covers_is_not_seen(run: Run) -> None:
    made = run(node("gl_FragColor = vec4(1.0, 2.0, 3.0, isf_FragNormCoord.x < 0.5 ? 0.0 : 9.0);"), size=(2, 1))[0]
    assert close(made, [[0.0] * 4, [1.0, 2.0, 3.0, 1.0]])


def test_transitions_have_two_pictures(run: Run) -> None:
    body = "gl_FragColor = mix(IMG_THIS_PIXEL(startImage), IMG_THIS_PIXEL(endImage), progress);"
    ends = [{"NAME": name, "TYPE": "image"} for name in ("startImage", "endImage")]
    item = node(body, *ends, {"NAME": "progress", "TYPE": "float", "DEFAULT": 0.25, "MIN": 0, "MAX": 1})
    made = run(item, {"startImage": PICTURE, "endImage": OTHER})
    assert close(made, PICTURE * 0.75 + OTHER * 0.25, 1e-5)


def test_other_pictures_keep_their_size_or_stay_unlinked(run: Run) -> None:
    body = "gl_FragColor = vec4(IMG_SIZE(inputImage), IMG_SIZE(mask)) / 100.0; gl_FragColor.a = 1.0 + IMG_SIZE(mask).y;"
    item = node(
        body + "gl_FragColor.r = IMG_NORM_PIXEL(mask, vec2(0.999, 0.001)).r;", IMAGE, {"NAME": "mask", "TYPE": "image"}
    )
    mask = opaque(3, 5)
    made = run(item, {"inputImage": PICTURE, "mask": mask})
    assert made.shape == (H, W, 4) and close(made[0, 0, 1:3], [0.13, 0.05])
    assert close(made[0, 0, 0], mask[2, 4, 0], 1e-5)
    made = run(item, {"inputImage": PICTURE})
    assert close(made[..., 0], 0.0) and close(made[0, 0, 2], 0.01)


def test_sound_is_silent_or_a_picture(run: Run) -> None:
    item = node(
        "gl_FragColor = vec4(IMG_NORM_PIXEL(wave, isf_FragNormCoord).rgb, 1.0);",
        {"NAME": "wave", "TYPE": "audio", "MAX": 16},
    )
    assert item.inputs["wave"].kind is Kind.FIELD and item.inputs["wave"].optional
    assert close(run(item, size=(4, 4))[..., :3], 0.0)
    wave = PICTURE[:, :, 0]
    assert close(run(item, {"wave": wave})[..., 1], wave, 1e-5)


def test_a_vertex_shader(run: Run) -> None:
    """It hands on what it computes, moves the corners, and sees rows from the bottom."""
    fragment = "varying vec2 at;\nvoid main() { gl_FragColor = vec4(at, isf_FragNormCoord.y, 1.0); }"
    vertex = "varying vec2 at;\nvoid main() { isf_vertShaderInit(); at = isf_FragNormCoord * 3.0; }"
    made = run(shader(isf(fragment), vertex, "a.fs")(light="linear"), size=(W, H))
    assert close(made[..., :3], np.stack([ACROSS / W * 3, UP / H * 3, UP / H], 2), 1e-5)
    lower = "void main() { vv_vertShaderInit(); if (gl_Position.y > 0.0) gl_Position.y = 0.0; }"
    made = run(shader(isf("gl_FragColor = vec4(1.0);"), lower, "b.fs")(light="linear"), size=(4, 4))
    assert close(made[:2], 0.0) and close(made[2:], 1.0)


def test_version_1_and_old_words(run: Run) -> None:
    body = """#version 120
    float sample(float input) { float smooth = input; return smooth; }
    void main(void) {
        vec4 texture = IMG_THIS_PIXEL(inputImage);
        gl_FragColor = vec4(texture.rgb * sample(vv_FragNormCoord.x), 1.0);
    }
    """
    made = run(shader(isf(body, IMAGE, ISFVSN=None))(light="linear"), {"inputImage": PICTURE})
    assert close(made[..., :3], PICTURE[..., :3] * (ACROSS / W)[..., None], 1e-5)


def test_names_that_mean_something_to_python_or_to_the_node(run: Run) -> None:
    names = ("in_", "lambda", "values", "light", "input")
    inputs = [{"NAME": name, "TYPE": "float", "DEFAULT": 0.25} for name in names]
    kind = shader(isf("gl_FragColor = vec4(lambda, values, light, input + in_);", *inputs))
    made = run(kind(lambda_=0.5, values_=0.75, light_=1.0, light="linear", input=0.5), size=(1, 1))[0, 0]
    assert close(made, [0.375, 0.5625, 0.75, 0.75])


def test_what_is_not_finite_or_not_drawn_is_black(run: Run) -> None:
    body = "if (gl_FragCoord.x > 2.0) discard; gl_FragColor = vec4(1.0 / (gl_FragCoord.x - 0.5), 0.0, 0.0, 1.0);"
    made = run(node(body), size=(3, 1))[0]
    assert close(made[:, 0], [0.0, 1.0, 0.0]) and close(made[:, 3], [1.0, 1.0, 0.0])


def test_a_loop_that_never_ends_is_seen(run: Run) -> None:
    made = run(node("float x = 0.0; while (TIME < 1.0) x += 1.0; gl_FragColor = vec4(x);"), size=(1, 1))
    assert np.isnan(made[..., :3]).all()


def test_pictures_of_its_folder(renderer: Renderer, tmp_path: Path) -> None:
    (tmp_path / "art" / "below").mkdir(parents=True)
    stored = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3) * 14
    cv2.imwrite(str(tmp_path / "art" / "below" / "six.png"), stored[..., ::-1])
    text = isf("gl_FragColor = IMG_PIXEL(six, gl_FragCoord.xy);", IMPORTED={"six": {"PATH": "below/six.png"}})
    (tmp_path / "art" / "own.fs").write_text(text)
    raw = (
        '{"halation": 1, "settings": {"size": [3, 2]}, "outputs": {"out": {"type": "Image"}}, "nodes": {"a": '
        '{"type": "isf", "file": "art/own.fs", "values": {"light": "linear"}}}, "links": {"outputs.out": "a.out"}}'
    )
    (tmp_path / "graph.json").write_text(raw)
    graph = document.load(tmp_path / "graph.json", sandbox=UNRESTRICTED)
    for wanted in (RenderRequest(), RenderRequest(size=(6, 4))):
        made = renderer.render(graph, wanted)["out"][-2:, :3]
        assert close(made[..., :3] * 255.0, stored, 0.05)
    outside = tmp_path / "outside.png"
    (tmp_path / "art" / "below" / "six.png").rename(outside)
    (tmp_path / "art" / "below" / "six.png").symlink_to(outside)
    with pytest.raises(InputError, match="may not leave"):
        renderer.render(document.load(tmp_path / "graph.json", sandbox=UNRESTRICTED))


def test_a_document_keeps_it(tmp_path: Path) -> None:
    (tmp_path / "a.fs").write_text(isf("gl_FragColor = vec4(k);", {"NAME": "k", "TYPE": "float", "DEFAULT": 0.5}))
    text = '{"halation": 1, "nodes": {"a": {"type": "isf", "file": "a.fs", "values": {"k": 0.75}}}}'
    (tmp_path / "graph.json").write_text(text)
    graph = document.load(tmp_path / "graph.json", sandbox=UNRESTRICTED)
    saved = document.dumps(graph)
    assert '"file": "a.fs"' in saved and '"k": 0.75' in saved and "gl_FragColor" not in saved
    node = document.loads(saved, folder=str(tmp_path), sandbox=UNRESTRICTED).nodes["a"]
    assert isinstance(node, CustomNode) and node.setting("k") == 0.75


@pytest.mark.parametrize(
    ("fragment", "vertex", "file", "line"),
    [
        ("void main() {\n  gl_FragColor = vec4(nothing);\n}", "", "bad.fs", 3),
        (
            "varying float a;\nvoid main() { gl_FragColor = vec4(a); }",
            "varying float a;\nvoid main() {\n  isf_vertShaderInit();\n  a = wrong(1.0);\n}",
            "bad.vs",
            4,
        ),
    ],
)
def test_a_fault_is_told_at_its_own_line(run: Run, fragment: str, vertex: str, file: str, line: int) -> None:
    with pytest.raises(ShaderError) as found:
        run(shader(isf(fragment), vertex, "bad.fs")(), size=(2, 2))
    assert (found.value.node, found.value.file, found.value.line) == ("node", file, line)


def test_it_lives_among_other_nodes(run: Run) -> None:
    from halation.nodes.color.exposure import Exposure

    graph = graph_of_node(node("gl_FragColor = IMG_THIS_PIXEL(inputImage) * 0.5;", IMAGE), (W, H))
    graph = graph.add("up", Exposure(stops=1.0)).connect(Port("shader", "out"), Port("up", "image"))
    graph = graph.add_output("more", Output(Kind.IMAGE, 4)).connect(Port("up", "out"), Port("outputs", "more"))
    made = run(graph, {"inputImage": PICTURE}, output="more")
    assert close(made[..., :3], PICTURE[..., :3] * 0.5, 1e-5) and close(made[..., 3], 0.5)


BOUNDS = (-0.01, 0.0, 0.25, 1.0, 1.01)
RANGES = [(low, high) for low in product(BOUNDS, repeat=2) for high in product(BOUNDS, repeat=2)]


def test_what_the_file_says_is_what_the_shader_gets() -> None:
    """A point within the picture, ends included, is a place of the node, whose rows run from the top; others are
    numbers, with the range of the file or -1 to 1. Either way the shader gets the numbers of the file."""
    ordered = [(low, high) for low, high in RANGES if low[0] <= high[0] and low[1] <= high[1]]
    for low, high in [*ordered, ((), ()), ((), (1.0, 1.0)), ((0.0, 0.0), ())]:
        entry = IsfInput("spot", "point2D", default=(0.25, 0.125), low=low, high=high)
        value = make_isf_value(entry, "spot")
        is_place = bool(low and high) and all(0.0 <= number <= 1.0 for number in (*low, *high))
        assert is_position(entry) is is_place is value.handle, entry
        assert make_uniform(entry, value.default, True) == (0.25, 0.125)
        if not is_place:
            assert (value.low, value.high) == (min(low or (-1.0,)), max(high or (1.0,)))
