"""The fonts of the window: for words, for numbers, and icons in both."""

from __future__ import annotations

from pathlib import Path

import imgui_bundle
from imgui_bundle import hello_imgui, imgui
from msgspec import Struct

from .style import EM


class Fonts(Struct, frozen=True):
    """The loaded fonts, in any size."""

    text: imgui.ImFont
    bold: imgui.ImFont
    mono: imgui.ImFont


def load() -> Fonts:
    """Load the fonts that come with the window library, so that they look the same everywhere."""
    folder = Path(imgui_bundle.__file__).parent / "assets" / "fonts"
    return Fonts(
        *(
            _with_icons(folder, name)
            for name in ("Roboto/Roboto-Regular.ttf", "Roboto/Roboto-Bold.ttf", "Inconsolata-Medium.ttf")
        )
    )


def _with_icons(folder: Path, name: str) -> imgui.ImFont:
    plain = hello_imgui.FontLoadingParams()
    plain.inside_assets = False
    font = hello_imgui.load_font(str(folder / name), EM, plain)
    icons = hello_imgui.FontLoadingParams()
    icons.inside_assets = False
    icons.merge_to_last_font = True
    hello_imgui.load_font(str(folder / "Font_Awesome_6_Free-Solid-900.otf"), EM * 0.86, icons)
    return font
