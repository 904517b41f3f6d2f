"""Help for writing code: built-in names, notes beside parameters, files to include."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui
from imgui_bundle.imgui_color_text_edit import TextEditor

from ...compiler import load_library
from ...custom_nodes import Code
from ...custom_nodes.notes import EDGES, UNITS
from ...language.translation import mark, translate
from ..theme.style import ui_scale, vec4
from ..toolkit.buttons import quiet_button
from ..toolkit.places import record
from ..toolkit.words import draw_dim, font, tip

if TYPE_CHECKING:
    from .context import CodeContext
    from .page import Page

_POPUP = "help for code"

NAMES = (
    ("vec4 f(vec4 image)", mark("the last function is the node: pictures in, a picture out")),
    ("vec4 vec3 vec2 float", mark("a parameter without a default is an input: color, vector or field")),
    ("out vec4 a, out float b", mark("several outputs, in a function that returns void; they come last")),
    ("ivec2 pixel, extent", mark("the position of the pixel, from the top left corner, and the size of the picture")),
    ("image_at(ivec2 p)", mark("exactly that pixel of the input 'image'")),
    ("image_near(vec2 p)", mark("filtered, at a position in pixels; pixel centers are at .5")),
    ("ivec2 image_size", mark("the size of the input 'image'")),
    ("int frame", mark("the frame that is rendered")),
    ("float proxy", mark("the scale of the picture: multiply sizes in pixels by it")),
    ("MODE_ADD", mark("the choice 'add' of the value 'mode', to compare with")),
)
NOTES = (
    ("= 0.5", mark("makes a parameter a value, with that default")),
    ("0..1", mark("the range of its slider")),
    (">= 0, <= 10", mark("hard limits")),
    ('"Amount"', mark("the name of the value")),
    (" ".join(UNITS), mark("its unit: px shrinks with a proxy, deg arrives in radians")),
    ("color", mark("a color, for vec3 and vec4")),
    ("handle", mark("a point with a handle in the viewer, for vec2")),
    ("= add, one of add | max", mark("choices, for an int")),
    ("optional 0", mark("an optional input, and its value if it is not linked")),
    (" ".join(EDGES), mark("how a picture continues beyond its edges")),
    (": a sentence", mark("a description; it comes last")),
)


class CodeHelp:
    """The help button and its popup."""

    def __init__(self, context: CodeContext) -> None:
        self._context = context

    def draw(self, page: Page, code: Code) -> None:
        """Draw the button, and the popup if it is open."""
        if quiet_button(
            self._context, icons.ICON_FA_CIRCLE_QUESTION, "button code help", translate("Help for writing code")
        ):
            imgui.open_popup(_POPUP)
        scale = ui_scale()
        imgui.set_next_window_size_constraints((420 * scale, 60 * scale), (620 * scale, 560 * scale))
        if imgui.begin_popup(_POPUP):
            if code.language == "isf":
                draw_dim(self._context, translate("Shaders in the Interactive Shader Format: isf.video describes it."))
            else:
                _draw_table(self._context, translate("Names"), NAMES)
                _draw_table(self._context, translate("// after a parameter"), NOTES)
                _draw_includes(self._context, page)
            imgui.end_popup()


def list_includes() -> Iterator[tuple[str, str]]:
    """The files that code can include, with the signatures of their functions."""
    for name, text in sorted(load_library().texts.items()):
        if name.startswith("lib/"):
            signatures = (
                f"{function.result} {function.name}({', '.join(map(' '.join, function.parameters))})"
                for function in text.all_functions
            )
            yield name, "\n".join(signatures)


def _draw_table(context: CodeContext, title: str, lines: tuple[tuple[str, str], ...]) -> None:
    _draw_title(context, title)
    if imgui.begin_table(title, 2, int(imgui.TableFlags_.sizing_fixed_fit)):
        for name, does in lines:
            imgui.table_next_row()
            imgui.table_next_column()
            with font(context, "mono", 14.0):
                imgui.text_unformatted(name)
            imgui.table_next_column()
            draw_dim(context, translate(does))
        imgui.end_table()


def _draw_includes(context: CodeContext, page: Page) -> None:
    """Files to include; a click writes the line."""
    _draw_title(context, "#include")
    for name, functions in list_includes():
        with font(context, "mono", 14.0):
            chosen = imgui.selectable(f"{name}.glsl", False)[0]
        record(context, f"include {name}")
        tip(functions)
        if chosen:
            start = TextEditor.DocPos(0, 0)
            page.widget.replace_section_text(start, start, f'#include "{name}.glsl"\n')


def _draw_title(context: CodeContext, title: str) -> None:
    with font(context, "bold"):
        imgui.text_colored(vec4(context.palette.accent), title)
