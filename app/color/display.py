"""Displays, views and looks: color for a screen.

A view of a display is a transform that a config offers, such as ACES tone mapping for an sRGB screen. `none` is a view
of Halation: it only encodes as sRGB. If nobody chose a config, views come from OpenColorIO's built-in config and the
working space from its studio config, so the processor is made across both (`_make_builtin_view_processor`). `bt1886`
does the same for a video display (ITU-R BT.1886: a power of 2.4), as BT.709 video is encoded for one.
"""

from __future__ import annotations

from functools import lru_cache
from types import MappingProxyType
from typing import Any, Literal

from ..errors import UsageError
from ..resources.suggestions import find_near_names
from .management import (
    BUILT_IN,
    ColorManager,
    get_default_color_manager,
    load_builtin_config,
    load_ocio,
    load_studio_config,
)
from .transforms import Array, apply_to_rgb, quantize, unpremultiply

NO_VIEW = "none"
VIDEO_VIEW = "bt1886"
NO_LOOK = "none"
_PLAIN_DISPLAYS = MappingProxyType({NO_VIEW: "sRGB - Display", VIDEO_VIEW: "Rec.1886 Rec.709 - Display"})
"""Views of Halation -> the display of the built-in config for which they only encode."""

_PLAIN_VIEW = "Un-tone-mapped"
"""The view of the built-in config that only encodes."""


def list_displays(manager: ColorManager | None = None) -> tuple[str, ...]:
    """The displays of the config, the default first.

    Raises:
        GraphError, UsageError: no config.
    """
    config = (manager or get_default_color_manager()).config
    first = config.getDefaultDisplay()
    return (*([first] if first else ()), *(name for name in config.getDisplays() if name != first))


def list_views(display: str = "", manager: ColorManager | None = None) -> tuple[str, ...]:
    """The views that a picture on a display may have, the default first; `none` only encodes as sRGB.

    Raises:
        UsageError: unknown display.
        GraphError, UsageError: no config.
    """
    config, screen = (manager or get_default_color_manager()).config, find_display(display, manager)
    first = config.getDefaultView(screen) if screen else ""
    names = tuple(config.getViews(screen)) if screen else ()
    return (*([first] if first in names else ()), *(name for name in names if name != first), NO_VIEW)


def list_looks(manager: ColorManager | None = None) -> tuple[str, ...]:
    """The looks of the config. Raises GraphError, UsageError: no config."""
    return tuple((manager or get_default_color_manager()).config.getLookNames())


def find_view(name: str, display: str = "", manager: ColorManager | None = None) -> str:
    """The view that `name`, or its beginning in any case, means; "" is the default. `bt1886` has to be spelled out.

    Raises:
        UsageError: there is none, or more than one.
    """
    choices = list_views(display, manager)
    if name.casefold() == VIDEO_VIEW:
        return VIDEO_VIEW
    return choices[0] if not name else _match_name(name, choices, "view")


def find_display(name: str, manager: ColorManager | None = None) -> str:
    """The display that `name`, or its beginning in any case, means; "" is the default. Raises UsageError."""
    choices = list_displays(manager)
    return (choices[0] if choices else "") if not name else _match_name(name, choices, "display")


def find_look(name: str, manager: ColorManager | None = None) -> str:
    """The look that `name` means: "" is that of the view, `none` none at all. Raises UsageError."""
    return name if name in ("", NO_LOOK) else _match_name(name, (*list_looks(manager), NO_LOOK), "look")


def check_view(view: str, display: str = "", look: str = "", manager: ColorManager | None = None) -> None:
    """Raise UsageError for a view, display or look that the config does not have."""
    find_view(view, display, manager)
    find_look(look, manager)


