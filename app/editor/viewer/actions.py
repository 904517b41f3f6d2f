"""Actions of the viewer: view, channels, comparison, exposure and warnings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...authoring.commands import AssignViewer
from ...language.translation import mark
from ..shared.action import Action
from .state import BACKGROUNDS, PROXIES, SCOPES, Background, Channels, Compare
from .wanted import has_overscan

if TYPE_CHECKING:
    from .context import ViewerContext

_CHANNELS: tuple[tuple[Channels, str, str], ...] = (
    ("color", mark("Color"), "C"),
    ("red", mark("Red"), "R"),
    ("green", mark("Green"), "G"),
    ("blue", mark("Blue"), "B"),
    ("alpha", mark("Alpha"), "A"),
    ("luminance", mark("Luminance"), "L"),
    ("false color", mark("False Color"), "Shift+L"),
)
_COMPARES: tuple[tuple[Compare, str, str], ...] = (
    ("wipe", "Wipe", "W"),
    ("beside", "Side by Side", "S"),
    ("difference", "Difference", "D"),
    ("toggle", "A or B", ""),
)
_PAN = 0.125
"""The part of the panel by which a key moves the picture."""
_WAYS: tuple[tuple[str, str, float, float], ...] = (
    ("Left", mark("Look Left"), 1.0, 0.0),
    ("Right", mark("Look Right"), -1.0, 0.0),
    ("Up", mark("Look Up"), 0.0, 1.0),
    ("Down", mark("Look Down"), 0.0, -1.0),
)
_SHOWN = frozenset({"viewer"})


def _set(**values: Any):
    """A function that sets fields of the viewer's state."""

    def act(context: ViewerContext) -> None:
        for name, value in values.items():
            setattr(context.viewer, name, value)

    return act


def _flip(name: str):
    def act(context: ViewerContext) -> None:
        setattr(context.viewer, name, not getattr(context.viewer, name))

    return act


def _is(name: str, value: Any = True):
    return lambda context: getattr(context.viewer, name) == value


def _expose(step: float):
    def act(context: ViewerContext) -> None:
        context.viewer.exposure = round(context.viewer.exposure + step, 3)

    return act


def _zoom(factor: float):
    def act(context: ViewerContext) -> None:
        context.viewer.nearer *= factor

    return act


def _pan(x: float, y: float):
    def act(context: ViewerContext) -> None:
        before = context.viewer.shift
        context.viewer.shift = (before[0] + _PAN * x, before[1] + _PAN * y)

    return act


def _toggle(context: ViewerContext) -> None:
    """Toggle between A and B; the first press shows B."""
    viewer = context.viewer
    viewer.toggled = not viewer.toggled if viewer.compare == "toggle" else True
    viewer.compare = "toggle"


def _swap(context: ViewerContext) -> None:
    session = context.session
    first, second = session.views.find_port("A"), session.views.find_port("B")
    if first and second:
        session.views.show(second, "A")
        session.views.show(first, "B")


def _region(context: ViewerContext) -> None:
    """Start to draw a region of interest; if there is one, remove it."""
    viewer = context.viewer
    viewer.drawing_region = viewer.region is None and not viewer.drawing_region
    viewer.region = None


def _views_picture(context: ViewerContext) -> bool:
    return context.session.views.find_port("A") is not None


def _background(name: Background) -> Action[ViewerContext]:
    return Action(
        f"viewer.background.{name}",
        name.capitalize(),
        _set(background=name),
        "Viewer/Background",
        checked=_is("background", name),
    )


def _proxy(scale: float) -> Action[ViewerContext]:
    return Action(
        f"viewer.proxy.{1 / scale:.0f}",
        f"1/{1 / scale:.0f}",
        _set(proxy=scale),
        "Viewer/Proxy",
        checked=_is("proxy", scale),
        doc="Compute at a lower resolution.",
    )


def _scope(name: str) -> Action[ViewerContext]:
    def act(context: ViewerContext) -> None:
        context.viewer.scopes ^= {name}

    return Action(
        f"scopes.{name}", name.capitalize(), act, "Viewer/Scopes", checked=lambda context: name in context.viewer.scopes
    )


def _make_bookmark_actions(number: int) -> tuple[Action[ViewerContext], Action[ViewerContext]]:
    recall: Action[ViewerContext] = Action(
        f"viewer.recall.{number}",
        f"Show {number}",
        lambda context: context.session.views.recall(number),
        "Viewer/Bookmarks",
        str(number),
        enabled=lambda context: number in context.session.views.numbered_ports,
        doc="Show the node that is assigned to this key.",
    )
    assign: Action[ViewerContext] = Action(
        f"viewer.assign.{number}",
        f"Assign {number}",
        lambda context: context.session.apply(AssignViewer(number)),
        "Viewer/Bookmarks",
        f"Ctrl+{number}",
        enabled=_views_picture,
        doc="Assign the active node to this key, or what is viewed now.",
    )
    return recall, assign


_BOOKMARKS = tuple(_make_bookmark_actions(number) for number in range(1, 10))

