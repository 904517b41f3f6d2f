"""Pages that `halation export --to web` writes, opened in a browser: every night, Chromium shows all presets."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread

import numpy as np
import OpenImageIO as oiio
import pytest
from browser import CHROMIUM, Browser
from exr_files import read
from halation.presets import paths
from shown_pages import SIZE, compare, list_settings, place_corners_like, read_picture, show, take

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(1200),
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed"),
]


@pytest.fixture
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.mark.parametrize("preset", [path.stem for path in paths()])
def test_a_page_shows_what_we_render(cli, browser: Browser, tmp_path: Path, preset: str) -> None:
    """At the settings of the preset and at two others of each control, without a word on the console."""
    page, picture = tmp_path / "page.html", tmp_path / "ours.png"
    assert cli("export", preset, "-o", page, "--size", SIZE).code == 0
    show(browser, page)
    worst: dict[str, tuple[float, float]] = {}
    for options, knobs in list_settings(browser.run("halation.package.controls")):
        words = ("render", preset, "-o", picture, "--size", SIZE, "--dither", "none", *options)
        with place_corners_like(browser):
            assert cli(*words).code == 0
        difference, flip = compare(picture, take(browser, tmp_path, knobs))
        if difference > 2.01 or flip > 0.01:
            worst[" ".join(options)] = round(difference, 1), round(flip, 4)
    assert not worst and not browser.messages


@pytest.fixture
def page(cli, graphs, tmp_path: Path, browser: Browser) -> Path:
    """A page that brightens its picture by a stop, open in the browser."""
    parts = {"controls": {"stops": {"target": "light.stops"}}, "outputs": {"image": {"type": "Image", "view": "none"}}}
    assert cli("export", graphs(**parts), "-o", tmp_path / "page.html").code == 0
    show(browser, tmp_path / "page.html")
    return tmp_path


def test_controls_that_are_baked_say_so_at_their_place(cli, graphs, browser: Browser, tmp_path: Path) -> None:
    """What moves a spline is not a slider that does nothing, and nothing is said twice."""
    graph = graphs(
        nodes={"drop": {"type": "shape", "values": {"shape": "spline"}}},
        links={"outputs.image": "drop.out"},
        controls={
            "turn": {"target": "drop.rotation", "label": "Turn <it>"},
            "points": {"target": "drop.spline"},
            "color": {"target": "drop.color"},
            "stops": {"target": "light.stops"},
        },
    )
    assert cli("export", graph, "-o", tmp_path / "page.html", "--size", "48x32").code == 0
    show(browser, tmp_path / "page.html")
    rows = browser.run("[...document.querySelectorAll('.held')].map(row => row.innerText).join('\\n')").splitlines()
    assert rows == [
        "Turn <it>",
        "Keeps its value: it moves outlines, and sorted tables of them are baked.",
        "Points",
        "Keeps its value: the format has no input for a spline like it.",
        "Stops",
        "Changes nothing in this picture.",
    ]
    assert browser.run("document.querySelectorAll('.control:not(.held)').length") == 1
    assert browser.run("document.getElementById('notes').childElementCount") == 0 and not browser.messages


def test_a_page_says_where_its_device_places_corners_roughly(cli, browser: Browser, tmp_path: Path) -> None:
    assert cli("export", "clay_city", "-o", tmp_path / "page.html", "--size", "48x32").code == 0
    show(browser, tmp_path / "page.html")
    said = "places corners of triangles to a 16th of a pixel" in browser.run(
        "document.getElementById('notes').innerText"
    )
    assert said and browser.run("halation.gl.getParameter(halation.gl.SUBPIXEL_BITS)") == 4


WITHOUT_FLOATS = """
    const getExtension = WebGL2RenderingContext.prototype.getExtension;
    WebGL2RenderingContext.prototype.getExtension = function (name) {
        return MISSING.includes(name) ? null : getExtension.call(this, name);
    };