def _match_name(name: str, choices: tuple[str, ...], noun: str) -> str:
    word = name.casefold()
    matches = [choice for choice in choices if choice.casefold() == word] or [
        choice for choice in choices if choice.casefold().startswith(word)
    ]
    if len(matches) == 1:
        return matches[0]
    folded = {key: choice for choice in choices for key in (choice.casefold(), choice.casefold().split()[0])}
    close_names = find_near_names(word, folded)
    hint = f"did you mean '{folded[close_names[0]]}'? Choose" if close_names else "choose"
    raise UsageError(f"there is no {noun} '{name}': {hint} from {', '.join(choices)}")


def to_display(
    array: Array,
    view: str = "",
    *,
    bits: Literal[8, 16, 32] = 8,
    display: str = "",
    look: str = "",
    manager: ColorManager | None = None,
) -> Array:
    """Working-space pixels [h, w, 3 or 4] as a display shows them, sRGB by default, in the same shape.

    Four channels are premultiplied on the way in and straight on the way out, since no display transform is
    linear; color without alpha (a glow over nothing) stays as bright as it is. NaN becomes black.

    Returns uint8, uint16 or float32, by `bits`.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config.
    """
    processor = make_display_processor(view, display, look, manager).getDefaultCPUProcessor()
    pixels = unpremultiply(array)
    apply_to_rgb(processor, pixels)
    return pixels if bits == 32 else quantize(pixels, bits)


def make_display_processor(view: str, display: str, look: str = "", manager: ColorManager | None = None) -> Any:
    """The processor from the working space to a display. A `look` replaces the looks of the view.

    Raises:
        UsageError: unknown view, display or look.
        GraphError, UsageError: no config, or one that lacks something.
    """
    if view.casefold() in _PLAIN_DISPLAYS and look in ("", NO_LOOK):
        return _make_plain_processor(manager or get_default_color_manager(), view.casefold())
    screen = find_display(display, manager)
    chosen_view = find_view(view, display, manager)
    chosen_look = find_look(look, manager)
    if chosen_view in _PLAIN_DISPLAYS and chosen_look in ("", NO_LOOK):
        return _make_plain_processor(manager or get_default_color_manager(), chosen_view)
    return _make_view_processor((manager or get_default_color_manager()), screen, chosen_view, chosen_look)


@lru_cache(maxsize=64)
def _make_plain_processor(manager: ColorManager, view: str) -> Any:
    """The processor from the working space to a display, without change of tone."""
    display = _PLAIN_DISPLAYS[view]
    return manager.attempt(
        lambda: _make_builtin_view_processor(manager, load_builtin_config(BUILT_IN), display, _PLAIN_VIEW)
    )


def _make_builtin_view_processor(manager: ColorManager, config: Any, display: str, view: str) -> Any:
    forward, working = load_ocio().TRANSFORM_DIR_FORWARD, manager.working
    if not manager.is_chosen and (space := config.getColorSpace(working.name)):
        return config.getProcessor(space.getName(), display, view, forward)
    source = manager.spaces if working.own else load_studio_config()
    return load_ocio().Config.GetProcessorFromConfigs(source, working.name, config, display, view, forward)


@lru_cache(maxsize=64)
def _make_view_processor(manager: ColorManager, display: str, view: str, look: str) -> Any:
    api = load_ocio()
    if not manager.is_chosen and not look:
        return manager.attempt(lambda: _make_builtin_view_processor(manager, manager.config, display, view))

    def make() -> Any:
        group, space = manager.bridge_to_views()
        if look not in ("", NO_LOOK):
            group.appendTransform(api.LookTransform(space, space, look))
        if plain_display := _PLAIN_DISPLAYS.get(view):
            built_in, forward = load_builtin_config(BUILT_IN), api.TRANSFORM_DIR_FORWARD
            plain = api.Config.GetProcessorFromConfigs(
                manager.config, space, built_in, plain_display, _PLAIN_VIEW, forward
            )
            group.appendTransform(plain.createGroupTransform())
            return manager.config.getProcessor(group)
        group.appendTransform(api.DisplayViewTransform(space, display, view, looksBypass=look != ""))
        return manager.config.getProcessor(group)

    return manager.attempt(make)
