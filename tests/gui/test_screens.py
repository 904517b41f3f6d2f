"""How the editor looks: every panel and dialog in both themes, at two sizes of the interface and in a small window.

HALATION_SHOTS=folder python -m pytest tests/gui/test_screens.py    every screen in every look, kept as pictures
HALATION_RENEW=1 python -m pytest tests/gui/test_screens.py         makes docs/images/editor*.png anew
"""

from __future__ import annotations

import os
from pathlib import Path

import OpenImageIO as oiio
import pytest
from gui_screens import SCREENS, write_many_things
from halation import presets
from halation.authoring.edits.element_id import ElementId
from halation.editor.theme.palette import CONTRAST, PALETTES, RGB, Palette
from halation.editor.theme.style import mix
from halation.graph import Port
from imgui_bundle import imgui

LOOKS = (
    ("dark", 1.0, (1600, 1000)),
    ("light", 2.0, (1900, 1060)),
    ("light", 1.0, (1024, 700)),
    ("dark", 2.0, (1900, 1060)),
)
SMALLER = (1280, 800)
"""The largest window where no pictures are kept: drawing takes the most time."""
SHOTS = bool(os.environ.get("HALATION_SHOTS"))
RENEW = bool(os.environ.get("HALATION_RENEW"))
IMAGES = Path(__file__).parents[2] / "docs" / "images"
CASES = (
    [(look, (screen,)) for screen in SCREENS for look in LOOKS]
    if SHOTS
    else [(look, SCREENS[index :: len(LOOKS)]) for index, look in enumerate(LOOKS)]
)


def title(case) -> str:
    (theme, scale, (width, _)), screens = case
    return f"{theme}-{scale:g}-{width}-{'-'.join(screen.__name__ for screen in screens)}"


@pytest.mark.parametrize(("look", "screens"), CASES, ids=map(title, CASES))
def test_screens(gui, tmp_path: Path, look, screens) -> None:
    theme, scale, size = look
    size = size if SHOTS else min(size, SMALLER)

    def body(ui) -> None:
        ui.settled()
        for screen in screens:
            for name in screen(ui):
                print(name)
                if SHOTS:
                    ui.shot(f"{theme}_{scale:g}_{size[0]}/{name}.png")
                check(ui)

    gui(body, write_many_things(tmp_path), size=size, likes={"theme": theme, "ui_scale": scale}, faulty=True)


@pytest.mark.skipif(not RENEW, reason="makes pictures")
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_pictures_of_the_editor(gui, theme: str) -> None:
    def body(ui) -> None:
        ui.editor.viewer.scopes = {"histogram", "vectorscope"}
        (beauty,) = ui.session.graph.inputs
        ui.session.views.show(Port("outputs", "image"))
        ui.session.views.show(Port("inputs", beauty), "B")
        ui.editor.viewer.toggle_comparison("wipe")
        ui.session.select([ElementId("halo")])
        ui.settled()
        ui.editor.canvas.fit()
        ui.wait(20)
        if theme == "light":
            ui.move("Graph", (0.5, 0.15))
            ui.keys("Tab")
            ui.type("blur", enter=False)
        ui.editor.log.entries.clear()
        ui.wait(10)
        picture = ui.capture(ui.folder / f"editor_{theme}.png")
        keep(picture, IMAGES / ("editor.png" if theme == "dark" else "editor_light.png"))

    preset = next(path for path in presets.paths() if path.stem == "film_halation")
    gui(body, preset, size=(1600, 1000), likes={"theme": theme, "ui_scale": 1.0})


def keep(picture: Path, target: Path) -> None:
    """Write the same pixels in fewer bytes."""
    image = oiio.ImageBuf(str(picture))
    made = oiio.ImageBuf(image.get_pixels(oiio.UINT8)[..., :3].copy())
    made.specmod().attribute("png:compressionLevel", 9)
    made.specmod().attribute("png:filter", 0xF8)  # the best of all for each line
    assert made.write(str(target)), made.geterror()


def check(ui) -> None:
    """No panel failed, and nothing that can be pressed is cut off by the border of the window."""
    assert ui.editor.faults.keys() <= {"Nowhere"}, ui.editor.faults
    size = imgui.get_io().display_size
    for name, (left, top, right, bottom) in ui.editor.places.items():
        if name.startswith(("dialog ", "button ", "toast ", "Viewer", "Graph", "Inspector", "Scopes", "answer ")):
            scrolled = name.startswith("button ") and not seen(ui, top, bottom)
            inside = left >= -1 and right <= size.x + 1 and top >= -1 and bottom <= size.y + 1
            assert inside or scrolled, (name, left, top, right, bottom, size)


def seen(ui, top: float, bottom: float) -> bool:
    """False for what the inspector has below or above of what is scrolled to."""
    _, first, _, last = ui.editor.places.get("Inspector", (0.0, 0.0, 0.0, 0.0))
    return first <= top and bottom <= last


@pytest.mark.parametrize("palette", PALETTES.values(), ids=PALETTES.keys())
def test_text_can_be_read(palette: Palette) -> None:
    grounds = {name: getattr(palette, name) for name in ("window", "panel", "field", "fill", "raised", "hover")}
    grounds |= {"canvas": palette.canvas, "node": palette.node, "popup": mix(palette.panel, palette.raised, 0.25)}
    least = 7.0 if palette is CONTRAST else 4.5  # levels AAA and AA of WCAG 2.1
    for name, ground in grounds.items():
        assert contrast(palette.text, ground) >= least, name
        assert contrast(palette.dim, ground) >= least, name
    for ink in ("accent", "good", "warning", "error"):
        for name in ("panel", "field", "raised", "canvas", "node", "popup"):
            assert contrast(getattr(palette, ink), grounds[name]) >= least, (ink, name)
    assert contrast(palette.on_accent, palette.accent) >= 4.5
    for name, color in palette.categories.items():
        assert contrast(palette.text, color) >= least, name
    for kind, color in palette.kinds.items():
        assert contrast(color, palette.node) >= 3.0, kind


def contrast(first: RGB, second: RGB) -> float:
    """The contrast ratio of WCAG, 1 to 21."""
    light, dark = sorted((luminance(first), luminance(second)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def luminance(color: RGB) -> float:
    red, green, blue = (part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in color)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue
