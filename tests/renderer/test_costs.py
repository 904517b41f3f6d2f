"""What results cost, as far as it is known."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import graph_of
from halation.nodes.blur.gaussian_blur import GaussianBlur
from halation.nodes.color.exposure import Exposure
from halation.renderer import Renderer, RenderRequest
from halation.renderer.execution.costs import PassCosts


def planned(renderer: Renderer, node, side: int = 32):
    inputs = {"image": np.ones((side, side, 4), np.float32)}
    return renderer.compile(graph_of(node, inputs), RenderRequest(inputs))


def test_what_was_measured_holds_for_every_size(renderer):
    costs, light = PassCosts(True), Exposure(stops=1.0)
    small, large = planned(renderer, light), planned(renderer, light, 64)
    for seconds in (0.5, 0.001):  # a program is finished when it first runs
        costs.record_time(small, small.passes[0], seconds)
    assert costs.estimate(small, small.passes[0]) == pytest.approx(0.001)
    assert costs.estimate(large, large.passes[0]) == pytest.approx(0.004)
    costs.record_time(large, large.passes[0], 0.008)
    assert costs.estimate(small, small.passes[0]) == pytest.approx(0.002)


def test_before_that_it_is_estimated_by_what_is_read(renderer):
    costs = PassCosts(True)
    point, blur = planned(renderer, Exposure(stops=1.0)), planned(renderer, GaussianBlur(sigma=3.0))
    cheap, dear = (max(costs.estimate(plan, one) for one in plan.passes) for plan in (point, blur))
    assert 0.0 < cheap < dear
    costs.record_time(point, point.passes[0], 0.5)
    assert costs.estimate(point, point.passes[0]) == cheap
