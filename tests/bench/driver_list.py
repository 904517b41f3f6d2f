"""The OpenGL drivers that pictures are compared on, and where this machine has them.

A driver is a few variables of the environment. Mesa of the system brings llvmpipe, softpipe and zink.
`newer_mesa.py` unpacks a newer Mesa beside it. Zink draws by Vulkan, on Mesa's lavapipe or on SwiftShader, which is
Google's and comes with Chromium.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

NEWER = Path(__file__).parents[2] / "out" / "drivers" / "mesa"
"""Where `newer_mesa.py` unpacks packages."""

Vulkan = Literal["", "lavapipe", "SwiftShader"]


@dataclass(frozen=True)
class Driver:
    """A way to run OpenGL: what the environment says, and a word of the name that the driver then gives itself.

    `corners` are the parts of a pixel at which it places the corners of triangles: `placed_corners` says why.
    """

    name: str
    word: str
    environment: Mapping[str, str] = field(default_factory=dict[str, str])
    form: str = ""
    vulkan: Vulkan = ""
    newer: bool = False
    corners: int = 256
    exact_angles: bool = False


_LLVMPIPE = {"GALLIUM_DRIVER": "llvmpipe"}
_ABLE = {"MESA_GL_VERSION_OVERRIDE": "4.5", "MESA_GLSL_VERSION_OVERRIDE": "450"}
_SOFTPIPE = {"GALLIUM_DRIVER": "softpipe", **_ABLE}
_ZINK = {"GALLIUM_DRIVER": "zink", "MESA_LOADER_DRIVER_OVERRIDE": "zink", "LIBGL_ALWAYS_SOFTWARE": "1"}
_SWIFT = {**_ZINK, **_ABLE, "MESA_EXTENSION_OVERRIDE": "+GL_ARB_instanced_arrays"}
_OLD = {"MESA_GL_VERSION_OVERRIDE": "4.1", "MESA_GLSL_VERSION_OVERRIDE": "410", **_LLVMPIPE}
_MIDDLE = {"MESA_GL_VERSION_OVERRIDE": "4.3", "MESA_GLSL_VERSION_OVERRIDE": "430", **_LLVMPIPE}

DRIVERS = (
    Driver("llvmpipe", "llvmpipe", _LLVMPIPE, "compute"),
    Driver("llvmpipe, fragment", "llvmpipe", _LLVMPIPE, "fragment"),
    Driver("OpenGL 4.1", "llvmpipe", _OLD),
    Driver("OpenGL 4.3", "llvmpipe", _MIDDLE),
    Driver("softpipe", "softpipe", _SOFTPIPE),
    Driver("zink, lavapipe", "zink", _ZINK, vulkan="lavapipe"),
    Driver("zink, SwiftShader", "SwiftShader", _SWIFT, "fragment", vulkan="SwiftShader", corners=16, exact_angles=True),
    Driver("newer llvmpipe", "llvmpipe", _LLVMPIPE, "compute", newer=True),
    Driver("newer llvmpipe, fragment", "llvmpipe", _LLVMPIPE, "fragment", newer=True),
    Driver("newer softpipe", "softpipe", _SOFTPIPE, newer=True),
    Driver("newer zink, lavapipe", "zink", _ZINK, vulkan="lavapipe", newer=True),
)
"""The first is what the others are compared with. Softpipe says 3.3 and can do more, and so does zink on SwiftShader;
zink refuses processors unless it is told to take them. Softpipe rounds no corners, so 256ths suit it too. The newer
zink on SwiftShader is left out: pixels that leave a loop before their neighbors lose their values there."""

_SWIFTSHADER = (
    "/usr/lib/chromium/libvk_swiftshader.so",
    "/usr/lib/chromium-browser/libvk_swiftshader.so",
)


class MissingDriverError(Exception):
    """This machine lacks what a driver needs."""


def describe_environment(driver: Driver, folder: Path, newer: Path = NEWER) -> dict[str, str]:
    """The variables that choose a driver; what they name is written into `folder`.

    Raises MissingDriverError where a file is missing.
    """
    variables = dict(driver.environment)
    if driver.newer:
        variables |= _describe_newer(newer)
    if driver.vulkan:
        library = _find_vulkan(driver, newer)
        manifest = folder / "vulkan.json"
        content = {"library_path": str(library), "api_version": "1.3.0"}
        manifest.write_text(json.dumps({"file_format_version": "1.0.0", "ICD": content}), "utf-8")
        variables["VK_ICD_FILENAMES"] = str(manifest)
    return variables


def _describe_newer(newer: Path) -> dict[str, str]:
    """The variables that put unpacked packages in front of those of the system."""
    library = next(iter(sorted(newer.rglob("libEGL_mesa.so.0"))), None)
    vendors = newer / "usr" / "share" / "glvnd" / "egl_vendor.d"
    if library is None or not vendors.is_dir():
        raise MissingDriverError("no newer Mesa is unpacked: see tests/bench/newer_mesa.py")
    paths = [str(library.parent), os.environ.get("LD_LIBRARY_PATH", "")]
    return {
        "LD_LIBRARY_PATH": os.pathsep.join(filter(None, paths)),
        "LIBGL_DRIVERS_PATH": str(library.parent / "dri"),
        "__EGL_VENDOR_LIBRARY_DIRS": str(vendors),
    }


def _find_vulkan(driver: Driver, newer: Path) -> Path:
    """The library of a Vulkan driver."""
    if driver.vulkan == "SwiftShader":
        found = next((Path(path) for path in _SWIFTSHADER if Path(path).is_file()), None)
    elif driver.newer:
        found = next(iter(sorted(newer.rglob("libvulkan_lvp.so"))), None)
    else:
        places = [Path("/usr/lib"), Path("/usr/lib64"), *Path("/usr/lib").glob("*-linux-gnu")]
        found = next((path for place in places if (path := place / "libvulkan_lvp.so").is_file()), None)
    if found is None:
        raise MissingDriverError(f"there is no driver of Vulkan: {driver.vulkan}")
    return found
