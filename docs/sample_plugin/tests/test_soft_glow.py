"""The glow spreads light and loses none."""

from pathlib import Path

import acme_glow
import halation as hal
import numpy as np
from halation.nodes import catalogue

PRESET = Path(acme_glow.__file__).parent / "presets" / "acme_dream.json"


def render_glow(picture: np.ndarray, **values: float) -> np.ndarray:
    """The picture with the glow of the preset, at other values, and without its warm light."""
    graph = hal.load(PRESET)
    settings = {f"glow.{name}": value for name, value in values.items()}
    return hal.render(graph, {"beauty": picture}, values={"warm.temperature": 6500.0, **settings})["image"]


def test_light_spreads_and_none_is_lost() -> None:
    """One bright pixel becomes a soft spot with the same sum."""
    picture = np.zeros((64, 64, 4), np.float32)
    picture[32, 32] = 100.0
    glow = render_glow(picture, radius=0.05, amount=1.0)
    assert 0.0 < glow[32, 40, 1] < glow[32, 32, 1] < 100.0
    assert np.isclose(glow[..., 3].sum(), 100.0, rtol=1e-2)


def test_without_amount_the_picture_is_unchanged() -> None:
    """The node passes its input through."""
    assert catalogue()["acme_glow.soft_glow"](amount=0.0).identity() == "image"
