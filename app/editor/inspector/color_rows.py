"""How a graph manages color: its config and its working space; and the color space of a file."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

from imgui_bundle import imgui

from ....nodes import ColorSettings, Value
from ...media import color_mark
from ...media.managed import BUILT_IN, LINEAR_REC709, builtin_configs, managed
from ..dialogs import Browse
from ..viewer.coloring import coloring
from .choice_field import choose
from .fields import Fields
from .rows import Rows
from .text_field import text_field

FOUND = "found out"
"""A color space that nobody chose."""

_PATH = Value("config", "path", "")
_FROM_FILE = "choose a file…"
_ENVIRONMENT = "$OCIO, else built in"
_REC709 = "linear Rec.709"


@lru_cache(maxsize=8)
def space_names(color: ColorSettings, mark: str) -> tuple[str, ...]:
    """The roles and color spaces of a config. `mark` changes when it does."""
    manager = managed(color)
    return (*manager.spaces.getRoleNames(), *manager.names())


@lru_cache(maxsize=8)
def _linear(color: ColorSettings, mark: str) -> tuple[str, ...]:
    """The spaces that can be worked in."""
    manager = managed(color)
    from ...media.managed import ocio

    kind = ocio().REFERENCE_SPACE_SCENE
    return tuple(
        name for name in ("scene_linear", *manager.names())
        if (found := manager.find(name)) and not found.data and manager.spaces.isColorSpaceLinear(found.name, kind)
    )


def color_rows(rows: Rows, fields: Fields) -> None:
    """The rows of the settings of a graph."""
    editor = rows.editor
    session = editor.session
    color = session.root.settings.color
    rows.name("color config", "color config", doc="Where color spaces, displays, views and looks come from "
              "(OpenColorIO): a file, or a config that comes with it", changed=bool(color.config))
    choices = (_ENVIRONMENT, _FROM_FILE, *builtin_configs())
    if color.config and color.config not in choices:
        edit = text_field(fields, "color config", color.config, _PATH, rows.field() - imgui.get_frame_height())
        rows.record("color config")
        if edit:
            rows.act(lambda: session.set_color(config=str(edit.value)))
        imgui.same_line(0.0, 0.0)
        if rows.icon("\uf00d", "no color config", "What $OCIO names, else the built-in one"):
            rows.act(lambda: session.set_color(config=""))
    else:
        index = choose(fields, "color config", color.config or _ENVIRONMENT, choices, rows.field())
        rows.record("color config")
        if index == 1:
            editor.dialogs.browse = Browse("Choose a Color Config", "any", lambda path: editor.attempt(
                lambda: session.set_color(config=session.relative(path))
            ))
        elif index is not None:
            rows.act(lambda: session.set_color(config="" if index == 0 else choices[index]))
    usable = coloring(editor)
    if fault := editor.viewer.coloring.fault:
        rows.field_note(fault, rows.palette.error)
    rows.name("working space", "working space", doc="The linear color space that pictures are in between nodes",
              changed=bool(color.working))
    known = (_REC709, *_linear(ColorSettings(usable.config), color_mark(usable)))
    index = choose(fields, "working space", color.working or _REC709, known, rows.field())
    rows.record("working space")
    if index is not None:
        rows.act(lambda: session.set_color(working="" if index == 0 else known[index]))


def space_field(rows: Rows, fields: Fields, key: str, now: str, width: float, then: Callable[[str], object]) -> None:
    """Which color space something is in, from those of the config."""
    color = coloring(rows.editor)
    known = (FOUND, *space_names(color, color_mark(color)))
    shown = FOUND if now in ("", "auto") else now
    index = choose(fields, key, shown, known if shown in known else (shown, *known), width)
    if index is not None:
        chosen = (known if shown in known else (shown, *known))[index]
        then("" if chosen == FOUND else chosen)


__all__ = ["BUILT_IN", "FOUND", "LINEAR_REC709", "color_rows", "space_field", "space_names"]
