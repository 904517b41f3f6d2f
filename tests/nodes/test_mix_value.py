"""The values of a mask go from nothing of the change to all of it, and begin with all of it, where the mask is."""

from __future__ import annotations

import pytest
from halation.nodes import catalogue


@pytest.mark.parametrize("id", ["gaussian_blur", "exposure", "glitch"])
def test_a_change_is_mixed_from_none_to_all(id: str) -> None:
    node = catalogue()[id]
    mix = node.values["mix"]
    assert (mix.low, mix.high, mix.minimum, mix.maximum) == (0.0, 1.0, 0.0, 1.0)
    assert mix.default == 1.0 and node.values["invert_mask"].default is False and node.inputs["mask"].optional
