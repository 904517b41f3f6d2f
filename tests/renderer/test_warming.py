"""Loading a driver early changes nothing but the time that opening takes."""

from __future__ import annotations

import threading

from halation.renderer import Renderer, open_device
from halation.renderer.opengl.warming import warm
from halation.resources.sandbox import UNRESTRICTED


def test_a_device_is_the_same_while_and_after_its_driver_is_loaded(renderer: Renderer) -> None:
    warm()
    for _ in range(2):
        other = open_device(sandbox=UNRESTRICTED)
        try:
            assert other.target == renderer.device.target
        finally:
            other.close()
        for thread in threading.enumerate():
            if thread.name == "warm":
                thread.join()
