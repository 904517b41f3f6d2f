"""A graph as an effect of ReShade: the compiler of ReShade FX in vkBasalt, and pixels that Vulkan draws with it.

A window shows a picture as a game does, vkBasalt draws the effect over it, and the screen is read. A screen has 8 bits,
so the effect is made to show the bytes of a number: its sign, exponent and the first 15 bits behind.
"""

from __future__ import annotations

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from exr_files import read, write_exr
from game_looks import LOOK, SIZE, export, refuse_unfit_graphs

HERE = Path(__file__).parent
LAYER = Path("/usr/share/vulkan/implicit_layer.d/vkBasalt.json")
FAR = 40.0
"""The depth of the farthest point."""
PATIENCE = 120.0
"""Seconds of real time after which what is not done has failed."""

needs_slang = pytest.mark.skipif(importlib.util.find_spec("slangpy") is None, reason="slangpy is not installed")
needs_game = pytest.mark.skipif(
    not LAYER.exists() or not shutil.which("Xvfb"), reason="vkBasalt or Xvfb is not installed"
)

DEPTH_HEADER = """namespace ReShade {
texture DepthBufferTex : DEPTH;
sampler DepthBuffer { Texture = DepthBufferTex; MinFilter = POINT; MagFilter = POINT; };
float GetLinearizedDepth(float2 uv) { return tex2Dlod(DepthBuffer, float4(uv, 0.0, 0.0)).x; }
}
"""
"""What effects read of ReShade's own header. Without a depth buffer vkBasalt binds the picture, so depth is its red."""

Play = Callable[..., np.ndarray]


def make_picture() -> np.ndarray:
    """Codes that change smoothly, with some noise: [height, width, 4] of uint8."""
    width, height = SIZE
    y, x = np.mgrid[:height, :width]
    waves = [0.5 + 0.4 * np.sin(x / a + y / b + c) for a, b, c in ((9, 14, 0), (17, 8, 2), (11, 21, 4))]
    noise = np.random.default_rng(5).uniform(-0.05, 0.05, (height, width, 3))
    codes = np.round(255.0 * np.clip(np.stack(waves, axis=-1) + noise, 0.0, 1.0)).astype(np.uint8)
    return np.dstack([codes, np.full((height, width), 255, np.uint8)])


