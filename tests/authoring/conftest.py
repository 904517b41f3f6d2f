"""A preview on an engine of its own."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from devices import open_renderer
from halation.authoring.preview import Preview
from halation.renderer import Display, Renderer


@pytest.fixture
def engine() -> Iterator[Renderer]:
    renderer = open_renderer()
    yield renderer
    renderer.close()


@pytest.fixture
def preview(engine: Renderer) -> Iterator[Preview]:
    display = Display(engine.device)
    preview = Preview(engine, display)
    preview.patience = 0.0
    yield preview
    preview.close()
    display.close()
