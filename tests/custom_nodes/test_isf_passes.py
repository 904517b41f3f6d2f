"""Passes of shaders in the Interactive Shader Format: buffers, their sizes, and what they remember."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import Run
from halation.errors import GraphError, HalationError
from halation.nodes import Filter, Temporal
from halation.renderer import FrameRenderer, Renderer, RenderRequest
from isf_files import IMAGE, graph_of_node, isf, node, opaque, shader

H, W = 12, 20
PICTURE = opaque(H, W)
GROW = """if (PASSINDEX == 0) gl_FragColor = IMG_THIS_PIXEL(sum) + vec4(step, 0.0, 0.0, 1.0);
else gl_FragColor = vec4(IMG_THIS_PIXEL(sum).rg, IMG_NORM_PIXEL(sum, vec2(0.5)).r, 1.0);"""
STEP = {"NAME": "step", "TYPE": "float", "DEFAULT": 0.3}


def reel(renderer: Renderer, item: Filter, size: tuple[int, int] = (4, 3)) -> FrameRenderer:
    return FrameRenderer(renderer, graph_of_node(item, size), RenderRequest(precision="float"))


@pytest.mark.parametrize("floating", [True, False])
def test_a_persistent_buffer_adds_up(renderer: Renderer, floating: bool) -> None:
    """0.3 more each frame; memory of bytes ends at 1."""
    buffer = {"TARGET": "sum", "PERSISTENT": True, **({"FLOAT": "true"} if floating else {})}
    item = node(GROW, STEP, PASSES=[buffer, {}])
    assert isinstance(item, Temporal)
    made = [float(reel(renderer, item).render_frame(frame)["out"][1, 2, 0]) for frame in range(1, 7)]
    wanted = [0.3 * frame if floating else min(1.0, 0.3 * frame) for frame in range(1, 7)]
    assert np.allclose(made, wanted, atol=1e-6)


def test_runs_split_over_frames_make_the_same_pictures(renderer: Renderer) -> None:
    """In order, backwards, and one frame alone: whoever starts late is led up to the frame."""
    item = node(GROW, STEP, PASSES=[{"TARGET": "sum", "PERSISTENT": 1, "FLOAT": 1}, {}])
    whole = reel(renderer, item)
    inorder = {frame: whole.render_frame(frame)["out"] for frame in range(1, 6)}
    back = reel(renderer, item)
    for frame in (5, 2, 4, 1, 3):
        assert np.array_equal(back.render_frame(frame)["out"], inorder[frame])
        renderer.runner.textures.release_idle()
        assert np.array_equal(reel(renderer, item).render_frame(frame)["out"], inorder[frame])


def test_two_memories_are_told_apart(renderer: Renderer) -> None:
    """One buffer counts, another halves the distance to it, one frame behind."""
    body = """if (PASSINDEX == 0) gl_FragColor = vec4(mix(IMG_THIS_PIXEL(slow).r, IMG_THIS_PIXEL(fast).r, 0.5));
    else if (PASSINDEX == 1) gl_FragColor = vec4(IMG_THIS_PIXEL(fast).r + 1.0);
    else gl_FragColor = vec4(IMG_THIS_PIXEL(fast).r, IMG_THIS_PIXEL(slow).r, 0.0, 1.0);"""
    kept = {"PERSISTENT": True, "FLOAT": True, "WIDTH": "1", "HEIGHT": 1}
    passes = [{"TARGET": name, **kept} for name in ("slow", "fast")]
    one = reel(renderer, node(body, PASSES=[*passes, {}]))
    slow = fast = 0.0
    for frame in range(1, 7):
        slow, fast = 0.5 * (slow + fast), fast + 1.0
        assert np.allclose(one.render_frame(frame)["out"][0, 0, :2], [fast, slow], atol=1e-6)


def test_later_passes_read_earlier_ones(run: Run) -> None:
    """Two passes blur along x and y; a reader of a buffer that is not drawn yet sees black."""
    body = """vec2 by = PASSINDEX == 0 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    vec4 sum = vec4(0.0);
    for (int k = -1; k <= 1; k++) {
        vec2 at = gl_FragCoord.xy + by * float(k);
        sum += PASSINDEX == 0 ? IMG_PIXEL(inputImage, at) + IMG_PIXEL(half, at) : IMG_PIXEL(half, at);
    }
    gl_FragColor = sum / 3.0;"""
    made = run(node(body, IMAGE, PASSES=[{"TARGET": "half", "FLOAT": True}, {}]), {"inputImage": PICTURE})
    padded = np.pad(PICTURE, ((1, 1), (1, 1), (0, 0)), "edge")
    wanted = sum(padded[y : y + H, x : x + W] for y in range(3) for x in range(3)) / 9.0
    assert np.abs(made - wanted).max() < 1e-5


def test_sizes_of_buffers(run: Run) -> None:
    body = """if (PASSINDEX == 0) gl_FragColor = vec4(RENDERSIZE, 0.0, 1.0);
    else gl_FragColor = vec4(IMG_NORM_PIXEL(small, vec2(0.5)).xy, RENDERSIZE.x, 1.0);"""
    passes = [{"TARGET": "small", "FLOAT": True, "WIDTH": "max(floor($WIDTH*$k), 1.0)", "HEIGHT": "$HEIGHT/5.0"}, {}]
    k = {"NAME": "k", "TYPE": "float", "DEFAULT": 0.25}
    made = run(node(body, k, PASSES=passes), size=(W, H))
    assert made.shape == (H, W, 4) and np.array_equal(made[0, 0, :3], [5.0, 2.0, 20.0])
    assert np.array_equal(run(node(body, k, values={"k": 0.0}, PASSES=passes), size=(W, H))[0, 0, :2], [1.0, 2.0])


def test_the_buffer_of_the_last_pass_is_the_picture(run: Run) -> None:
    made = run(
        node("gl_FragColor = vec4(0.5);", PASSES=[{}, {"TARGET": "last", "WIDTH": "3", "HEIGHT": "2"}]), size=(W, H)
    )
    assert made.shape == (2, 3, 4) and np.allclose(made, [0.25, 0.25, 0.25, 0.5])


def test_buffers_of_version_1(renderer: Renderer) -> None:
    for old in (["sum"], {"sum": {"FLOAT": True, "WIDTH": "2"}}):
        item = node(GROW, STEP, PASSES=[{"TARGET": "sum"}, {}], PERSISTENT_BUFFERS=old)
        one = reel(renderer, item)
        assert np.allclose([one.render_frame(frame)["out"][0, 0, 0] for frame in (1, 2)], [0.3, 0.6], atol=1e-6)


def test_bytes_hold_0_to_1_and_the_picture_more(run: Run) -> None:
    body = "gl_FragColor = PASSINDEX == 0 ? vec4(4.0, -1.0, 0.5, 1.0) : vec4(IMG_THIS_PIXEL(a).rgb * 8.0, 1.0);"
    made = run(node(body, PASSES=[{"TARGET": "a"}, {}]), size=(1, 1))[0, 0]
    assert np.allclose(made, [8.0, 0.0, 4.0, 1.0])


def test_frames_follow_each_other_only_if_something_is_remembered() -> None:
    assert not issubclass(shader(isf("gl_FragColor = vec4(1.0);", PASSES=[{"TARGET": "a"}])), Temporal)


@pytest.mark.parametrize(
    ("width", "said"),
    [
        ("1/($k-$k)", r"WIDTH of the buffer 'a', '1/\(\$k-\$k\)': it divides by 0"),
        ("10^9", "1000000000x12 pixels"),
        ("exp(99999)", "has no value"),
        ("sqrt(-1)", "has no value"),
    ],
)
def test_sizes_that_cannot_be(run: Run, width: str, said: str) -> None:
    k = {"NAME": "k", "TYPE": "float"}
    item = node("gl_FragColor = vec4(1.0);", k, PASSES=[{"TARGET": "a", "WIDTH": width}, {}])
    last = node("gl_FragColor = IMG_THIS_PIXEL(a);", k, PASSES=[{"TARGET": "a", "WIDTH": width}, {}])
    with pytest.raises(HalationError, match=said) as found:
        run(last, size=(W, H))
    assert found.value.node == "node"
    if not isinstance(found.value, GraphError):
        run(item, size=(W, H))  # a buffer that nothing reads is not made
