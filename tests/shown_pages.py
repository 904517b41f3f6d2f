"""What a page shows that `halation export --to web` wrote, and how far it is from our own picture."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import OpenImageIO as oiio
from browser import Browser
from halation.compiler.codegen import rasterize
from halation.media.comparison.metrics import measure_flip
from placed_corners import place_corners

SIZE = "480x270"
RENDERER = "halation.gl.getParameter(halation.gl.getExtension('WEBGL_debug_renderer_info').UNMASKED_RENDERER_WEBGL)"
"""The name of the device that draws an open page."""
SHARES = (0.3, 0.85)
"""Where on a slider the other settings are, from its low to its high end."""


def read_picture(path: Path) -> np.ndarray:
    """Codes from 0 to 255 over black, whole as a screen shows them: [height, width, 3].

    A canvas keeps premultiplied codes and a PNG of ours straight ones: half-transparent pixels are rounded at other
    places on the way, by less than a code.
    """
    straight = oiio.ImageSpec()
    straight["oiio:UnassociatedAlpha"] = 1
    read = oiio.ImageBuf(str(path), 0, 0, straight).get_pixels(oiio.FLOAT)
    assert read is not None
    pixels = 255.0 * read
    if pixels.shape[2] == 4:
        pixels = np.rint(pixels[..., :3] * pixels[..., 3:] / 255.0)
    return np.broadcast_to(pixels, (*pixels.shape[:2], 3))


def show(browser: Browser, page: Path) -> None:
    """Open a page and wait for its first picture."""
    browser.open(page)
    browser.wait_until("document.body.classList.contains('ready')")
    assert browser.run("document.getElementById('fault').textContent") == ""


def take(browser: Browser, folder: Path, knobs: dict[str, float]) -> np.ndarray:
    """What the page shows at values of knobs; all others are as in the graph."""
    code = f"Object.assign(halation, {{knobs: {{...halation.rest, ...{json.dumps(knobs)}}}}}).restart()"
    url = browser.run(f"{code}; halation.show(); halation.canvas.toDataURL()")
    (folder / "theirs.png").write_bytes(base64.b64decode(url.partition(",")[2]))
    return read_picture(folder / "theirs.png")


def list_settings(controls: list[dict[str, Any]]) -> Iterator[tuple[tuple[str, ...], dict[str, float]]]:
    """Options of `halation render`, and the same as values of knobs: none, then two settings of each control."""
    yield (), {}
    for control in controls:
        knobs = control["knobs"]
        for share in SHARES:
            numbers = [knob["low"] + share * (knob["high"] - knob["low"]) for knob in knobs]
            if control["kind"] in ("whole", "switch", "choice"):
                numbers = [round(number) for number in numbers]
            words = {"switch": ["false", "true"], "choice": control.get("choices")}.get(control["kind"])
            text = words[numbers[0]] if words else ",".join(map(str, numbers))
            values = {knob["name"]: float(number) for knob, number in zip(knobs, numbers, strict=True)}
            yield ("--set", f"{control['name']}={text}"), values


@contextmanager
def place_corners_like(browser: Browser) -> Iterator[None]:
    """Let our own pictures have the corners of triangles where the device of an open page places them.

    Devices round them to parts of a pixel, WebGL's SUBPIXEL_BITS: SwiftShader to sixteenths, the driver of our pictures
    to 256ths. So along edges other pixels are covered, which says nothing about the page. Mesa draws both pictures in
    the same way, though it tells WebGL of the sixteenths that OpenGL asks for.
    """
    if "llvmpipe" in browser.run(RENDERER):
        yield
        return
    parts = 2 ** browser.run("halation.gl.getParameter(halation.gl.SUBPIXEL_BITS)")
    width, height = map(int, SIZE.split("x"))
    placed = place_corners(rasterize.write_vertex_text, (width, height), parts)
    with patch.object(rasterize, "write_vertex_text", placed):
        yield


def compare(ours: Path, theirs: np.ndarray) -> tuple[float, float]:
    """Codes of 255 within which 99.9 % of all pixels are, and the mean of FLIP."""
    picture = read_picture(ours)
    difference = float(np.percentile(np.abs(picture - theirs).max(axis=2), 99.9))
    return difference, measure_flip(theirs / 255.0, picture / 255.0, linear=False)
