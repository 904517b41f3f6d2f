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
from halation.serving import service as service_module
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


@pytest.mark.parametrize(("reason", "said"), [("cancelled", [{"id": 7, "cancelled": True}]), ("gone", [])])
def test_a_request_that_nobody_needs_any_more_is_not_begun(renderer, reason: str, said: list[Any]) -> None:
    replies: list[Any] = []
    service, client = RenderService(renderer, UNRESTRICTED, ServiceLimits()), ServiceClient(replies.append)
    client.cancelled_ids |= {7} if reason == "cancelled" else set()
    client.is_gone = reason == "gone"
    service.answer(client, ServiceRequest("render", id=7, graph="no such graph"))
    assert replies == said and not client.cancelled_ids
    client.is_gone = False
    service.answer(client, ServiceRequest("render", id=7, graph="no such graph"))  # the same name may be used again
    assert [(reply["id"], reply["error"]["exit_code"]) for reply in replies[len(said) :]] == [(7, 3)]


@pytest.mark.parametrize(("seconds", "is_refused"), [(5.0, True), (0.0, False), (7.0, False)])
def test_a_request_may_take_so_long(renderer, monkeypatch, seconds: float, is_refused: bool) -> None:
    """Each look at the clock takes three seconds; 0 is no limit."""
    looks = iter(range(0, 3000, 3))
    monkeypatch.setattr(service_module, "time", SimpleNamespace(monotonic=lambda: float(next(looks))))
    replies: list[Any] = []
    service = RenderService(renderer, UNRESTRICTED, ServiceLimits(seconds=seconds))

    def answer(request: ServiceRequest, check: Any) -> dict[str, Any]:
        check(1, 2, 3)
        return {"done": True}

    monkeypatch.setattr(service, "_choose_answer", lambda request: answer)
    service.answer(ServiceClient(replies.append), ServiceRequest("check", id=1))
    (reply,) = replies
    assert reply.get("done", False) is not is_refused
    assert not is_refused or "takes more than 5 seconds" in reply["error"]["message"]
