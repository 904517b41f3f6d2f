"""A preview on an engine of its own."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest
from halation.authoring.preview import Preview
from halation.renderer import Display, Renderer, open_device


@pytest.fixture
def engine() -> Iterator[Renderer]:
    made = Renderer(open_device(os.environ.get("HALATION_TEST_FORM")))
    yield made
    made.close()


@pytest.fixture
def preview(engine: Renderer) -> Iterator[Preview]:
    display = Display(engine.device)
    made = Preview(engine, display)
    made.patience = 0.0
    yield made
    made.close()
    display.close()