VIEWER: tuple[Action[ViewerContext], ...] = (
    Action(
        "viewer.fit",
        "Fit",
        lambda context: context.viewer.fit(),
        "Viewer",
        "F",
        "viewer",
        contexts=_SHOWN,
        checked=lambda context: context.viewer.zoom == 0.0,
        doc="Fit the whole picture into the panel.",
    ),
    Action(
        "viewer.actual",
        "Actual Pixels",
        _set(zoom=1.0, pan=(0.0, 0.0)),
        "Viewer",
        "0",
        "viewer",
        contexts=_SHOWN,
        checked=_is("zoom", 1.0),
        doc="Show one pixel of the picture as one pixel of the screen.",
    ),
    Action(
        "viewer.unsqueeze",
        "Pixel Aspect Ratio",
        _flip("unsqueezes"),
        "Viewer",
        "",
        "viewer",
        lambda context: context.viewer.pixel_aspect != 1.0,
        _is("unsqueezes"),
        doc="Show pixels in their shape, as the file says: an anamorphic picture as wide as it is meant.",
    ),
    Action(
        "viewer.overscan",
        "Show Beyond the Frame",
        _flip("overscan"),
        "Viewer",
        "Shift+O",
        "viewer",
        has_overscan,
        _is("overscan"),
        doc="Show, dimmed, what the picture has outside of its frame. Only a project with an overscan has it.",
    ),
    Action("viewer.nearer", "Zoom In", _zoom(2.0), "Viewer", "Equal", "viewer"),
    Action("viewer.farther", "Zoom Out", _zoom(0.5), "Viewer", "Minus", "viewer"),
    *(
        Action(
            f"viewer.look_{key.lower()}",
            label,
            _pan(x, y),
            "Viewer/Pan",
            f"Ctrl+Shift+{key}Arrow",
            "viewer",
            repeats=True,
        )
        for key, label, x, y in _WAYS
    ),
    *(
        Action(
            f"viewer.{name.replace(' ', '_')}",
            label,
            lambda context, name=name: context.viewer.show(name),
            "Viewer/Channels",
            key,
            "viewer",
            checked=_is("channels", name),
        )
        for name, label, key in _CHANNELS
    ),
    *(
        Action(
            f"viewer.{name}",
            label,
            lambda context, name=name: context.viewer.toggle_comparison(name),
            "Viewer/Compare",
            key,
            "viewer",
            checked=_is("compare", name),
        )
        for name, label, key in _COMPARES
    ),
    Action(
        "viewer.other",
        "Toggle A and B",
        _toggle,
        "Viewer/Compare",
        "Q",
        "viewer",
        doc="Show B in place of A, and back.",
    ),
    Action(
        "viewer.swap",
        "Swap A and B",
        _swap,
        "Viewer/Compare",
        "Shift+X",
        "viewer",
        lambda context: _views_picture(context) and context.session.views.find_port("B") is not None,
    ),
    Action(
        "viewer.brighter",
        "Brighter",
        _expose(0.5),
        "Viewer/Exposure",
        "RightBracket",
        "viewer",
        repeats=True,
        doc="Half a stop brighter, in the viewer only.",
    ),
    Action(
        "viewer.darker",
        "Darker",
        _expose(-0.5),
        "Viewer/Exposure",
        "LeftBracket",
        "viewer",
        repeats=True,
        doc="Half a stop darker, in the viewer only.",
    ),
    Action(
        "viewer.neutral",
        "Reset Exposure and Gamma",
        _set(exposure=0.0, gamma=1.0),
        "Viewer/Exposure",
        "Backslash",
        "viewer",
        lambda context: context.viewer.exposure != 0.0 or context.viewer.gamma != 1.0,
    ),
    *(_background(name) for name in BACKGROUNDS),
    *(_proxy(scale) for scale in PROXIES),
    Action(
        "viewer.pause",
        "Pause",
        _flip("paused"),
        "Viewer",
        "P",
        "viewer",
        checked=_is("paused"),
        separated=True,
        doc="Stop computing pictures until you switch this off.",
    ),
    Action(
        "viewer.clipping",
        "Show Clipping",
        _flip("warn_clipping"),
        "Viewer/Warnings",
        "Z",
        "viewer",
        checked=_is("warn_clipping"),
        doc="Stripes where values are outside of the display's range.",
    ),
    Action(
        "viewer.nonfinite",
        "Show NaN and Infinity",
        _flip("warn_nonfinite"),
        "Viewer/Warnings",
        checked=_is("warn_nonfinite"),
        doc="Magenta where values are NaN or infinite.",
    ),
    Action(
        "viewer.find_nonfinite",
        "Find Source of NaN and Infinity",
        _set(finding=True),
        "Viewer/Warnings",
        enabled=_views_picture,
        doc="Check one node after another, starting at the inputs.",
    ),
    Action(
        "viewer.region",
        "Region of Interest",
        _region,
        "Viewer",
        "Shift+R",
        "viewer",
        _views_picture,
        lambda context: context.viewer.drawing_region or context.viewer.region is not None,
        contexts=_SHOWN,
        doc="Drag a rectangle: scopes and pixel values measure only what is in it.",
    ),
    Action(
        "viewer.table",
        "Pixel Values",
        _flip("table"),
        "Viewer",
        "I",
        "viewer",
        checked=_is("table"),
        contexts=_SHOWN,
        doc="A table of the values of every input, at rectangles (Ctrl+drag) and markers (Ctrl+click).",
    ),
    Action(
        "viewer.clear_markers",
        "Clear Markers",
        _set(markers=(), measured=None),
        "Viewer",
        "",
        "viewer",
        lambda context: bool(context.viewer.markers or context.viewer.measured),
        contexts=_SHOWN,
    ),
    Action(
        "viewer.copy",
        "Copy Pixel Values",
        _set(copying=True),
        "Viewer",
        "Ctrl+C",
        "viewer",
        _views_picture,
        contexts=_SHOWN,
        doc="Copy the numbers under the pointer.",
    ),
    Action(
        "viewer.save",
        "Save Viewer Picture...",
        _set(saving=True),
        "Viewer",
        enabled=_views_picture,
        contexts=_SHOWN,
        doc="Save the picture as the viewer shows it, at full size.",
    ),
    *(_scope(name) for name in SCOPES),
    *(recall for recall, _ in _BOOKMARKS),
    *(assign for _, assign in _BOOKMARKS),
)
