"""The About dialog."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING

from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...language.translation import translate
from ...version import VERSION
from ..theme.style import ui_scale
from ..toolkit.buttons import close_button, quiet_button
from ..toolkit.dialogs import backdrop, dialog, escape_pressed
from ..toolkit.words import draw_dim, draw_wrapped, font

if TYPE_CHECKING:
    from .context import DialogContext

_LIBRARIES = ("moderngl", "imgui-bundle", "OpenImageIO", "opencolorio", "numpy")


class AboutDialog:
    """The versions of Halation, the system and its libraries, to be copied into a bug report."""

    def __init__(self, context: DialogContext) -> None:
        self._context = context

    def draw(self) -> None:
        """Draw the dialog, if it is open."""
        if "about" not in self._context.dialogs.open:
            return
        close = backdrop(self._context, "about")
        with dialog(self._context, "About", (440, 0)):
            with font(self._context, "bold", 26.0):
                imgui.text_unformatted("Halation")
            summary = translate(
                "A node-graph compositor for screen-space effects: an editor, a headless renderer, graphs as JSON."
            )
            draw_wrapped(self._context.palette.dim, summary)
            imgui.dummy((0, 6 * ui_scale()))
            lines = list_versions()
            if imgui.begin_table("versions", 2):
                imgui.table_setup_column("name", imgui.TableColumnFlags_.width_fixed.value, 130 * ui_scale())
                imgui.table_setup_column("version", imgui.TableColumnFlags_.width_stretch.value)
                for name, version in lines:
                    imgui.table_next_row()
                    imgui.table_next_column()
                    draw_dim(self._context, name)
                    imgui.table_next_column()
                    imgui.text_wrapped(version)
                imgui.end_table()
            imgui.dummy((0, 6 * ui_scale()))
            if quiet_button(
                self._context,
                f"{icons.ICON_FA_COPY}  {translate('Copy')}",
                "copy versions",
                translate("Copy for a bug report"),
            ):
                self._context.clipboard.put("\n".join(f"{name}: {version}" for name, version in lines))
            imgui.same_line()
            close = close_button(self._context, "close about") or close or escape_pressed()
        if close:
            self._context.dialogs.open.discard("about")


def list_versions() -> list[tuple[str, str]]:
    """Names and versions of Halation, of the system and of the libraries that it stands on."""
    from importlib import metadata  # a fiftieth of the start of the editor

    return [
        ("Halation", VERSION),
        ("Python", platform.python_version()),
        (translate("System"), platform.platform(terse=True)),
        *((name, metadata.version(name)) for name in _LIBRARIES),
    ]
