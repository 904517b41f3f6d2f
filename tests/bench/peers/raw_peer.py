"""The tasks as compute shaders written by hand for each of them: what is reachable on this device. `--list` says which.

Seconds of the operation end with the result in an array. RAW_UNFUSED=1 runs a pass for every node of T5.
"""

from __future__ import annotations

import json
import math
import os
import queue
import sys
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

sys.path.append(str(Path(__file__).parents[2]))

from bench import exr
from bench.peers.harness import print_seconds, read_arguments, time_runs
from bench.peers.raw_device import SPLINE, Array, Device, enlarging_shader
from bench.tasks import (
    FRAMES,
    GOLDEN_ANGLE,
    LUMINANCE,
    PUSH,
    SEQUENCE,
    SIGMAS,
    STEPS,
    TASKS,
    Bloom,
    Lens,
    Occlusion,
    Reinhard,
    Ten,
    picture_path,
    scale_length,
)

Texture = moderngl.Texture
Shaded = Callable[..., Texture]
ROWS = 8
"""Pixels of a column to an invocation, where three rows slide through registers."""
LIGHT = f"dot(x, vec3{LUMINANCE})"
GRADES = (
    f"x *= {Ten.exposure};",
    f"x = x * vec3{Ten.gain} + vec3{Ten.lift};",
    f"x = pow(max(x, 0), vec3({1.0 / Ten.gamma}));",
    f"x = max(mix(vec3({LIGHT}), x, {Ten.saturation}), 0);",
    f"x = {Ten.curve[0]} * x / (x + {Ten.curve[1]});",
)


def result(device: Device, like: Texture) -> Texture:
    """The texture that is downloaded."""
    return device.texture("out", *like.size, "f2")


