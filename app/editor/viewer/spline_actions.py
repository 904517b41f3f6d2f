"""Actions of the points of splines in the viewer."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from ...language.translation import mark
from ..shared.action import Action
from .spline_edits import (
    can_draw,
    can_drop_keys,
    can_paste_points,
    copy_points,
    drop_keys,
    has_selected_points,
    key_selected_points,
    nudge_points,
    paste_points,
    select_all_points,
    toggle_ripple,
    toggle_singly,
)
from .splines import find_chosen

if TYPE_CHECKING:
    from .context import ViewerContext
    from .geometry import Point

_FAR = 10.0
"""Pixels of a nudge with Shift: ten times the usual one, as in other programs."""

_NUDGES: tuple[tuple[str, str, str, Point], ...] = (
    ("left", mark("Nudge Points Left"), "LeftArrow", (-1.0, 0.0)),
    ("right", mark("Nudge Points Right"), "RightArrow", (1.0, 0.0)),
    ("up", mark("Nudge Points Up"), "UpArrow", (0.0, -1.0)),
    ("down", mark("Nudge Points Down"), "DownArrow", (0.0, 1.0)),
)


def _has_shape(context: ViewerContext) -> bool:
    return find_chosen(context) is not None


def _list_nudges() -> tuple[Action[ViewerContext], ...]:
    """Four directions, by a pixel and by ten."""
    return tuple(
        Action(
            f"viewer.nudge_{name}{suffix}",
            label,
            partial(nudge_points, by=(step[0] * pixels, step[1] * pixels)),
            "",
            f"{keys}+{key}",
            "viewer",
            has_selected_points,
            doc=doc,
            repeats=True,
        )
        for keys, suffix, pixels, doc in (
            ("Alt", "", 1.0, mark("Move the selected points of the selected shape by a pixel.")),
            ("Shift+Alt", "_far", _FAR, mark("Move the selected points of the selected shape by ten pixels.")),
        )
        for name, label, key, step in _NUDGES
    )


SPLINE_ACTIONS: tuple[Action[ViewerContext], ...] = (
    Action(
        "viewer.all_points",
        "Select All Points",
        select_all_points,
        "Viewer/Shapes",
        "Ctrl+A",
        "viewer",
        _has_shape,
        doc="Select all points of the selected shape. Drag with Shift around some to select these; click with Shift to "
        "add one.",
    ),
    Action(
        "viewer.copy_points",
        "Copy Points",
        copy_points,
        "Viewer/Shapes",
        "Ctrl+Shift+C",
        "viewer",
        _has_shape,
        doc="Copy the selected points of the selected shape, or all of them, as they are at this frame.",
    ),
    Action(
        "viewer.paste_points",
        "Paste Points",
        paste_points,
        "Viewer/Shapes",
        "Ctrl+Shift+V",
        "viewer",
        can_paste_points,
        doc="Set the copied points at this frame. Where points have keys, this sets a key.",
    ),
    Action(
        "viewer.ripple",
        "Ripple Edit",
        toggle_ripple,
        "Viewer/Shapes",
        "Alt+R",
        "viewer",
        can_draw,
        lambda context: context.viewer.pen.ripples,
        doc="Edit points at all of their keys: what is added at this frame is added to each of them.",
    ),
    Action(
        "viewer.key_singly",
        "Key Points Singly",
        toggle_singly,
        "Viewer/Shapes",
        "Alt+S",
        "viewer",
        can_draw,
        lambda context: context.viewer.pen.singly,
        doc="Edits of a shape with keys set keys of the points that move, and of no others. Such points are diamonds.",
    ),
    Action(
        "viewer.key_points",
        "Key Selected Points",
        key_selected_points,
        "Viewer/Shapes",
        "Alt+K",
        "viewer",
        has_selected_points,
        doc="Set keys of the selected points at this frame, which the other points do not get.",
    ),
    Action(
        "viewer.join_keys",
        "Key Points Together",
        drop_keys,
        "Viewer/Shapes",
        "",
        "viewer",
        can_drop_keys,
        doc="Remove the keys that the selected points have of their own, so that they follow the keys of the shape.",
    ),
    *_list_nudges(),
)
