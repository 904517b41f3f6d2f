"""The window that shows while the editor loads: in the middle of its monitor, and drawn with its own OpenGL."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from halation.editor.window import splash


@pytest.mark.parametrize(("platform", "scale"), [("linux", 1.5), ("darwin", 1.0)])
def test_it_is_in_the_middle_of_its_monitor(monkeypatch: pytest.MonkeyPatch, platform: str, scale: float) -> None:
    done = list[tuple[object, ...]]()
    glfw = SimpleNamespace(
        get_primary_monitor=lambda: "monitor",
        get_monitor_workarea=lambda monitor: (100, 50, 1600, 900),
        get_monitor_content_scale=lambda monitor: (1.5, 1.5),
        **{
            name: lambda *words, name=name: done.append((name, *words))
            for name in ("set_window_size", "set_window_pos", "make_context_current", "show_window", "destroy_window")
        },
    )
    monkeypatch.setattr(splash, "glfw", glfw)
    monkeypatch.setattr(splash, "sys", SimpleNamespace(platform=platform))
    monkeypatch.setattr(splash, "open_hidden_window", lambda size, title: ("window", (4, 5)))
    monkeypatch.setattr(splash.Splash, "_draw_line", lambda self: done.append(("draw",)))
    shown = splash.Splash()
    wide, high = (round(side * scale) for side in splash.SIZE)
    assert done == [
        ("set_window_size", "window", wide, high),
        ("set_window_pos", "window", 100 + (1600 - wide) // 2, 50 + (900 - high) // 2),
        ("make_context_current", "window"),
        ("show_window", "window"),
        ("draw",),
    ]
    assert (shown.scale, shown.version) == (scale, (4, 5))
    shown.close()
    shown.close()
    assert done[5:] == [("destroy_window", "window")] and shown.window is None