"""


def test_a_device_with_half_floats_alone_says_so(cli, browser: Browser, tmp_path: Path) -> None:
    """Such as many phones: the picture is the same to the eye."""
    page, picture = tmp_path / "page.html", tmp_path / "ours.png"
    assert cli("export", "soft_bloom", "-o", page, "--size", SIZE).code == 0
    assert cli("render", "soft_bloom", "-o", picture, "--size", SIZE, "--dither", "none").code == 0
    browser.prepare("const MISSING = ['EXT_color_buffer_float', 'OES_texture_float_linear'];" + WITHOUT_FLOATS)
    show(browser, page)
    notes = browser.run("document.getElementById('notes').innerText").splitlines()
    assert "This device has half floats only: dark gradients may show steps." in notes
    difference, flip = compare(picture, take(browser, tmp_path, {}))
    assert difference < 2.01 and flip < 0.01 and not browser.messages


FIRST_SIZE = """
    const look = () => {
        if (window.halation?.firstPictureAt) window.firstSize = halation.picture.size;
        else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
"""


def test_a_large_page_begins_with_a_draft(cli, graphs, browser: Browser, tmp_path: Path) -> None:
    """It is small and looks like the whole picture, which follows by itself, also after the device was lost."""
    graph = graphs(nodes={"glow": {"type": "bloom"}}, links={"glow.image": "light.out", "outputs.image": "glow.out"})
    assert cli("export", graph, "-o", tmp_path / "page.html", "--size", "960x540").code == 0
    browser.prepare(FIRST_SIZE)
    show(browser, tmp_path / "page.html")
    browser.wait_until("!halation.isDirty")
    assert browser.run("window.firstSize") == [240, 135] and browser.run("halation.picture.size") == [960, 540]
    whole = take(browser, tmp_path, {})
    url = browser.run("halation.showDraft(); halation.canvas.toDataURL()")
    (tmp_path / "draft.png").write_bytes(base64.b64decode(url.partition(",")[2]))
    assert np.abs(read_picture(tmp_path / "draft.png") - whole).mean() < 1.0
    browser.run("window.loser = halation.gl.getExtension('WEBGL_lose_context'); loser.loseContext()")
    browser.wait_until("halation.reader === null")
    browser.run("loser.restoreContext()")
    browser.wait_until("halation.reader && !halation.isDirty")
    np.testing.assert_array_equal(take(browser, tmp_path, {}), whole)
    assert not browser.messages


def test_a_lost_context_comes_back(browser: Browser, page: Path) -> None:
    before = take(browser, page, {"stops": 1.5})
    browser.run("window.loser = halation.gl.getExtension('WEBGL_lose_context'); loser.loseContext()")
    browser.wait_until("halation.reader === null")
    browser.run("loser.restoreContext()")
    browser.wait_until("halation.reader && !halation.isDirty")
    np.testing.assert_array_equal(take(browser, page, {"stops": 1.5}), before)


def test_a_picture_of_the_visitor(browser: Browser, page: Path) -> None:
    """It is decoded as sRGB, brightened and encoded again; another shape is cropped, a text is refused."""
    codes = np.zeros((64, 48, 3), np.uint8)
    codes[16:48] = (40, 90, 130)  # the middle, which a picture of 48x32 pixels keeps
    oiio.ImageBuf(codes).write(str(page / "own.png"))
    original = take(browser, page, {"stops": 1.0})
    browser.choose_file("#file", page / "own.png")
    browser.wait_until("halation.sheet && !halation.isDirty")
    share = np.array([40.0, 90.0, 130.0]) / 255.0
    light = 2.0 * ((share + 0.055) / 1.055) ** 2.4
    brighter = 255.0 * (1.055 * light ** (1 / 2.4) - 0.055)
    shown = take(browser, page, {"stops": 1.0})
    np.testing.assert_allclose(shown, np.broadcast_to(brighter, shown.shape), atol=1.01)
    (page / "no.png").write_text("no picture")
    browser.choose_file("#file", page / "no.png")
    browser.wait_until("document.getElementById('fault').textContent.includes('no.png is no picture')")
    browser.run("document.getElementById('back').click()")
    np.testing.assert_array_equal(take(browser, page, {"stops": 1.0}), original)


def test_the_camera_of_the_visitor(browser: Browser, page: Path) -> None:
    """Chromium's camera for tests is green with a yellow pie that turns."""
    browser.run("document.getElementById('camera').click()")
    browser.wait_until("halation.sheet && !halation.isDirty")
    first = take(browser, page, {"stops": 0.0})
    assert first[..., 1].mean() > 2.0 * first[..., 2].mean()
    browser.wait_until(f"halation.camera.currentTime > {browser.run('halation.camera.currentTime')} + 0.5")
    assert np.abs(take(browser, page, {"stops": 0.0}) - first).max() > 20.0
    browser.run("document.getElementById('camera').click()")
    assert browser.run("halation.camera === null && halation.sheet === null")


def test_the_picture_before_is_shown_beside_it(browser: Browser, page: Path) -> None:
    take(browser, page, {"stops": 3.0})
    url = browser.run("halation.setWipe(0.5); halation.canvas.toDataURL()")
    (page / "both.png").write_bytes(base64.b64decode(url.partition(",")[2]))
    both, (after, before) = read_picture(page / "both.png"), (take(browser, page, {"stops": x}) for x in (3.0, 0.0))
    middle = both.shape[1] // 2
    np.testing.assert_allclose(both[:, :middle], before[:, :middle], atol=1.01)
    np.testing.assert_array_equal(both[:, middle:], after[:, middle:])


class QuietFiles(SimpleHTTPRequestHandler):
    """Serves a folder without a log."""

    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture
def served(tmp_path: Path) -> Iterator[str]:
    """The address of the folder `look`."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(QuietFiles, directory=tmp_path / "look")) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.mark.parametrize("preset", ["soft_bloom", "agx_look"])
def test_the_reader_in_javascript_gives_our_pixels(cli, browser: Browser, served: str, tmp_path: Path, preset) -> None:
    """As the README of the folder runs it: with pyramids, and with a table of colors."""
    folder, words = tmp_path / "look", ("--size", "160x90")
    assert cli("export", preset, "--to", "glsl", "-o", folder, *words).code == 0
    example = re.search(r"```html\n(.*?)```", (folder / "README.md").read_text(), re.DOTALL)
    assert example
    (folder / "run.html").write_text(f"<!doctype html>{example[1]}")
    browser.open(f"{served}/run.html")
    browser.wait_until("window.shown")
    theirs = np.array(browser.run("[...shown.pixels]")).reshape(90, 160, 4)
    assert cli("render", preset, "-o", tmp_path / "a.exr", "--precision", "float", *words).code == 0
    ours = read(tmp_path / "a.exr")
    assert np.abs(theirs[..., : ours.shape[2]] - ours).max() <= 2e-3 * np.abs(ours).max()
