"""The numbers of the pixel under the pointer, against the standards that define them."""

import colorsys
import re
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


@pytest.mark.parametrize("light", [(0.5, 0.02, 0.25), (0.003, 0.9, 0.1), (0.2, 0.2, 1.0), (0.7, 0.7, 0.7)])
def test_a_pixel_is_told_as_light_and_as_it_is_seen(light: tuple[float, float, float]) -> None:
    """By IEC 61966-2-1 and by Python's own conversion to hue, saturation and value; without a view."""
    look = Look(view="none", manager=get_color_manager(ColorSettings("", ""), UNRESTRICTED))
    words = infobar.of_pixel(SimpleNamespace(palette=DARK), (12, 7), (*light, 1.0), Kind.IMAGE, look)
    seen = [12.92 * part if part <= 0.0031308 else 1.055 * part ** (1 / 2.4) - 0.055 for part in light]
    place, *numbers, square, eight, hue_words, _ = words
    assert place.text == "12, 7" and [float(word.text) for word in numbers] == pytest.approx([*light, 1.0], rel=1e-3)
    assert (square.text, square.color) == ("", pytest.approx(seen, abs=2e-4))
    assert [int(part) for part in eight.text.split()] == [round(part * 255) for part in seen]
    hue, saturation, value = colorsys.rgb_to_hsv(*seen)
    found = [float(part) for part in re.findall(r"[\d.]+", hue_words.text)]
    assert found == [pytest.approx(360.0 * hue, abs=0.51), pytest.approx(saturation, abs=0.006),
                     pytest.approx(value, abs=0.006)]  # fmt: skip


def test_shaders_and_the_editor_have_the_same_weights() -> None:
    text = (shaders.folder() / "lib" / "working.glsl").read_text(encoding="utf-8")
    assert f"LUMINANCE_WEIGHTS = vec3({', '.join(map(str, REC709_LUMINANCE))})" in text


def about(side: str = "A", **changes) -> list[str]:
    """The words on a picture of 64x36 at half its size, of which nothing is computed."""
    image = SimpleNamespace(full_size=(64, 36), kind=Kind.IMAGE, channels=4, pixel_aspect=1.0, scale=1.0)
    for name in {*vars(image)} & {*changes}:
        setattr(image, name, changes.pop(name))
    preview = {"paused": False, "busy": False, "completing": False, "progress": (3, 9)}
    preview |= {name: changes.pop(name) for name in {*preview} & {*changes}}
    sight, compares = SimpleNamespace(zoom=changes.pop("zoom", 0.5)), changes.pop("compares", False)
    context = SimpleNamespace(
        palette=DARK, preview=SimpleNamespace(**preview), viewer=SimpleNamespace(compares=compares)
    )
    shown = None if changes.pop("empty", False) else image
    return [word.text for word in infobar.about(context, side, shown, sight, changes.pop("seconds", 0.0))]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ["64\u00d736", "RGBA", "50 %"]),
        ({"zoom": 1.0}, ["64\u00d736", "RGBA", "100 %"]),
        ({"zoom": 0.1}, ["64\u00d736", "RGBA", "10 %"]),
        ({"zoom": 0.0625}, ["64\u00d736", "RGBA", "6.2 %"]),
        ({"pixel_aspect": 2.0}, ["64\u00d736", "RGBA", "pixel aspect 2", "50 %"]),
        ({"scale": 0.25}, ["64\u00d736", "RGBA", "1/4", "50 %"]),
        ({"kind": Kind.NUMBER, "channels": 1}, ["64\u00d736", "number"]),
        ({"kind": Kind.VECTOR, "channels": 3}, ["64\u00d736", "vector 3", "50 %"]),
        ({"kind": Kind.FIELD, "channels": 1}, ["64\u00d736", "field", "50 %"]),
        ({"seconds": 0.0126}, ["64\u00d736", "RGBA", "50 %", "13 ms"]),
        ({"seconds": 0.9994}, ["64\u00d736", "RGBA", "50 %", "999 ms"]),
        ({"seconds": 1.0}, ["64\u00d736", "RGBA", "50 %", "1.0 s"]),
        ({"paused": True, "busy": True, "seconds": 2.0}, ["64\u00d736", "RGBA", "50 %", "paused"]),
        ({"busy": True, "seconds": 2.0}, ["64\u00d736", "RGBA", "50 %", "3/9"]),
        ({"busy": True, "completing": True, "seconds": 2.0}, ["64\u00d736", "RGBA", "50 %", "2.0 s"]),
        ({"compares": True}, ["A", "64\u00d736", "RGBA", "50 %"]),
        ({"compares": True, "side": "B", "seconds": 2.0}, ["B", "64\u00d736", "RGBA"]),
        ({"empty": True, "seconds": 2.0}, []),
        ({"empty": True, "busy": True}, ["3/9"]),
    ],
)
def test_what_is_shown_is_told(changes, words) -> None:
    assert about(**changes) == words
