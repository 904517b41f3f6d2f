"""Compute shaders through moderngl without any graph: what is reachable on a device. This is its device and its blur.

Half pictures in and out, 32-bit ones in between, `imageLoad` instead of textures, several pixels to an invocation.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import moderngl
import numpy as np

Array = np.ndarray
Texture = moderngl.Texture
GROUP = 64
FORMATS: Mapping[tuple[str, int], str] = {
    ("f2", 4): "rgba16f",
    ("f4", 4): "rgba32f",
    ("f4", 1): "r32f",
    ("f4", 2): "rg32f",
}
ROUNDED = "vec4(unpackHalf2x16(packHalf2x16((o).xy)), unpackHalf2x16(packHalf2x16((o).zw)))"
"""The software rasterizer cuts off what does not fit into a half: round first."""
SPREAD = 0.7
"""Sigma of the Gaussian before pixels are left out, as a part of the step."""
ENOUGH = 1.45
"""Sigma in small pixels that has to be left for the blur there: less would show the grid."""
SPLINE = """
vec4 spline(float t) {
  float u = 1 - t; vec4 w = vec4(u*u*u, 4 - 6*t*t + 3*t*t*t, 0, t*t*t) / 6;
  w.z = 1 - w.x - w.y - w.w; return w;
}
"""


class Device:
    """A context, its programs, and textures that are kept under names."""

    def __init__(self) -> None:
        self.context = moderngl.create_context(standalone=True, backend="egl")
        self._programs: dict[tuple[Any, ...], moderngl.ComputeShader] = {}
        self._textures: dict[tuple[Any, ...], Texture] = {}
        self._weights: dict[float, moderngl.Buffer] = {}

    def texture(self, name: str, width: int, height: int, depth: str = "f4", channels: int = 4) -> Texture:
        """The texture of that name, size and format."""
        key = (name, width, height, depth, channels)
        if key not in self._textures:
            self._textures[key] = self.context.texture((width, height), channels, dtype=depth)
        return self._textures[key]

    def upload(self, name: str, pixels: Array) -> Texture:
        """Pixels of half or float; three channels become four."""
        height, width, channels = pixels.shape
        if channels == 3:
            pixels, channels = np.dstack([pixels, np.zeros((height, width), pixels.dtype)]), 4
        made = self.texture(name, width, height, "f2" if pixels.dtype == np.float16 else "f4", channels)
        made.write(np.ascontiguousarray(pixels))
        return made

    def download(self, texture: Texture) -> Array:
        """Its pixels."""
        width, height = texture.size
        made = np.empty((height, width, texture.components), np.float16 if texture.dtype == "f2" else np.float32)
        texture.read_into(made)
        return made

    def run(
        self, text: str, into: Texture, of: Sequence[Texture], invocations: tuple[int, int], **values: Any
    ) -> Texture:
        """Run a shader: it reads `at0(p)`, `at1(p)`..., knows `last`, the last pixel, and says `put(p, o)`."""
        formats = [FORMATS[item.dtype, item.components] for item in (into, *of)]
        key = (text, *formats)
        if key not in self._programs:
            head = [
                f"#version 450\nlayout(local_size_x={GROUP}) in;",
                f"layout(binding=0, {formats[0]}) writeonly uniform image2D into;",
                f"#define put(p, o) imageStore(into, p, {ROUNDED if into.dtype == 'f2' else 'o'})",
                "#define last (imageSize(into) - 1)",
            ]
            for number, form in enumerate(formats[1:]):
                head += [
                    f"layout(binding={number + 1}, {form}) readonly uniform image2D of{number};",
                    f"#define at{number}(p) imageLoad(of{number}, p)",
                ]
            self._programs[key] = self.context.compute_shader("\n".join([*head, text]))
        program = self._programs[key]
        for name, value in values.items():
            program[name] = value
        into.bind_to_image(0, read=False, write=True)
        for number, item in enumerate(of, 1):
            item.bind_to_image(number, read=True, write=False)
        program.run(-(-invocations[0] // GROUP), invocations[1])
        self.context.memory_barrier()
        return into

    def pixels(self, body: str, into: Texture, *of: Texture, head: str = "") -> Texture:
        """One invocation to a pixel `p`; the body sets `o`."""
        begin = "ivec2 p = ivec2(gl_GlobalInvocationID.xy); if (p.x > last.x) return;"
        return self.run(f"{head}\nvoid main() {{ {begin} vec4 o; {body} put(p, o); }}", into, of, into.size)

    # --- Gaussian blur -----------------------------------------------------------------------------------------------

    def blur(self, of: Texture, into: Texture, sigma: float) -> Texture:
        """At a reduced size where that is exact enough."""
        found = self.reduce(of, sigma)
        if found is None:
            return self.exact(of, into, sigma)
        small, factor, apron = found
        tall = self.texture("tall", small.width, of.height)
        return self.enlarge(self.enlarge(small, tall, factor, apron, 1), into, factor, apron, 0)

    def exact(self, of: Texture, into: Texture, sigma: float) -> Texture:
        """Rows, then columns."""
        between = self.texture("between", *of.size, into.dtype)
        return self._line(self._line(of, between, sigma, 0), into, sigma, 1)

    def reduce(self, of: Texture, sigma: float) -> tuple[Texture, int, int] | None:
        """The blurred picture at a smaller size, by how much, and the apron around it in pixels of the large one."""
        factor, variance, steps = self._steps(sigma)
        if factor == 1:
            return None
        rest = math.sqrt(sigma**2 - variance - factor**2 / 3.0) / factor
        apron = factor * (math.ceil(3.5 * rest) + 2)
        width, height = (-(-(side + 2 * apron) // factor) * factor for side in of.size)
        done = 1
        for step in steps:
            margin = apron if done == 1 else 0
            flat = self.texture(f"flat{done}", width // (done * step), of.height)
            self._shrink(of, flat, step, 0, margin)
            of = self._shrink(flat, self.texture(f"less{done}", flat.width, height // (done * step)), step, 1, margin)
            done *= step
        return self.exact(of, self.texture("small", *of.size), rest), factor, apron

    @staticmethod
    def _steps(sigma: float) -> tuple[int, float, list[int]]:
        """By how much to shrink in all, the variance that this adds, and the single steps."""
        factor, variance, steps = 1, 0.0, list[int]()
        while True:
            for step in (4, 2):
                more, added = factor * step, variance + (SPREAD * step * factor) ** 2
                rest = sigma**2 - added - more**2 / 3.0
                if rest > 0.0 and math.sqrt(rest) / more >= (1.15 if more == 2 else ENOUGH):
                    factor, variance = more, added
                    steps.append(step)
                    break
            else:
                return factor, variance, steps

    def _line(self, of: Texture, into: Texture, sigma: float, axis: int) -> Texture:
        reach = math.ceil(4.0 * sigma)
        return self._short(of, into, sigma, axis) if reach <= 16 else self._long(of, into, sigma, axis, reach)

    def _long(self, of: Texture, into: Texture, sigma: float, axis: int, reach: int) -> Texture:
        """16 pixels to an invocation; every loaded pixel goes to all of them. One program for all sigmas."""
        count = 16
        if sigma not in self._weights:
            weights, bell = np.zeros(4096, np.float32), np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
            weights[: 2 * reach + 1] = bell / bell.sum()
            self._weights[sigma] = self.context.buffer(weights)
        self._weights[sigma].bind_to_uniform_block(3)
        body = list[str]()
        for i in range(count):
            fetch = f"q = w[(first >> 2) + {i // 4}];" if i % 4 == 0 else ""
            sums = "".join(f"s{k} += w{(i - k) % count} * t;" for k in range(count))
            body.append(f"{fetch} w{i} = q[{i % 4}]; t = at0(clamp(p + way * {i}, ivec2(0), last)); {sums}")
        puts = "".join(f"if (all(lessThanEqual(o, last))) put(o, s{k}); o += way;" for k in range(count))
        text = f"""
