"""Actions on keys, in the Animation panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...graph import Extrapolation, Interpolation
from ...language.translation import mark
from ..shared.action import Action
from . import commands
from .commands import has_chosen_keys

if TYPE_CHECKING:
    from .context import CurvesContext

_KEYS = frozenset({"keys"})
_INTERPOLATIONS: tuple[tuple[Interpolation, str], ...] = (
    ("constant", mark("Hold the value until the next key.")),
    ("linear", mark("Change linearly to the next key.")),
    ("smooth", mark("Change smoothly, without overshooting the keys.")),
    ("bezier", mark("Follow the handles.")),
)
_EXTRAPOLATIONS: tuple[tuple[Extrapolation, str, str], ...] = (
    ("hold", mark("Hold"), mark("Before the first and after the last key the value stays.")),
    ("linear", mark("Linear"), mark("Before the first and after the last key the value continues along its slope.")),
    ("loop", mark("Repeat"), mark("The part between the first and the last key repeats.")),
    (
        "mirror",
        mark("Ping-Pong"),
        mark("The part between the first and the last key repeats, forwards and backwards in turn."),
    ),
)


def _make_interpolation_action(how: Interpolation, doc: str) -> Action[CurvesContext]:
    return Action(
        f"keys.{how}",
        how.title(),
        commands.interpolate(how),
        shortcut=how[0].upper(),
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys interpolation"}),
        doc=doc,
    )


def _make_outside_action(how: Extrapolation, label: str, doc: str) -> Action[CurvesContext]:
    return Action(
        f"keys.outside_{how}",
        f"Outside: {label}",
        commands.extrapolate(how),
        scope="animation",
        enabled=lambda context: bool(context.curves.spots or context.curves.chosen_rows),
        checked=lambda context: commands.extrapolates(context, how),
        contexts=frozenset({"keys outside"}),
        doc=doc,
    )


def _toggle_snap(context: CurvesContext) -> None:
    context.curves.snap = not context.curves.snap


ANIMATION: tuple[Action[CurvesContext], ...] = (
    Action("keys.mode", "Dope Sheet or Curves", commands.swap_mode, shortcut="Tab", scope="animation"),
    Action(
        "keys.here",
        "Set Keys at This Frame",
        commands.key_here,
        shortcut="K",
        scope="animation",
        enabled=lambda context: bool(context.session.graph.animation),
        doc="Set a key on the curve of every selected row, or of all rows.",
    ),
    Action(
        "keys.cut",
        "Cut Keys",
        commands.cut,
        shortcut="Ctrl+X",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=_KEYS,
    ),
    Action(
        "keys.copy",
        "Copy Keys",
        commands.copy,
        shortcut="Ctrl+C",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=_KEYS,
    ),
    Action(
        "keys.paste",
        "Paste Keys",
        commands.paste,
        shortcut="Ctrl+V",
        scope="animation",
        contexts=_KEYS,
        doc="Paste at the current frame. Keys of one value go into the selected rows.",
    ),
    Action(
        "keys.duplicate",
        "Duplicate Keys",
        commands.duplicate,
        shortcut="Ctrl+D",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=_KEYS,
        doc="The copies follow the selected keys.",
    ),
    Action(
        "keys.delete",
        "Delete Keys",
        commands.delete,
        shortcut="Delete",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=_KEYS,
        doc="A value that loses its last key keeps its current value.",
    ),
    Action("keys.all", "Select All Keys", commands.choose_all, shortcut="Ctrl+A", scope="animation"),
    Action("keys.select_here", "Select Keys at This Frame", commands.choose_here, shortcut="Ctrl+K", scope="animation"),
    Action("keys.none", "Select No Keys", commands.choose_none, shortcut="Ctrl+Shift+A", scope="animation"),
    Action(
        "keys.earlier",
        "Move Keys One Frame Earlier",
        commands.nudge(-1.0),
        shortcut="Alt+LeftArrow",
        scope="animation",
        enabled=has_chosen_keys,
        repeats=True,
    ),
    Action(
        "keys.later",
        "Move Keys One Frame Later",
        commands.nudge(1.0),
        shortcut="Alt+RightArrow",
        scope="animation",
        enabled=has_chosen_keys,
        repeats=True,
    ),
    *(_make_interpolation_action(*entry) for entry in _INTERPOLATIONS),
    Action(
        "keys.ease_in",
        "Ease In",
        commands.ease("in"),
        shortcut="Shift+I",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys ease"}),
        doc="Slow down before the key: its left handle is horizontal.",
    ),
    Action(
        "keys.ease_out",
        "Ease Out",
        commands.ease("out"),
        shortcut="Shift+O",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys ease"}),
        doc="Start slowly after the key: its right handle is horizontal.",
    ),
    Action(
        "keys.ease",
        "Ease In and Out",
        commands.ease("both"),
        shortcut="E",
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys ease"}),
        doc="Slow down before the key and start slowly after it.",
    ),
    Action(
        "keys.automatic",
        "Automatic Handles",
        commands.make_automatic,
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys handles"}),
        doc="Handles follow the smooth curve, even when keys move.",
    ),
    Action(
        "keys.aligned",
        "Aligned Handles",
        commands.make_aligned,
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys handles"}),
        doc="Both handles of a key stay on one line and turn together.",
    ),
    Action(
        "keys.free",
        "Free Handles",
        commands.make_free,
        scope="animation",
        enabled=has_chosen_keys,
        contexts=frozenset({"keys handles"}),
        doc="Each handle turns independently, as with Alt+drag.",
    ),
    *(_make_outside_action(*entry) for entry in _EXTRAPOLATIONS),
    Action(
        "keys.snap",
        "Snap to Frames",
        _toggle_snap,
        shortcut="Shift+S",
        scope="animation",
        checked=lambda context: context.curves.snap,
        doc="Keys that you move snap to whole frames.",
    ),
    Action("keys.fit_all", "Show All Keys", lambda context: context.curves.fit(), shortcut="A", scope="animation"),
    Action(
        "keys.fit_chosen",
        "Show Selected Keys",
        lambda context: context.curves.fit("chosen"),
        shortcut="F",
        scope="animation",
    ),
)