def sobel(device: Device, tail: str, into: Texture, *of: Texture, head: str = "") -> Texture:
    """Sobel edges `e` of the first texture; `tail` makes `o` of them and of the pixel `v`."""
    names, body = ["a", "b", "c"], ["int l = max(x - 1, 0), r = min(x + 1, last.x);"]

    def row(name: str, away: int) -> str:
        spots = ("l", "x", "r")
        loads = "".join(f"{name}{k} = at0(ivec2({spot}, yy));" for k, spot in enumerate(spots))
        return f"{{ int yy = clamp(y + {away}, 0, last.y); {loads} }}"

    body += [row("a", -1), row("b", 0)]
    for k in range(ROWS):
        a, b, c = names
        body.append(f"""{row(c, k + 1)}
  gx = ({a}2 - {a}0 + 2 * ({b}2 - {b}0) + {c}2 - {c}0).rgb; gy = ({c}0 - {a}0 + 2 * ({c}1 - {a}1) + {c}2 - {a}2).rgb;
  e = sqrt(gx * gx + gy * gy); v = {b}1;
  {{ ivec2 p = ivec2(x, y + {k}); {tail} if (p.y <= last.y) put(p, o); }}""")
        names = [b, c, a]
    vectors = ", ".join(f"{name}{k}" for name in names for k in range(3))
    text = f"""{head}
void main() {{
  int x = int(gl_GlobalInvocationID.x), y = int(gl_GlobalInvocationID.y) * {ROWS};
  if (x > last.x) return;
  vec4 {vectors}, v, o; vec3 gx, gy, e;
  {"".join(body)}
}}"""
    return device.run(text, into, of, (into.width, -(-into.height // ROWS)))


def bloom(device: Device, a: Texture) -> Texture:
    """T2."""
    bright = device.pixels(f"o = max(at0(p) - {Bloom.threshold}, 0);", device.texture("bright", *a.size), a)
    soft = [device.blur(bright, device.texture(f"soft{sigma}", *a.size), sigma) for sigma in Bloom.sigmas]
    body = f"o = at0(p) + {Bloom.strength / 3.0} * (at1(p) + at2(p) + at3(p));"
    return device.pixels(body, result(device, a), a, *soft)


def tone_map(device: Device, a: Texture) -> Texture:
    """T3: sums of 8 x 8 pixels until there is one."""
    sums = a
    while max(sums.size) > 1:
        term = f"log({Reinhard.delta} + max({LIGHT.replace('x,', 'at0(q).rgb,')}, 0))" if sums is a else "at0(q).x"
        body = (
            "float s = 0; for (int j = 0; j < 8; ++j) for (int i = 0; i < 8; ++i) { ivec2 q = p * 8 + ivec2(i, j); "
            f"if (q.x < {sums.width} && q.y < {sums.height}) s += {term}; }} o = vec4(s);"
        )
        sums = device.pixels(body, device.texture("sums", -(-sums.width // 8), -(-sums.height // 8)), sums)
    mean = f"exp(at1(ivec2(0)).x / {a.width * a.height}.0)"
    body = (
        f"vec4 c = at0(p); vec3 x = c.rgb; float k = {Reinhard.key} / {mean}, l = {LIGHT} * k; "
        f"o = vec4(x * (k * (1 + l / {Reinhard.white**2}) / (1 + l)), c.a);"
    )
    return device.pixels(body, result(device, a), a, sums)


def ten(device: Device, a: Texture, b: Texture) -> Texture:
    """T5 in as few passes as can be: grades, the small blur, half of the enlargement, all the rest."""
    body = f"vec4 c = at0(p); vec3 x = c.rgb; {''.join(GRADES)} o = vec4(x, c.a);"
    graded = device.pixels(body, device.texture("graded", *a.size), a)
    found = device.reduce(graded, Ten.sigma)
    assert found is not None
    small, factor, apron = found
    wide = device.enlarge(small, device.texture("wide", a.width, small.height), factor, apron, 0)
    tail = (
        f"{enlarging_shader(1, factor, apron, 1)} o = mix(v, found, {Ten.mix}); o.rgb += {Ten.edges} * e; "
        "o += (1 - o.a) * at2(p);"
    )
    return sobel(device, tail, result(device, a), graded, wide, b, head=SPLINE)


def ten_apart(device: Device, a: Texture, b: Texture) -> Texture:
    """T5 with a pass to a node."""
    x = a
    for number, grade in enumerate(GRADES):
        body = f"vec4 c = at0(p); vec3 x = c.rgb; {grade} o = vec4(x, c.a);"
        x = device.pixels(body, device.texture(f"grade{number}", *a.size), x)
    soft = device.blur(x, device.texture("soft", *a.size), Ten.sigma)
    mixed = device.pixels(f"o = mix(at0(p), at1(p), {Ten.mix});", device.texture("mixed", *a.size), x, soft)
    lines = sobel(device, "o = vec4(e, 0);", device.texture("lines", *a.size), x)
    body = f"o = at0(p) + {Ten.edges} * at1(p);"
    drawn = device.pixels(body, device.texture("drawn", *a.size), mixed, lines)
    return device.pixels("o = at0(p); o += (1 - o.a) * at1(p);", result(device, a), drawn, b)


def displace(device: Device, a: Texture, noise: Texture) -> Texture:
    """T6."""
    body = (
        f"vec2 u = clamp(vec2(p) + {scale_length(PUSH, a.width)} * at1(p).xy, vec2(0), vec2(last)); "
        "ivec2 i = ivec2(u), j = min(i + 1, last); vec2 f = u - i; o = mix(mix(at0(i), at0(ivec2(j.x, i.y)), f.x), "
        "mix(at0(ivec2(i.x, j.y)), at0(j), f.x), f.y);"
    )
    return device.pixels(body, result(device, a), a, noise)


def points(places: list[tuple[float, float]]) -> str:
    """Places as a GLSL array: radius and angle to x, y and radius."""
    rows = ", ".join(f"vec3({r * math.cos(t):.6f}, {r * math.sin(t):.6f}, {r:.6f})" for r, t in places)
    return f"const vec3 places[{len(places)}] = vec3[]({rows});"


def occlusion(device: Device, depth: Texture, normal: Texture) -> Texture:
    """T7."""
    far, count, radius = Occlusion, Occlusion.samples, scale_length(Occlusion.radius, depth.width)
    head = (
        points([((i + 0.5) / count * radius, i * GOLDEN_ANGLE) for i in range(count)])
        + f"""
vec3 place(ivec2 q, float z) {{
  vec2 size = vec2(last + 1), view = vec2(size.x / size.y, 1) / {far.focal};
  return vec3(((q.x + 0.5) / size.x * 2 - 1) * view.x * z, (1 - (q.y + 0.5) / size.y * 2) * view.y * z, -z);
}}"""
    )
    body = f"""
float z = at0(p).x, turn = float((p.x * 73 ^ p.y * 151) & 255) * (6.2831853 / 256), s = 0;
vec3 center = place(p, z), n = at1(p).xyz; vec2 cs = vec2(cos(turn), sin(turn));
for (int i = 0; i < {count}; ++i) {{
  vec2 u = places[i].xy;
  ivec2 q = clamp(p + ivec2(vec2(u.x * cs.x - u.y * cs.y, u.x * cs.y + u.y * cs.x)), ivec2(0), last);
  vec3 v = place(q, at0(q).x) - center; float d = dot(v, v);
  if (d < {far.reach**2}) s += max(0, dot(v, n) - {far.bias} * z) / (d + 1e-3);
}}
o = vec4(max(0, 1 - 2 * s * {far.reach} / {count}));"""
    return device.pixels(body, device.texture("open", *depth.size, "f4", 1), depth, normal, head=head)


def blur_by_depth(device: Device, a: Texture, depth: Texture) -> Texture:
    """T8."""
    largest, aperture = scale_length(Lens.largest, a.width), scale_length(Lens.aperture, a.width)
    head = (
        points([(math.sqrt(i / Lens.samples) * largest, i * GOLDEN_ANGLE) for i in range(1, Lens.samples)])
        + f"""
float circle(float z) {{ return min(abs(z - {Lens.focus}) / z * {aperture}, {largest}); }}"""
    )
    body = f"""
float z = at1(p).x, own = circle(z), total = 1; o = at0(p);
for (int i = 0; i < {Lens.samples - 1}; ++i) {{
  ivec2 q = clamp(p + ivec2(places[i].xy), ivec2(0), last); float there = at1(q).x, c = circle(there);
  if (there > z) c = min(c, 2 * own);
  float k = clamp(c - places[i].z + 0.5, 0, 1); o += k * at0(q); total += k;
}}
o /= total;"""
    return device.pixels(body, result(device, a), a, depth, head=head)


def blur_by_motion(device: Device, a: Texture, velocity: Texture) -> Texture:
    """T9."""
    body = (
        f"vec2 u = at1(p).zw; o = vec4(0); for (int i = 0; i < {STEPS}; ++i) o += at0(clamp(p + ivec2(round(u * "
        f"((i + 0.5) / {STEPS}.0 - 0.5))), ivec2(0), last)); o /= {STEPS};"
    )
    return device.pixels(body, result(device, a), a, velocity)


def blur(device: Device, a: Texture, sigma: float) -> Texture:
    """T1. A small sigma is exact at full size only."""
    return (device.exact if sigma < 5.0 else device.blur)(a, result(device, a), sigma)


WORKS: Mapping[str, Shaded] = {
    "copy": lambda device, a: a,
    **{name: lambda device, a, sigma=sigma: blur(device, a, sigma) for name, sigma in SIGMAS.items()},
    "T2": bloom,
    "T3": tone_map,
    "T4": lambda device, a: sobel(device, "o = vec4(e, v.a);", result(device, a), a),
    "T5": ten_apart if os.environ.get("RAW_UNFUSED") else ten,
    "T6": displace,
    "T7": occlusion,
    "T8": blur_by_depth,
    "T9": blur_by_motion,
    "T10": ten,
}


def read(folder: Path, name: str) -> Array:
    """A picture, half if it is one."""
    return exr.read(picture_path(folder, name), half=name in "ab")


def sequence(device: Device, folder: Path, out: str) -> None:
    """Frames are read, computed and written side by side."""
    b = device.upload("b", read(folder, "b"))
    came: queue.Queue[Any] = queue.Queue(2)
    gone: queue.Queue[Any] = queue.Queue(2)

    def reads() -> None:
        for frame in range(1, FRAMES + 1):
            came.put((frame, exr.read(folder / SEQUENCE.format(frame), half=True)))
        came.put(None)

    def writes() -> None:
        while (item := gone.get()) is not None:
            exr.write(Path(out.format(f"{item[0]:04d}")), item[1])

    threads = [threading.Thread(target=work) for work in (reads, writes)]
    for thread in threads:
        thread.start()
    while (item := came.get()) is not None:
        gone.put((item[0], device.download(ten(device, device.upload("a", item[1]), b))))
    gone.put(None)
    for thread in threads:
        thread.join()


def main() -> None:
    """As the other peers."""
    task, folder, out, repeat, listed = read_arguments()
    if listed:
        print(json.dumps({"tasks": list(WORKS)}))
        return
    exr.use_all_processors()
    device = Device()
    if task == "T10":
        sequence(device, folder, out)
        return
    given = {name: read(folder, name) for name in TASKS[task].inputs}

    def work() -> Array:
        uploaded = [device.upload(name, pixels) for name, pixels in given.items()]
        return device.download(WORKS[task](device, *uploaded))

    if out:
        exr.write(Path(out), np.asarray(work()), half=True)
    else:
        print_seconds(time_runs(work, repeat))


if __name__ == "__main__":
    main()
