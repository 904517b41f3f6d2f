"""Renders are looked at beside the window: nothing waits."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from halation.authoring.background.render_overviews import OverviewPending, RenderOverviews
from halation.errors import InputError
from halation.nodes import Render
from halation.presets import sample
from halation.render_layers.mattes import IdMap
from halation.render_layers.naming import Role
from halation.render_layers.overview import RenderOverview
from halation.resources.sandbox import UNRESTRICTED

NEON = Path(str(sample()))


@pytest.fixture
def renders():
    made = RenderOverviews(sandbox=UNRESTRICTED)
    yield made
    made.close()


def waited(ask):
    end = time.monotonic() + 120.0
    while (found := ask()) is None and time.monotonic() < end:
        time.sleep(0.01)
    return found


def test_an_overview_comes_later(renders):
    assert renders.overview(NEON) is None
    seen = waited(lambda: renders.overview(NEON, {"depth": ""}))
    assert isinstance(seen, RenderOverview) and seen.uses[Role.DEPTH].layer == "Depth"


def test_the_compiler_is_asked_to_wait(renders):
    with pytest.raises(OverviewPending) as pending:
        renders.describe_render(str(NEON), {})
    assert waited(lambda: pending.value.ready() or None)
    found = renders.describe_render(str(NEON), {})
    assert isinstance(found, Render) and found.camera is not None


def test_what_cannot_be_read_is_a_sentence(renders, tmp_path):
    assert "there is no such file" in renders.overview(tmp_path / "gone.exr")
    broken = tmp_path / "broken.exr"
    broken.write_bytes(b"no picture at all")
    assert "broken.exr" in waited(lambda: renders.overview(broken))
    with pytest.raises(InputError, match="broken"):
        renders.describe_render(str(broken), {})
    seen = waited(lambda: renders.overview(NEON, {"depth": "Depht"}))
    assert seen.uses[Role.DEPTH].fault and seen.uses[Role.NORMAL].layer == "Normal"
    with pytest.raises(InputError, match="Depht"):
        renders.describe_render(str(NEON), {"depth": "Depht"})


def test_what_is_where_comes_later(renders):
    matte = waited(lambda: renders.overview(NEON)).mattes[0]
    found = waited(lambda: renders.ids(NEON, matte))
    assert isinstance(found, IdMap) and found.ids.any()