layout(std140, binding=3) uniform Weights {{ vec4 w[1024]; }};
uniform int reach, taps; uniform ivec2 way;
void main() {{
  ivec2 o = int(gl_GlobalInvocationID.x) * way.yx + int(gl_GlobalInvocationID.y) * {count} * way;
  if (any(greaterThan(o * way.yx, last))) return;
  ivec2 p = o - way * reach;
  vec4 t, q, {", ".join(f"s{k} = vec4(0)" for k in range(count))};
  float {", ".join(f"w{k} = 0" for k in range(count))};
  for (int first = 0; first < taps; first += {count}) {{ {"".join(body)} p += way * {count}; }}
  {puts}
}}"""
        taps = -(-(count + 2 * reach) // count) * count
        return self._along(text, into, of, axis, count, reach=reach, taps=taps, way=(1, 0) if axis == 0 else (0, 1))

    def _short(self, of: Texture, into: Texture, sigma: float, axis: int) -> Texture:
        """8 pixels to an invocation without a loop; a program for each class of radius."""
        count, reach = 8, next(size for size in (4, 6, 8, 12, 16) if size >= math.ceil(4.0 * sigma))
        weights = np.exp(-0.5 * (np.arange(reach + 1) / sigma) ** 2)
        weights /= weights[0] + 2.0 * weights[1:].sum()
        taps = {
            j: [(k, f"w[{abs(j - k)}]") for k in range(count) if abs(j - k) <= reach]
            for j in range(-reach, count + reach)
        }
        return self._along(
            f"uniform float w[{reach + 1}];\n{_strip(taps, count, axis, '1', 'last')}",
            into,
            of,
            axis,
            count,
            w=[float(weight) for weight in weights],
        )

    def _shrink(self, of: Texture, into: Texture, step: int, axis: int, margin: int) -> Texture:
        """Every `step`-th pixel of a Gaussian blur, 4 to an invocation."""
        count, middle, sigma = 4, (step - 1) / 2.0, SPREAD * step
        reach = math.ceil(3.6 * sigma - middle)
        bell = {j: math.exp(-0.5 * ((j - middle) / sigma) ** 2) for j in range(-reach, step + reach)}
        total = sum(bell.values())
        taps = {
            j: [(k, f"{bell[j - k * step] / total:.9g}") for k in range(count) if j - k * step in bell]
            for j in range(-reach, count * step + reach)
        }
        end = f"ivec2({of.width - 1}, {of.height - 1})"
        return self._along(_strip(taps, count, axis, str(step), end, margin), into, of, axis, count)

    def enlarge(self, of: Texture, into: Texture, factor: int, apron: int, axis: int) -> Texture:
        """Back to the large size along one axis, by cubic B-splines."""
        return self.pixels(f"{enlarging_shader(0, factor, apron, axis)} o = found;", into, of, head=SPLINE)

    def _along(self, text: str, into: Texture, of: Texture, axis: int, count: int, **values: Any) -> Texture:
        length, lines = into.size if axis == 0 else into.size[::-1]
        return self.run(text, into, [of], (lines, -(-length // count)), **values)


def enlarging_shader(number: int, factor: int, apron: int, axis: int) -> str:
    """GLSL that sets `found` to a pixel of an enlarged texture."""
    spots = [f"ivec2(i + {k}, p.y)" if axis == 0 else f"ivec2(p.x, i + {k})" for k in range(-1, 3)]
    terms = " + ".join(f"w[{k}] * at{number}({spot})" for k, spot in enumerate(spots))
    return (
        f"float c = (p.{'xy'[axis]} + 0.5 + {apron}) / {factor}.0 - 0.5; int i = int(floor(c)); "
        f"vec4 w = spline(c - i); vec4 found = {terms};"
    )


def _strip(
    taps: Mapping[int, list[tuple[int, str]]], count: int, axis: int, step: str, end: str, margin: int = 0
) -> str:
    """A shader that makes some pixels of a line: `taps` says which loaded pixel goes to which, and with what weight."""
    spot, limit, lines = (("ivec2({}, line)", "x", "y"), ("ivec2(line, {})", "y", "x"))[axis]
    loads = "\n".join(
        f"t = at0({spot.format(f'clamp(base + {j}, 0, end.{limit})')});" + "".join(f"s{k} += {w} * t;" for k, w in to)
        for j, to in taps.items()
    )
    puts = "".join(f"if (first + {k} <= last.{limit}) put({spot.format(f'first + {k}')}, s{k});" for k in range(count))
    return f"""
void main() {{
  int line = int(gl_GlobalInvocationID.x), first = int(gl_GlobalInvocationID.y) * {count};
  if (line > last.{lines}) return;
  ivec2 end = {end}; int base = first * {step} - {margin};
  vec4 t, {", ".join(f"s{k} = vec4(0)" for k in range(count))};
  {loads}
  {puts}
}}"""