def decode(codes: np.ndarray) -> np.ndarray:
    """Light of sRGB codes, by IEC 61966-2-1."""
    share = codes / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def encode(light: np.ndarray) -> np.ndarray:
    """Codes of light as a screen has them, before rounding."""
    light = np.clip(light, 0.0, 1.0)
    return 255.0 * np.where(light <= 0.0031308, light * 12.92, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


@pytest.fixture
def screen(tmp_path: Path) -> Iterator[tuple[str, Path]]:
    """A display of its own, and the file in which it keeps its picture."""
    folder = tmp_path / "screen"
    folder.mkdir()
    reader, writer = os.pipe()
    words = ["Xvfb", "-displayfd", str(writer), "-screen", "0", "320x240x24", "-noreset", "-fbdir", str(folder)]
    server = subprocess.Popen(words, pass_fds=(writer,), stderr=subprocess.DEVNULL)
    os.close(writer)
    try:
        with os.fdopen(reader) as lines:
            yield f":{lines.readline().strip()}", folder / "Xvfb_screen0"
    finally:
        server.terminate()
        server.wait(PATIENCE)


@pytest.fixture
def play(screen: tuple[str, Path], tmp_path: Path) -> Play:
    """`play(effect)` gives the codes on the screen after some frames, `play(effect, "y")` the light of a channel."""
    display, kept = screen
    (tmp_path / "ReShade.fxh").write_text(DEPTH_HEADER)

    def run(effect: Path, channel: str = "", frames: int = 3, picture: np.ndarray | None = None) -> np.ndarray:
        np.save(tmp_path / "game.npy", make_picture() if picture is None else picture)
        text = effect.read_text("utf-8")
        shown = tmp_path / "shown.fx"
        if channel:
            read_bytes = f"uint bits = asuint(light.{channel}); return float4(float3(uint3(bits >> 24, bits >> 16, "
            text, count = re.subn(
                r"return float4\(encode_srgb\(light\.\w+\), 1\.0\);",
                f"{read_bytes}bits >> 8) & 255u) / 255.0, 1.0);",
                text,
            )
            assert count == 1
        shown.write_text(text, "utf-8")
        config = tmp_path / "vkBasalt.conf"
        config.write_text(
            f'effects = shown\nshown = "{shown}"\nreshadeTexturePath = "{effect.parent}"\n'
            f'reshadeIncludePath = "{tmp_path}"\ndepthCapture = off\nenableOnLaunch = True\n'
        )
        log, out = tmp_path / "vkBasalt.log", tmp_path / "screen.npy"
        settings = {"ENABLE_VKBASALT": "1", "VKBASALT_CONFIG_FILE": config, "VKBASALT_LOG_FILE": log}
        environment = {**os.environ, **{name: str(text) for name, text in settings.items()}, "DISPLAY": display}
        words = [sys.executable, HERE / "present_picture.py", tmp_path / "game.npy", kept, frames, out]
        done = subprocess.run(
            [str(w) for w in words], env=environment, capture_output=True, text=True, timeout=PATIENCE
        )
        faults = [line for line in log.read_text().splitlines() if re.search(r"error X|failed", line)]
        assert done.returncode == 0 and not faults, (done.stderr, faults)
        codes = np.load(out)
        if not channel:
            return codes.astype(np.float64)
        high = codes.astype(np.uint32)
        return ((high[..., 0] << 24) | (high[..., 1] << 16) | (high[..., 2] << 8) | 128).view(np.float32)

    return run


def set_control(effect: Path, name: str, number: str) -> None:
    """What a user does with a slider: a shader has no other place for its value here."""
    text, count = re.subn(rf"(uniform \w+ {name} < .* > = ).*;", rf"\g<1>{number};", effect.read_text("utf-8"))
    assert count == 1
    effect.write_text(text, "utf-8")


def render(cli, graph: Path, folder: Path, *words: object) -> np.ndarray:
    """Our own picture of a graph, of the same codes, with their red as depth."""
    codes = make_picture()
    light = decode(codes[..., :3]).astype(np.float32)
    write_exr(folder / "game.exr", {"C": np.dstack([light, np.ones_like(light[..., 0])])}, {"C": "float"})
    write_exr(folder / "far.exr", {"C": codes[..., :1].astype(np.float32) * FAR / 255.0}, {"C": "float"})
    inputs = [word for name, file in (("beauty", "game"), ("depth", "far")) if f'"{name}"' in graph.read_text()
              for word in ("-i", f"{name}={folder / file}.exr")]  # fmt: skip
    result = cli("render", graph, *inputs, "-o", folder / "ours.exr", "--precision", "float", *words)
    assert result.code == 0, result.err
    return read(folder / "ours.exr")


def compare(play: Play, effect: Path, ours: np.ndarray, channels: str = "y", frames: int = 3) -> None:
    """Every pixel of some channels, within 2e-3 of the brightest number."""
    for channel in channels:
        theirs = play(effect, channel, frames=frames)
        assert np.abs(theirs - ours[..., "xyz".index(channel)]).max() <= 2e-3 * np.abs(ours).max()


@needs_slang
@needs_game
def test_a_game_shows_our_pixels(cli, graphs, play: Play, tmp_path: Path) -> None:
    """As codes on the screen, which are rounded, and as light with other settings of controls at another frame."""
    graph = graphs(**LOOK)
    effect = export(cli, graph, tmp_path / "look.fx", "reshade")
    assert cli("export", graph, "-o", effect, "--size", "96x64", "--frame", 1).code == 0
    codes = encode(render(cli, graph, tmp_path, "--frame", 1)[..., :3])
    assert np.abs(play(effect) - codes).max() <= 0.75  # half a step of rounding, and what floats round before it
    effect = export(cli, graph, tmp_path / "look.fx", "reshade")
    for name, number in (("control_stops", "2.5"), ("control_color", "1.7"), ("still_frame", "7")):
        set_control(effect, name, number)
    ours = render(cli, graph, tmp_path, "--set", "stops=2.5", "--set", "color=1.7", "--frame", 7)
    compare(play, effect, ours, "xz")


@needs_slang
@needs_game
def test_tables_and_lists_are_read_from_png_files(cli, graphs, play: Play, tmp_path: Path) -> None:
    """A table of colors in three dimensions, and the outlines of letters, as numbers of 32 bits."""
    assert cli("export", graphs(), "-o", tmp_path / "table.cube", "--lut-size", 9).code == 0
    nodes = {
        "look": {"type": "lut_file", "values": {"file": str(tmp_path / "table.cube")}},
        "title": {"type": "text", "values": {"text": "Far", "size": 0.5}},
    }
    links = {"look.image": "light.out", "title.image": "look.out", "outputs.image": "title.out"}
    graph = graphs(nodes=nodes, links=links)
    effect = export(cli, graph, tmp_path / "look.fx", "reshade")
    assert list(tmp_path.glob("look_fx_*.png"))
    compare(play, effect, render(cli, graph, tmp_path))


@needs_slang
@needs_game
def test_depth_comes_from_the_game(cli, graphs, play: Play, tmp_path: Path) -> None:
    graph = graphs(
        inputs={"depth": {"type": "Field", "default": 1.0}},
        nodes={"fog": {"type": "fog"}},
        links={"fog.image": "light.out", "fog.depth": "inputs.depth", "outputs.image": "fog.out"},
    )
    effect = export(cli, graph, tmp_path / "look.fx", "reshade")
    assert '#include "ReShade.fxh"' in effect.read_text("utf-8")
    set_control(effect, "depth_of_far_plane", str(FAR))
    compare(play, effect, render(cli, graph, tmp_path))


@needs_slang
@needs_game
def test_normals_are_made_of_depth(cli, graphs, play: Play, tmp_path: Path) -> None:
    """A surface whose depth grows to the right: x is right, z is toward the camera, slopes are those to a neighbor."""
    graph = graphs(
        inputs={"normal": {"type": "Vector", "width": 3, "default": 0.0}},
        outputs={"image": {"type": "Vector", "width": 3}},
        links={"outputs.image": "inputs.normal"},
    )
    effect = export(cli, graph, tmp_path / "look.fx", "reshade")
    width, height = SIZE
    codes = np.full((height, width, 4), 255, np.uint8)
    codes[..., 0] = 100 + np.arange(width)
    x, y = (np.arange(width) + 0.5) / width * 2.0 - 1.0, 1.0 - (np.arange(height)[:, None] + 0.5) / height * 2.0
    half = np.tan(np.radians(45.0) / 2.0)  # the field of view that the effect starts with
    points = np.stack(np.broadcast_arrays(x * half * width / height, y * half, -1.0), axis=-1) * codes[..., :1]
    across, up = np.diff(points, axis=1)[1:-1], (points[:-2] - points[2:])[:, 1:-1]
    normals = [np.cross(side, up) for side in (across[:, :-1], across[:, 1:])]  # both slopes are equal in depth
    normals = [normal / np.linalg.norm(normal, axis=-1, keepdims=True) for normal in normals]
    for channel, at in (("x", 0), ("z", 2)):
        theirs = play(effect, channel, picture=codes)[1:-1, 1:-1]
        assert np.min([np.abs(theirs - normal[..., at]) for normal in normals], axis=0).max() <= 1e-3


@needs_slang
@needs_game
def test_frames_remember_each_other(cli, graphs, play: Play, tmp_path: Path) -> None:
    """A memory that starts black is that of the graph after 16 frames, when 0.3 to the 16th is left of the start."""
    graph = graphs(
        nodes={"back": {"type": "feedback", "values": {"decay": 0.3, "mode": "mix"}}},
        links={"back.image": "light.out", "outputs.image": "back.out"},
        settings={"frames": [1, 20]},
    )
    effect = export(cli, graph, tmp_path / "look.fx", "reshade")
    ours = render(cli, graph, tmp_path, "--frame", 16)
    compare(play, effect, ours, frames=16)
    assert np.abs(render(cli, graph, tmp_path, "--frame", 1) - ours).max() > 0.05


@needs_slang
def test_controls_have_names_and_ranges(cli, graphs, tmp_path: Path) -> None:
    graph = graphs(**LOOK, ui={"about": {"doc": "A look."}})
    result = cli("export", graph, "-o", tmp_path / "look.fx", "--size", "96x64", "--json")
    assert result.code == 0 and "control 'size' moves from" in str(result.json)
    text = (tmp_path / "look.fx").read_text("utf-8")
    (line,) = re.findall(r"^uniform float control_stops < (.*) > = 1\.0;$", text, re.MULTILINE)
    assert 'ui_label = "Brightness (EV)"' in line and "ui_min = -10.0; ui_max = 10.0;" in line
    assert "technique Halation_look <" in text and "BUFFER_WIDTH == 96" in text


@needs_slang
def test_names_are_text(cli, graphs, tmp_path: Path) -> None:
    """A label cannot end its quotation marks or its line, whatever it has."""
    label = 'x"; > = 0; #include "a"\n*/ \\'
    graph = graphs(controls={"stops": {"target": "light.stops", "label": label, "doc": label}})
    assert cli("export", graph, "-o", tmp_path / "look.fx", "--size", "16x16").code == 0
    text = (tmp_path / "look.fx").read_text("utf-8")
    (line,) = [line for line in text.splitlines() if "control_stops <" in line]
    assert line.count('"') == 6 and "\\" not in line and "#include" not in text.replace(line, "")


@needs_slang
def test_what_reshade_cannot_hold_is_refused(cli, graphs, tmp_path: Path) -> None:
    refuse_unfit_graphs(cli, graphs, tmp_path / "no.fx", "reshade")


@needs_slang
def test_lists_that_are_too_long_keep_their_numbers(cli, tmp_path: Path) -> None:
    """Letters that turn change thousands of numbers: they are stored as of one frame, and a note says so."""
    graph = {
        "halation": 1,
        "nodes": {"title": {"type": "text", "values": {"text": "many letters\nin two lines", "size": 0.2}}},
        "outputs": {"image": {"type": "Image"}},
        "links": {"outputs.image": "title.out"},
        "animation": {"title.rotation": {"expression": "frame"}},
        "settings": {"frames": [1, 24]},
    }
    (tmp_path / "title.json").write_text(json.dumps(graph))
    result = cli("export", tmp_path / "title.json", "-o", tmp_path / "title.fx", "--size", "480x270", "--json")
    assert result.code == 0, result.err
    assert "it shows one frame: time changes lists of more than 4096 numbers" in str(result.json)
    text = (tmp_path / "title.fx").read_text("utf-8")
    assert len(text) < 1 << 20 and "still_frame" not in text
