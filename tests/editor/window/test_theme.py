"""Colors of the window's style: text can be read on every ground, what lies over something lets it through."""

from __future__ import annotations

from itertools import chain

import pytest
from halation.editor.theme import style
from halation.editor.theme.palette import CONTRAST, PALETTES, Palette

GROUNDS = (
    "window_bg", "popup_bg", "title_bg", "title_bg_active", "menu_bar_bg", "tab", "tab_hovered", "tab_selected",
    "tab_dimmed", "tab_dimmed_selected", "table_header_bg", "frame_bg", "frame_bg_hovered", "frame_bg_active", "button",
    "button_hovered", "header", "header_hovered", "slider_grab",
)  # fmt: skip
"""What text stands on."""

OVERLAYS = {
    "docking_preview": 0.6, "nav_windowing_dim_bg": 0.6, "modal_window_dim_bg": 0.6, "text_selected_bg": 0.5,
    "drag_drop_target_bg": 0.25, "table_row_bg_alt": 0.1, "resize_grip": 0.6, "table_border_light": 0.8,
}  # fmt: skip
"""What lies over something, and how much of it they may hide."""

UNSEEN = ("child_bg", "border_shadow", "scrollbar_bg", "table_row_bg", "tab_dimmed_selected_overline")
"""What only hides what is below it, or says nothing."""

Color = tuple[float, float, float]


def list_colors(palette: Palette) -> dict[str, tuple[Color, float]]:
    lists = (style._list_window_colors(palette), style._list_widget_colors(palette))  # pyright: ignore
    return {name: (color, alpha) for name, color, alpha in chain(*lists)}


def measure_light(color: Color) -> float:
    """The relative luminance of WCAG 2."""
    light = [part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in color]
    return 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2]


def contrast(first: Color, second: Color) -> float:
    bright, dark = sorted((measure_light(first), measure_light(second)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def cover(below: Color, color: Color, alpha: float) -> Color:
    first, second, third = (a + (b - a) * alpha for a, b in zip(below, color, strict=True))
    return first, second, third


@pytest.fixture(params=PALETTES)
def palette(request: pytest.FixtureRequest) -> Palette:
    return PALETTES[request.param]


def test_colors_and_opacities_are_parts_of_one(palette: Palette) -> None:
    for name, (color, alpha) in list_colors(palette).items():
        assert all(0.0 <= part <= 1.0 for part in color) and 0.0 <= alpha <= 1.0, name


def test_text_can_be_read_on_every_ground(palette: Palette) -> None:
    """By 4.5 to 1 (WCAG 2.1, 1.4.3), in the theme of high contrast by 7 to 1 (1.4.6)."""
    colors, least = list_colors(palette), 7.0 if palette.name == CONTRAST.name else 4.5
    for name in GROUNDS:
        ground, alpha = colors[name]
        assert alpha == 1.0 and contrast(colors["text"][0], ground) >= least, name
    selected = cover(colors["frame_bg"][0], *colors["text_selected_bg"])
    striped = cover(colors["window_bg"][0], *colors["table_row_bg_alt"])
    assert contrast(colors["text"][0], selected) >= 4.5 and contrast(colors["text"][0], striped) >= least
    assert contrast(colors["text_disabled"][0], colors["window_bg"][0]) >= 4.5
    assert colors["text"][1] == colors["text_disabled"][1] == colors["input_text_cursor"][1] == 1.0


def test_what_lies_over_something_lets_it_through(palette: Palette) -> None:
    colors = list_colors(palette)
    for name, most in OVERLAYS.items():
        assert 0.0 < colors[name][1] <= most, name
    assert all(colors[name][1] == 0.0 for name in UNSEEN)


def test_what_is_under_the_mouse_or_pressed_looks_different(palette: Palette) -> None:
    colors = list_colors(palette)
    for name in ("scrollbar_grab", "separator", "resize_grip", "frame_bg", "button", "header"):
        looks = {colors[name], colors[f"{name}_hovered"], colors[f"{name}_active"]}
        assert len(looks) == 3, name
    assert colors["tab"] != colors["tab_hovered"]
    assert colors["tab"] != colors["tab_selected"] or palette.name == CONTRAST.name, "there tabs have borders"
    cursor, alpha = colors["nav_cursor"]
    assert contrast(cover(colors["window_bg"][0], cursor, alpha), colors["window_bg"][0]) >= (
        7.0 if palette.name == CONTRAST.name else 2.0
    )
