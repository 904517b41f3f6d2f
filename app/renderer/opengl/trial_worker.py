"""A process that compiles programs and runs each once, so that a driver that dies takes nothing else with it.

Reads one program as a line of JSON from standard input, compiles it as the renderer will, runs it on pictures of a few
pixels, and answers with a line of JSON: `{"seconds": ...}`, what these pixels took, 0 for a program that the driver
refuses. Drivers keep what they have compiled in a cache on disk, where the renderer finds it. Whoever asks notices when
the process ends.

It loads nothing but the graphics library, so that it is ready in a fraction of a second.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import signal
import sys
import time
from array import array
from collections.abc import Callable
from typing import Any

import moderngl

CACHE_DELAY = 0.02
"""Seconds that Mesa may take to write its cache after slow programs: it does so on another thread."""

QUICK = 0.001
"""Seconds of a run that is not repeated. At this speed two cores make a picture of 1920x1080 in 4 seconds."""

MOST_RUNS, ENOUGH = 5, 0.5
"""Runs of a program, and the seconds after which two are enough: on a busy machine a single one may take too long."""

_COVERING_VERTEX = """#version 410 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
"""


def serve(context: moderngl.Context) -> None:
    """Try programs until standard input ends."""
    for line in sys.stdin:
        began, seconds = time.monotonic(), 0.0
        with contextlib.suppress(moderngl.Error):  # the renderer says what the driver has against it
            seconds = try_program(context, json.loads(line))
        if time.monotonic() - began > CACHE_DELAY:
            time.sleep(CACHE_DELAY)
        print(json.dumps({"seconds": seconds}), flush=True)


def try_program(context: moderngl.Context, program: dict[str, Any]) -> float:
    """Compile a program and run it: the seconds that it runs. Raises moderngl.Error for one that the driver refuses.

    One work group or one triangle is enough: drivers finish compiling at the first use, whatever its size. So what it
    takes is measured when it runs again.
    """
    handle = compile_program(context, program)
    resources: list[Any] = [handle]
    for name, value in (*program["tables"], *program["uniforms"]):
        set_uniform(handle, name, value)
    is_compute = program["form"] == "compute"
    textures = [create_texture(context, kind) for kind in program["textures"]]
    targets = [create_texture(context, kind) for kind in program["targets"]]
    resources += [*textures, *targets]
    for unit, texture in enumerate(textures):
        if program["reads_images"]:
            texture.bind_to_image(unit, read=True, write=False)
        else:
            texture.use(unit)
    if program["weights"] and "Weights" in handle:
        weights = context.buffer(array("f", [0.0] * program["weights"]).tobytes())
        handle["Weights"].binding = 0
        weights.bind_to_uniform_block(0)
        resources.append(weights)
    if is_compute:
        first = len(textures) if program["reads_images"] else 0
        for unit, texture in enumerate(targets, first):
            texture.bind_to_image(unit, read=False, write=True)
        seconds = _measure(context, lambda: handle.run(1, 1, 1))
    else:
        framebuffer = context.framebuffer(targets)
        framebuffer.use()
        context.disable(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        vertices = context.vertex_array(handle, [])
        mode, count = (moderngl.TRIANGLE_STRIP, 4) if program["vertex"] else (moderngl.TRIANGLES, 3)
        seconds = _measure(context, lambda: vertices.render(mode, vertices=count))
        resources += [vertices, framebuffer]
    for resource in reversed(resources):
        resource.release()
    return seconds


def _measure(context: moderngl.Context, run: Callable[[], object]) -> float:
    """The seconds that a program runs, without those that it is compiled."""
    runs = list[float]()
    while len(runs) < MOST_RUNS:
        began = time.monotonic()
        run()
        context.finish()
        runs.append(time.monotonic() - began)
        if runs[-1] < QUICK or (len(runs) > 1 and sum(runs) > ENOUGH):
            break
    return min(runs)


def compile_program(context: moderngl.Context, program: dict[str, Any]) -> Any:
    """The program, with its textures bound to their units."""
    if program["form"] == "compute":
        return context.compute_shader(program["source"])
    handle = context.program(vertex_shader=program["vertex"] or _COVERING_VERTEX, fragment_shader=program["source"])
    if not program["foreign"]:
        for unit in range(len(program["textures"])):
            set_uniform(handle, f"t{unit}", unit)
    return handle


def set_uniform(handle: Any, name: str, value: Any) -> None:
    """Set a uniform, where the program has it and can hold the value."""
    if name not in handle:
        return
    member = handle[name]
    try:
        if isinstance(member, moderngl.Uniform) and member.array_length > 1:
            member.write(array("f", value[: member.array_length * member.dimension]).tobytes())
        else:
            handle[name] = tuple(value) if isinstance(value, list) else value
    except (TypeError, ValueError, moderngl.Error):
        return


def create_texture(context: moderngl.Context, kind: tuple[int, int, int, str, bool]) -> moderngl.Texture:
    """A small picture of a size, components and a depth, zero everywhere, with interpolation or without."""
    width, height, components, depth, linear = kind
    texture = context.texture((width, height), components, dtype=depth)
    way = moderngl.LINEAR if linear else moderngl.NEAREST
    texture.filter = (way, way)
    texture.repeat_x = texture.repeat_y = False
    return texture


def end_with_parent() -> None:
    """Have the system end this process when the one that asked for it is gone, even while a driver compiles."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)


def main() -> None:
    """Open OpenGL and serve; end at once where it cannot be opened."""
    end_with_parent()
    ways: tuple[dict[str, Any], ...] = ({},)
    if sys.platform.startswith("linux"):
        ways = ({"backend": "egl", "libegl": "libEGL.so.1", "libgl": "libGL.so.1"}, {"backend": "egl"}, {})
    for way in ways:
        try:
            context: moderngl.Context = moderngl.create_context(standalone=True, require=410, **way)
        except Exception:  # moderngl and its loaders raise plain Exceptions
            continue
        serve(context)
        return


if __name__ == "__main__":
    main()
