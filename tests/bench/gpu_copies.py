"""How fast a card copies: what everything else is measured by. And whether its timer queries tell the truth."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import median

import moderngl
import numpy as np

Size = tuple[int, int]

GROUP = 64
FORMATS: Mapping[str, tuple[str, int]] = {"rgba16f": ("f2", 8), "rgba32f": ("f4", 16)}
"""The name of the type, and bytes of a pixel."""
BATCH = 50
"""Copies between two looks at the clock: to wait for the card must not be what is measured."""

_COMPUTE = """#version 430 core
layout(local_size_x = {group}) in;
layout(binding = 0) uniform sampler2D picture;
layout(binding = 0, {format}) writeonly uniform image2D made;
void main() {{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x < imageSize(made).x) imageStore(made, pixel, texelFetch(picture, pixel, 0));
}}
"""
_VERTEX = """#version 410 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
"""
_FRAGMENT = """#version 410 core
uniform sampler2D picture;
layout(location = 0) out vec4 made;
void main() { made = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
"""


@dataclass(frozen=True)
class Copy:
    """Seconds of copies, each of `nbytes` read and as many written."""

    way: str
    nbytes: int
    seconds: tuple[float, ...]
    same: bool
    """Whether what was read afterwards is what was there before."""

    @property
    def bandwidth(self) -> float:
        """Bytes per second, read and written together."""
        return 2.0 * self.nbytes / median(self.seconds)


@dataclass(frozen=True)
class Clock:
    """Measures what the card does: by a timer query, or by the clock where queries are of no use."""

    context: moderngl.Context
    by_query: bool

    def of(self, act: Callable[[], None]) -> float:
        """Seconds."""
        if self.by_query:
            query = self.context.query(time=True)
            with query:
                act()
            return query.elapsed / 1e9
        self.context.finish()
        started = time.perf_counter()
        act()
        self.context.finish()
        return time.perf_counter() - started


def time_copies(context: moderngl.Context, size: Size, repeats: int, by_query: bool) -> list[Copy]:
    """Copies of a picture of that size in every way and format, and of as large a buffer; the first does not count."""
    clock, results = Clock(context, by_query), list[Copy]()
    pixels = size[0] * size[1]
    for texel, (kind, each) in FORMATS.items():
        shown = np.arange(pixels * 4, dtype=np.uint32).astype(np.uint8).astype("float16" if kind == "f2" else "float32")
        source, made = context.texture(size, 4, shown, dtype=kind), context.texture(size, 4, dtype=kind)
        for way, act in _ways(context, source, made, texel).items():
            seconds = tuple(clock.of(act) for _ in range(repeats + 1))
            same = bool((np.frombuffer(made.read(), shown.dtype) == shown).all())
            made.write(np.zeros_like(shown))
            results.append(Copy(f"{way} {texel}", pixels * each, seconds[1:], same))
        source.release()
        made.release()
    nbytes = pixels * 16
    original, copy = context.buffer(np.arange(nbytes // 4, dtype=np.uint32)), context.buffer(reserve=nbytes)
    seconds = tuple(clock.of(lambda: context.copy_buffer(copy, original)) for _ in range(repeats + 1))
    results.append(Copy("buffer", nbytes, seconds[1:], original.read() == copy.read()))
    original.release()
    copy.release()
    return results


def queries_against_clock(context: moderngl.Context, size: Size) -> float:
    """What a timer query says of many copies, as a part of what the clock says: near 1 where it can be believed."""
    source, made = context.texture(size, 4, dtype="f4"), context.texture(size, 4, dtype="f4")
    act = next(iter(_ways(context, source, made, "rgba32f").values()))

    def batch() -> None:
        for _ in range(BATCH):
            act()

    batch()
    asked, seen = (Clock(context, by_query).of(batch) for by_query in (True, False))
    source.release()
    made.release()
    return asked / seen


def _ways(
    context: moderngl.Context, source: moderngl.Texture, made: moderngl.Texture, texel: str
) -> dict[str, Callable[[], None]]:
    width, height = source.size
    program = context.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
    target, vertices = context.framebuffer([made]), context.vertex_array(program, [])

    def draw() -> None:
        source.use(0)
        target.use()
        vertices.render(moderngl.TRIANGLES, vertices=3)

    ways: dict[str, Callable[[], None]] = {"fragment": draw}
    if context.version_code >= 430:
        shader = context.compute_shader(_COMPUTE.format(group=GROUP, format=texel))

        def dispatch() -> None:
            source.use(0)
            made.bind_to_image(0, read=False, write=True)
            shader.run(-(-width // GROUP), height)
            context.memory_barrier()

        ways["compute"] = dispatch
    return ways
