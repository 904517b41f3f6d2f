"""Many renders in one process, and many processes in one folder: nothing grows, nothing is mixed up."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import kills
import numpy as np
import OpenImageIO as oiio
from pool import Tally

WARM = 400
"""Renders until caches are as full as they get: at these sizes the budget of textures is spent after 340."""

GROWTH = 80 << 20
"""Bytes by which a process may grow afterwards. Allocators keep some of what was freed: 55 MiB between the 400th and
the 1,300th render and nothing after it, while what is in use (mallinfo2) becomes less."""

GL_OBJECTS = 40
"""Programs, buffers and framebuffers that may be added afterwards."""


def _resident() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def _descriptors() -> int:
    return len(os.listdir("/proc/self/fd"))  # noqa: PTH208 - a listing of descriptors, not of paths


def _count_gl_objects() -> tuple[int, int]:
    """Textures that are there, and programs, buffers and framebuffers."""
    kinds = [type(item).__name__ for item in gc.get_objects() if str(type(item).__module__).startswith("moderngl")]
    textures = kinds.count("Texture")
    return textures, len(kinds) - textures


def run_soak(count: int) -> Tally:
    """So many renders of all presets in turn, at changing sizes and values."""
    import halation as hal
    from halation import presets
    from halation.errors import HalationError
    from halation.renderer import DEFAULT_BUDGET
    from halation.renderer.execution.texture_pool import MIN_TEXTURE_BYTES

    tally, graphs = Tally(), [hal.load(path) for path in presets.paths()]
    base = (0, 0, (0, 0))
    for number in range(count):
        graph = graphs[number % len(graphs)]
        began = time.perf_counter()
        try:
            hal.render(graph, size=(48 + number % 7, 32 + number % 5), frame=1 + number % 3)
        except HalationError as fault:
            tally.faults.append((f"render {number}", str(fault)))
        tally.seconds += time.perf_counter() - began
        tally.count += 1
        if number == min(WARM, count // 2):
            gc.collect()
            base = _resident(), _descriptors(), _count_gl_objects()
    gc.collect()
    grown, opened = _resident() - base[0], _descriptors() - base[1]
    if grown > GROWTH:
        tally.faults.append(("memory", f"grew by {grown >> 20} MiB over {count} renders"))
    textures, others = _count_gl_objects()
    if textures > (most := DEFAULT_BUDGET // MIN_TEXTURE_BYTES):
        tally.faults.append(("textures", f"{textures}, of which {most} are allowed"))
    if others > base[2][1] + GL_OBJECTS:
        tally.faults.append(("OpenGL objects", f"{others - base[2][1]} more than before"))
    print(
        f"render {count}: {_resident() >> 20} MiB ({grown >> 20:+}), {_descriptors()} descriptors ({opened:+}), "
        f"{textures} textures ({textures - base[2][0]:+}), {others} other objects ({others - base[2][1]:+})",
        flush=True,
    )
    if opened > 4:
        tally.faults.append(("descriptors", f"{opened} more than before"))
    tally.peak = _resident()
    return tally


def run_concurrency(count: int) -> Tally:
    """Pairs of processes that write the same files at the same time: each file is one of theirs, whole."""
    tally = Tally()
    for number in range(count):
        with tempfile.TemporaryDirectory(prefix="hostile-both-") as text:
            folder = Path(text)
            kills.prepare(folder)
            command = [
                sys.executable,
                "-P",
                "-m",
                "halation.cli",
                "render",
                "graph.json",
                "-o",
                "out.####.exr",
                "--frames",
                "1-6",
            ]
            both = [
                subprocess.Popen([*command, "--set", f"n.size={size}"], cwd=folder, stderr=subprocess.PIPE, text=True)
                for size in (10.0, 90.0)
            ]
            for process in both:
                _, said = process.communicate(timeout=120)
                if process.returncode != 0:
                    tally.faults.append((f"pair {number}", f"exit code {process.returncode}: {said.strip()}"))
            tally.count += 1
            tally.faults += [(f"pair {number}", fault) for fault in kills.find_broken(folder)]
            for path in folder.glob("out.0*.exr"):
                pixels = oiio.ImageBuf(str(path)).get_pixels(oiio.FLOAT)
                if pixels is None or not np.isfinite(pixels).all():
                    tally.faults.append((f"pair {number}", f"{path.name} holds no picture"))
    return tally
