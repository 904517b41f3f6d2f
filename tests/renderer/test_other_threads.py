"""Other threads of Python go on while the device computes."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator

import pytest
from halation.renderer import Renderer
from halation.renderer.device import Bindings
from halation.renderer.opengl.device import OpenGLDevice

_SOURCE = """#version 430
layout(local_size_x = 16, local_size_y = 16) in;
layout(rgba32f, binding = 0) uniform writeonly image2D target;
void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }
"""
_MOST = 1000
"""Calls after which another thread must have had its turn: one is enough where nothing else runs on the machine."""


@pytest.fixture
def unasked() -> Iterator[None]:
    """The lock of Python passes to another thread only where it is given away: nobody is asked for it."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    yield
    sys.setswitchinterval(before)


@pytest.mark.usefixtures("unasked")
@pytest.mark.parametrize("call", ["dispatch", "finish"])
def test_calls_to_the_device_give_the_lock_away(renderer: Renderer, call: str) -> None:
    device = renderer.device
    assert isinstance(device, OpenGLDevice)
    with device.make_current():
        texture = device.create_texture((1024, 1024), 4, "f4")
        program = device.create_compute_program(_SOURCE)
        had_turn, is_asked = threading.Event(), threading.Event()
        thread = threading.Thread(target=lambda: (is_asked.wait(), had_turn.set()))
        thread.start()
        is_asked.set()
        for _ in range(_MOST):
            if call == "dispatch":
                device.dispatch(program, [texture], Bindings(), (64, 64, 1), reads_images=False)
            else:
                device.clear(texture, (0.0, 0.0, 0.0, 0.0))
                device.finish()
            if had_turn.is_set():
                break
        assert had_turn.is_set()
        thread.join()
        program.release()
        texture.release()
