"""The Animation panel in every state that looks different: yields names of pictures."""

from __future__ import annotations

from collections.abc import Iterator

from gui_driver import Ui
from halation.authoring.commands import AnimateValues, SetFrameRange
from halation.graph import Expression, Key, Keys, Port


def animation(ui: Ui) -> Iterator[str]:
    """Nothing that moves; keys; curves."""
    before = ui.session.root
    ui.ctx.window_focus("//Animation")
    ui.wait(4)
    yield "animation_none"
    intensity, gain = Port("bloom", "intensity"), Port("grade", "gain")
    ui.session.apply(SetFrameRange(1, 48))
    ui.session.apply(
        AnimateValues(
            {
                intensity: Keys((Key(1, 0.2), Key(12, 0.9), Key(24, 0.9), Key(40, 0.1, "constant"))),
                Port("bloom", "knee"): Keys(
                    (Key(5, 0.2, "bezier"), Key(20, 1.0, "bezier"), Key(30, 0.4, "linear")), "loop"
                ),
                gain: Keys(
                    (Key(1, (1.0,) * 4), Key(10, (1.5, 0.7, 0.8, 1.0), "linear"), Key(30, (0.8, 1.2, 1.4, 1.0)))
                ),
                Port("tone_map", "exposure"): Expression("0.3 + 0.1 * sin(time * tau)"),
            },
            "Animate",
        )
    )
    ui.session.time.seek(16)
    state = ui.editor.curves
    state.fit()
    state.choose(frozenset({(intensity, 12.0, 0), (intensity, 24.0, 0), (Port("bloom", "knee"), 20.0, 0)}))
    ui.wait(4)
    yield "animation_keys"
    state.mode = "curves"
    state.choose(frozenset({(Port("bloom", "knee"), 20.0, 0)}))
    state.fit()
    ui.wait(4)
    yield "animation_curves"
    ui.click("button keys legend" if "button keys legend" in ui.editor.places else "button more keys")
    yield "animation_legend"
    ui.keys("Escape")
    state.mode = "sheet"
    while ui.session.root is not before:
        ui.session.undo()
    ui.ctx.window_focus("//Graph")
    ui.wait(4)
