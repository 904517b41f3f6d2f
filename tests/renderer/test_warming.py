"""Loading a driver early changes nothing but the time that opening takes."""

from __future__ import annotations

import platform
import subprocess
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest
from halation.renderer import Renderer, open_device
from halation.renderer.opengl import warming
from halation.renderer.opengl.warming import wait_for_driver, warm
from halation.resources.sandbox import UNRESTRICTED

IMPORTS = """
import sys
from halation.renderer.opengl.warming import wait_for_driver, warm

warm()
changes = []
sys.addaudithook(lambda event, words: changes.append(words) if event in ("os.putenv", "os.unsetenv") else None)
import numpy, OpenImageIO, PyOpenColorIO, moderngl, halation, halation.media, halation.renderer
wait_for_driver()
print(changes)
"""


def test_a_device_is_the_same_while_and_after_its_driver_is_loaded(renderer: Renderer) -> None:
    warm()
    for _ in range(2):
        other = open_device(sandbox=UNRESTRICTED)
        try:
            assert other.target == renderer.device.target
        finally:
            other.close()
        wait_for_driver()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="this system has no early loading")
def test_the_environment_stays_while_a_driver_is_loaded() -> None:
    """Drivers read it meanwhile, and another thread that changes it may take the memory from under them."""
    process = subprocess.run([sys.executable, "-c", IMPORTS], capture_output=True, text=True, check=True)
    assert process.stdout.strip() == "[]"


LOADED = """
import sys
from pathlib import Path
from halation.renderer.opengl.warming import wait_for_driver, warm

def is_loaded():
    return "OpenImageIO" in Path("/proc/self/maps").read_text()

before = is_loaded()
warm()
wait_for_driver()
after, names = is_loaded(), {*sys.modules} & {"numpy", "OpenImageIO"}
import OpenImageIO
print(before, after, names, OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(2, 2, 1, "float")).spec().width)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="this system has no early loading")
def test_the_library_of_openimageio_is_there_before_python_imports_it() -> None:
    process = subprocess.run([sys.executable, "-c", LOADED], capture_output=True, text=True, check=True)
    assert process.stdout.strip() == "False True set() 2"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="this system has no early loading")
def test_what_cannot_be_loaded_early_is_no_error(tmp_path: Path) -> None:
    """No such file, and one that is no library."""
    for content in (None, b"no library"):
        if content is not None:
            (tmp_path / f"OpenImageIO{EXTENSION_SUFFIXES[0]}").write_bytes(content)
        warming._load_openimageio(tmp_path)
        assert str(tmp_path) not in Path("/proc/self/maps").read_text()


ROOM = """
import threading
from halation.renderer.opengl import warming

def measure():
    \"\"\"MiB of the largest mapping that can be written.\"\"\"
    lines = [line.split() for line in open("/proc/self/maps")]
    ends = [[int(end, 16) for end in line[0].split("-")] for line in lines if line[1] == "rw-p"]
    return max(last - first for first, last in ends) >> 20

def work():
    before = measure()
    warming._make_room()
    print(before < 24, measure() >= 24, measure() < 64)

thread = threading.Thread(target=work)
thread.start()
thread.join()
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="this system has no early loading")
def test_a_heap_has_room_for_the_strings_of_openimageio_at_once() -> None:
    process = subprocess.run([sys.executable, "-c", ROOM], capture_output=True, text=True, check=True)
    assert process.stdout.strip() == "True True True"
