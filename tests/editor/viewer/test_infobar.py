"""The numbers of the pixel under the pointer, against the standards that define them."""

from types import SimpleNamespace

import pytest
from halation import shaders
from halation.color.management import get_color_manager
from halation.color.primaries import REC709_LUMINANCE
from halation.editor.theme.palette import DARK
from halation.editor.viewer import infobar
from halation.nodes import ColorSettings, Kind
from halation.renderer.viewing.look import Look
from halation.resources.sandbox import UNRESTRICTED


@pytest.mark.parametrize(
    ("working", "weights"),
    [("", (0.2126, 0.7152, 0.0722)), ("ACEScg", (0.2722287, 0.6740818, 0.0536895))],
    ids=["BT.709-6", "ACES AP1, S-2014-004"],
)
def test_luminance_is_that_of_the_working_space(working, weights) -> None:
    look = Look(view="none", manager=get_color_manager(ColorSettings("", working), UNRESTRICTED))
    pixel = (0.5, 2.0, 0.25, 1.0)
    words = infobar.of_pixel(SimpleNamespace(palette=DARK), (0, 0), pixel, Kind.IMAGE, look)
    luminance = float(words[-1].text.removeprefix("L "))
    assert luminance == pytest.approx(sum(a * b for a, b in zip(weights, pixel, strict=False)), rel=1e-3)


def test_shaders_and_the_editor_have_the_same_weights() -> None:
    text = (shaders.folder() / "lib" / "working.glsl").read_text(encoding="utf-8")
    assert f"LUMINANCE_WEIGHTS = vec3({', '.join(map(str, REC709_LUMINANCE))})" in text
