"""Programs with code of users are tried in another process first: what happens to that one is an error here."""

from __future__ import annotations

import gc
import os
import signal
import sys
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from halation.custom_nodes import Code, node_type
from halation.errors import DeviceError, ShaderError
from halation.graph import Graph, Input, Output, Port
from halation.nodes.color.exposure import Exposure
from halation.renderer import Renderer, RenderRequest, open_device
from halation.renderer.execution.trials import Trial, TrialProcess
from halation.resources.sandbox import UNRESTRICTED
from unseen_code import write_product, write_slow_code

pytestmark = pytest.mark.usefixtures("compiles_as_for_users")

PICTURE = np.full((8, 8, 4), 0.5, np.float32)
REQUEST = RenderRequest({"image": PICTURE})
SLOW = write_slow_code()


def graph(code: str) -> Graph:
    made = (
        Graph()
        .add_input("image", Input())
        .add_output("out", Output(width=4))
        .add("user", node_type(Code("glsl", code))())
    )
    return made.connect(Port("inputs", "image"), Port("user", "image")).connect(
        Port("user", "out"), Port("outputs", "out")
    )


def effect(factor: float) -> Graph:
    return graph(write_product(factor))


@pytest.fixture
def trial_process() -> TrialProcess:
    return TrialProcess(timeout=2.0)


@pytest.fixture
def tried(trial_process: TrialProcess) -> Iterator[Renderer]:
    renderer = Renderer(trial_process=trial_process, sandbox=UNRESTRICTED)
    yield renderer
    renderer.close()


@pytest.fixture
def submitted(trial_process: TrialProcess, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The nodes whose programs were tried, in turn."""
    nodes_tried: list[str] = []
    submit = trial_process.submit

    def record(program: Mapping[str, Any], nodes: str, *, may_yield: bool) -> Future[Trial]:
        nodes_tried.append(nodes)
        return submit(program, nodes, may_yield=may_yield)

    monkeypatch.setattr(trial_process, "submit", record)
    return nodes_tried


def list_children() -> set[int]:
    """The numbers of all processes that a thread of this one has started."""
    tasks = Path("/proc/self/task").glob("*/children")
    return {int(number) for task in tasks for number in task.read_text().split()}


def test_code_is_tried_once(tried: Renderer, submitted: list[str]) -> None:
    program = effect(0.5)
    assert (tried.render(program, REQUEST)["out"] == 0.25).all()
    again = tried.render(program, RenderRequest({"image": PICTURE[:4]}))
    assert (again["out"] == 0.25).all() and len(submitted) == 1


def test_code_that_takes_too_long_to_compile(tried: Renderer, submitted: list[str]) -> None:
    for _ in range(2):  # what is known is not tried again
        with pytest.raises(DeviceError, match="node 'user': its code has not been compiled and run after 2 seconds"):
            tried.render(graph(SLOW), REQUEST)
    assert len(submitted) == 1
    assert (tried.render(effect(2.0), REQUEST)["out"] == 1.0).all()


def measure_work(process: int) -> float:
    """The processor time of another process, in seconds."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")
def test_code_that_ends_the_process() -> None:
    """Long before it would take too long."""
    tried, others = Renderer(trial_process=TrialProcess(timeout=0.0), sandbox=UNRESTRICTED), list_children()
    tried.render(effect(0.25), REQUEST)
    (number,) = list_children() - others
    before = measure_work(number)
    with tried.runner.start_run(tried.compile(graph(SLOW), REQUEST), tried.runner.create_lease()) as run:
        assert not run.is_ready
        while measure_work(number) < before + 0.1:
            time.sleep(0.01)  # one that ended before it began to compile would only be started again
        os.kill(number, signal.SIGSEGV)
        with pytest.raises(DeviceError, match=r"node 'user': its code has ended the process \(SIGSEGV\)"):
            next(run)
    assert (tried.render(effect(2.0), REQUEST)["out"] == 1.0).all()
    tried.close()


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")
def test_a_renderer_that_nobody_closes_leaves_no_process() -> None:
    device = open_device(sandbox=UNRESTRICTED)
    others = list_children()
    renderer = Renderer(device, sandbox=UNRESTRICTED)
    renderer.render(effect(0.75), REQUEST)
    assert list_children() - others
    del renderer
    gc.collect()
    while list_children() - others:
        time.sleep(0.01)
    device.close()


def test_a_closed_process_can_be_started_again(trial_process: TrialProcess) -> None:
    for number in (0.3, 0.4):
        renderer = Renderer(trial_process=trial_process, sandbox=UNRESTRICTED)
        assert np.allclose(renderer.render(effect(number), REQUEST)["out"], number / 2.0)
        renderer.close()


def test_a_run_says_when_it_would_wait(tried: Renderer) -> None:
    """So an editor draws its window meanwhile."""
    with tried.runner.start_run(tried.compile(graph(SLOW), REQUEST), tried.runner.create_lease()) as run:
        waits = 0
        while not run.is_ready:
            time.sleep(0.01)
            waits += 1
        assert waits > 3, "to ask takes no part of the two seconds"
        with pytest.raises(DeviceError, match="after 2 seconds"):
            next(run)


def test_a_slow_program_makes_way_once() -> None:
    """Whoever has written a better text does not wait for the old one, which takes minutes and has no limit here."""
    renderer = Renderer(trial_process=TrialProcess(timeout=0.0), sandbox=UNRESTRICTED)
    slow = renderer.runner.start_run(renderer.compile(graph(SLOW), REQUEST), renderer.runner.create_lease())
    assert not slow.is_ready
    slow.close()
    assert (renderer.render(effect(2.0), REQUEST)["out"] == 1.0).all()
    renderer.close()


def test_faults_of_drivers_keep_their_lines(tried: Renderer) -> None:
    with pytest.raises(ShaderError, match=r"node 'user': the code of 'f', line 2: .*nothing"):
        tried.render(graph("vec4 f(vec4 image) {\n return nothing; }"), REQUEST)


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of another one")
def test_what_has_no_code_of_users_starts_nothing(tried: Renderer) -> None:
    others = list_children()
    plain = Graph().add_input("image", Input()).add_output("out", Output(width=4)).add("node", Exposure(stops=1.0))
    plain = plain.connect(Port("inputs", "image"), Port("node", "image"))
    tried.render(plain.connect(Port("node", "out"), Port("outputs", "out")), REQUEST)
    assert list_children() <= others


def test_code_that_would_run_for_minutes_is_refused_before_it_runs() -> None:
    """Nothing can stop a device that has begun. On few pixels the same code runs."""
    rounds = graph("""vec4 slow(vec4 image) {
        float sum = image.r;
        for (int i = 0; i < 40000; i++) sum = fract(sin(sum + float(i)) * 437.5);
        return vec4(sum);
    }""")
    renderer = Renderer(trial_process=TrialProcess(timeout=4.0), sandbox=UNRESTRICTED)
    few, many = (RenderRequest({"image": np.full((side, side, 4), 0.5, np.float32)}) for side in (8, 2048))
    assert np.isfinite(renderer.render(rounds, few)["out"]).all()
    with pytest.raises(DeviceError, match=r"node 'user': its code would run for about .* minutes on 2048x2048 pixels"):
        renderer.render(rounds, many)
    assert np.isfinite(renderer.render(rounds, few)["out"]).all()
    renderer.close()
