"""Helpers of tests of the viewer: points of the picture, and what the window shows there."""

from __future__ import annotations

import numpy as np
from halation import presets

PRESET = next(path for path in presets.paths() if path.stem == "film_halation")
WIDTH, HEIGHT = 480, 270


def inside(ui, x: float, y: float) -> tuple[float, float]:
    """The screen point of a fraction of the picture."""
    return ui.at("viewer image", (x, y))


def hover(ui, x: float = 0.4, y: float = 0.4) -> None:
    ui.move(inside(ui, x, y))
    ui.wait(3)


def seen(ui, x: float, y: float) -> np.ndarray:
    """What the window shows at a fraction of the picture, 0..255."""
    left, top = (int(part) for part in inside(ui, x, y))
    ui.move((5.0, 5.0))
    ui.wait(2)
    return ui.pixels()[top, left].astype(int)


def shown_plainly(picture: np.ndarray) -> np.ndarray:
    from halation.color.display import to_display

    return to_display(picture, "none")[..., :3].astype(int)
