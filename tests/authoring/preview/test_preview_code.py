"""Code that a driver cannot compile, or takes long over, neither ends the editor nor has it stand still."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import pytest
from halation.custom_nodes import Code, node_type
from halation.graph import Graph, Port
from halation.nodes.input.constant import Constant
from unseen_code import write_slow_code, write_sum


def chain(code: str) -> Graph:
    graph = Graph().add("plain", Constant()).add("user", node_type(Code("glsl", code))())
    return graph.connect(Port("plain", "out"), Port("user", "image"))


def finish(preview) -> None:
    """Work until everything is shown."""
    end = time.monotonic() + 60.0
    while preview.busy and time.monotonic() < end:
        preview.work(0.01)
        time.sleep(0.005)


def test_no_step_waits_for_a_compiler(preview) -> None:
    preview.want(chain(write_sum(1)), {"A": Port("user", "out")})
    finish(preview)  # which reads the shaders of Halation
    preview.want(chain(write_sum(60)), {"A": Port("user", "out")})
    waits, end = 0, time.monotonic() + 120.0
    while preview.busy and time.monotonic() < end:
        preview.work(0.01)
        waits += 1
        time.sleep(0.005)
    assert preview.find_whole_image("A") is not None and not preview.faults
    assert waits > 10  # a step that waited for the compiler would be the only one


def test_no_step_waits_for_code_that_nothing_reads(preview) -> None:
    unread = node_type(Code("glsl", write_sum(60)))()
    preview.want(chain(write_sum(1)).add("unread", unread), {"A": Port("user", "out")})
    finish(preview)  # the picture is there, and the other code is tried from now on
    waits, end = 0, time.monotonic() + 120.0
    while preview.work(0.01) and time.monotonic() < end:
        waits += 1
        time.sleep(0.005)
    assert not preview.faults
    assert waits > 10


@pytest.mark.skipif(sys.platform != "linux", reason="it lists the processes of this one")
@pytest.mark.usefixtures("compiles_as_for_users")  # without its optimizer, the compiler is done too soon
def test_a_compiler_that_dies_is_a_fault_of_the_node(preview) -> None:
    graph = chain(write_slow_code())
    preview.want(graph, {"A": Port("user", "out")})
    preview.work(0.01)
    time.sleep(1.0)
    for task in Path("/proc/self/task").iterdir():
        for child in (task / "children").read_text().split():
            if b"trial_worker" in Path(f"/proc/{child}/cmdline").read_bytes():
                os.kill(int(child), signal.SIGSEGV)
    while preview.work(0.01):  # nobody tries it a second time
        time.sleep(0.005)
    assert "SIGSEGV" in str(preview.faults["user"])
    preview.want(chain(write_sum(2)), {"A": Port("user", "out")})
    finish(preview)
    assert preview.find_whole_image("A") is not None and not preview.faults
