"""Rows for color management: the config and working space of a graph, and the color space of a file."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from halation.nodes import Value
from imgui_bundle import icons_fontawesome_6 as icons
from imgui_bundle import imgui

from ...authoring.commands import SetColorSettings
from ...authoring.edits import paths
from ...color.management import ColorManager, list_builtin_configs, load_ocio
from ...language.translation import mark, translate
from ..fields.choice_field import choose
from ..fields.fields import Edit, Fields
from ..fields.text_field import text_field
from ..shared.coloring import find_color_manager
from ..shared.dialogs import Browse
from .rows import Rows

FOUND = mark("detected")
"""The choice that detects the color space from the file."""

_PATH = Value("config", "path", "")
_FROM_FILE = mark("choose a file…")
_ENVIRONMENT = mark("$OCIO, else built in")
_REC709 = mark("linear Rec.709")


@lru_cache(maxsize=8)
def space_names(manager: ColorManager) -> tuple[str, ...]:
    """The roles and color spaces of a config."""
    return (*manager.spaces.getRoleNames(), *manager.list_spaces())


@lru_cache(maxsize=8)
def _linear(manager: ColorManager) -> tuple[str, ...]:
    """The linear color spaces of a config, which can be working spaces."""
    kind = load_ocio().REFERENCE_SPACE_SCENE
    return tuple(
        name
        for name in ("scene_linear", *manager.list_spaces())
        if (space := manager.find(name)) and not space.data and manager.spaces.isColorSpaceLinear(space.name, kind)
    )


def color_rows(rows: Rows, fields: Fields) -> None:
    """Draw the rows of a graph's color settings."""
    _config_row(rows, fields)
    usable = find_color_manager(rows.context)
    if fault := rows.context.coloring.fault:
        rows.field_note(fault, rows.palette.error)
    _working_space_row(rows, fields, (translate(_REC709), *_linear(usable)))


def _config_row(rows: Rows, fields: Fields) -> None:
    context = rows.context
    session = context.session
    color = session.root.settings.color
    rows.name(
        "color config",
        translate("color config", "value"),
        doc=translate(
            "The OpenColorIO config that defines color spaces, displays, views and looks: a built-in one, or a file"
        ),
        changed=bool(color.config),
    )
    choices = (translate(_ENVIRONMENT), translate(_FROM_FILE), *list_builtin_configs())
    if color.config and color.config not in choices:
        edit = text_field(fields, "color config", color.config, _PATH, rows.field() - imgui.get_frame_height())
        rows.record("color config")
        if edit:
            rows.act(lambda: session.apply(SetColorSettings(config=str(edit.value))))
        imgui.same_line(0.0, 0.0)
        if rows.icon(
            icons.ICON_FA_XMARK, "no color config", translate("Use the config that $OCIO names, or the built-in one")
        ):
            rows.act(lambda: session.apply(SetColorSettings(config="")))
    else:
        index = choose(fields, "color config", color.config or choices[0], choices, rows.field())
        rows.record("color config")
        if index == 1:
            context.dialogs.browse = Browse(
                translate("Choose a Color Config"),
                "config",
                lambda path: context.log.attempt(
                    lambda: session.apply(SetColorSettings(config=paths.make_relative(path, session.root.folder)))
                ),
            )
        elif index is not None:
            config = "" if index == 0 else choices[index]
            rows.act(lambda: session.apply(SetColorSettings(config=config)))


def _working_space_row(rows: Rows, fields: Fields, spaces: Sequence[str]) -> None:
    """Draw the row of the working space. The first of `spaces` stands for the default."""
    session = rows.context.session
    color = session.root.settings.color
    rows.name(
        "working space",
        translate("working space", "value"),
        doc=translate("The linear color space of pictures between nodes"),
        changed=bool(color.working),
    )
    index = choose(fields, "working space", color.working or spaces[0], spaces, rows.field())
    rows.record("working space")
    if index is not None:
        working = "" if index == 0 else spaces[index]
        rows.act(lambda: session.apply(SetColorSettings(working=working)))


def space_field(rows: Rows, fields: Fields, key: str, current: str, width: float) -> Edit | None:
    """Draw a choice of color spaces; "" stands for detecting it."""
    detected = translate(FOUND)
    spaces = (detected, *space_names(find_color_manager(rows.context)))
    label = detected if current in ("", "auto") else current
    choices = spaces if label in spaces else (label, *spaces)
    index = choose(fields, key, label, choices, width)
    if index is None:
        return None
    return Edit("" if choices[index] == detected else choices[index])
