"""What a server keeps from one request to the next."""

from __future__ import annotations

import io
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from halation.compiler import planner
from halation.resources.sandbox import UNRESTRICTED
from halation.serving.listening import make_line_writer
from halation.serving.request_queue import ServiceClient
from halation.serving.service import RenderService, ServiceLimits
from halation.serving.service_requests import ServiceRequest


def write_graph(path: Path, light: dict[str, Any]) -> None:
    parts = {
        "outputs": {"image": {"type": "Image"}},
        "nodes": {"white": {"type": "constant", "values": {"color": [1.0, 1.0, 1.0, 1.0]}}, "light": light},
        "links": {"light.image": "white.out", "outputs.image": "light.out"},
        "settings": {"size": [3, 2]},
    }
    path.write_text(json.dumps({"halation": 1, **parts}))


def test_a_graph_is_lowered_once_for_many_values(renderer, monkeypatch, tmp_path):
    """Each request loads its graph, since the file may have changed; an equal one is planned as an edit."""
    lowered: list[object] = []

    def count_lowering(graph, *rest):
        lowered.append(graph)
        return lower(graph, *rest)

    lower = planner.lower
    monkeypatch.setattr(planner, "lower", count_lowering)
    replies: list[Any] = []
    service, client = RenderService(renderer, UNRESTRICTED, ServiceLimits()), ServiceClient(replies.append)
    path = tmp_path / "light.json"

    def find_brightness(**values: Any) -> float:
        service.answer(client, ServiceRequest("render", graph=str(path), set=values, precision="float"))
        return float(np.frombuffer(replies.pop()["pictures"]["image"]["pixels"], np.float32)[0])

    write_graph(path, {"type": "exposure"})
    assert [find_brightness(**{"light.stops": stops}) for stops in (1.0, 2.0, 3.0)] == [2.0, 4.0, 8.0]
    assert len(lowered) == 1
    write_graph(path, {"type": "saturation"})
    assert find_brightness() == 1.0
    assert len(lowered) == 2


@pytest.mark.parametrize("fault", [BrokenPipeError, ValueError])
def test_a_client_that_cannot_be_written_to_is_dropped(fault) -> None:
    gone, replies = list[bool](), io.BytesIO()
    write = make_line_writer(replies, lambda: gone.append(True))
    write(b"one\n")
    assert replies.getvalue() == b"one\n" and not gone

    def fail(line: bytes) -> int:
        raise fault

    broken: Any = SimpleNamespace(write=fail, flush=lambda: None)
    make_line_writer(broken, lambda: gone.append(True))(b"two\n")
    assert gone == [True]
