"""The tasks as command lines of GEGL, the other program that runs declared graphs from files to files.

Standard library alone: what starts programs imports it. GEGL writes float EXR only, and blurs by a recursive filter.
"""

from __future__ import annotations

import shlex
from pathlib import Path

from bench.tasks import FRAMES, PUSH, SEQUENCE, SIGMAS, Lens, Ten, picture_path, scale_length

TASKS = ("copy", *SIGMAS, "T2", "T3", "T4", "T5", "T6", "T8", "T10")


def node(operation: str, inner: str = "", id: str = "", **values: object) -> str:
    """An operation; what stands inside is its second input."""
    text = "".join(f"<param name='{name.replace('_', '-')}'>{value}</param>" for name, value in values.items())
    named = f" id='{id}'" if id else ""
    return f"<node operation='gegl:{operation}'{named}><params>{text}</params>{inner}</node>\n"


def ten(a: Path, b: Path, size: tuple[int, int]) -> str:
    """T5. A list reads from the result back to the file; the clones stand for nodes with an id."""
    red, green, blue = Ten.gain
    clone = "<clone ref='{}'/>\n".format
    grades = (
        node("multiply", id="graded", value=Ten.curve[0])
        + node("divide", node("add", value=Ten.curve[1]) + clone("rich"))
        + node("saturation", id="rich", scale=Ten.saturation)
        + node("gamma", value=1.0 / Ten.gamma)
        + node("add", value=sum(Ten.lift) / 3.0)
        + node("channel-mixer", rr_gain=red, gg_gain=green, bb_gain=blue)
        + node("exposure", exposure=0.5)
        + node("exr-load", path=a)
    )
    blur = node("gaussian-blur", std_dev_x=Ten.sigma, std_dev_y=Ten.sigma, abyss_policy="clamp")
    edges = node("multiply", value=Ten.edges) + node("edge-sobel", keep_sign="false")
    drawn = node("add", edges + clone("graded")) + node("mix", blur + clone("graded"), ratio=Ten.mix) + grades
    over = node("over", drawn).replace("gegl:over", "svg:src-over")
    return whole(node("crop", width=size[0], height=size[1]) + over + node("exr-load", path=b))


def whole(text: str) -> str:
    """A file of GEGL."""
    return f"<?xml version='1.0'?><gegl>\n{text}</gegl>\n"


def command(program: str, task: str, folder: Path, size: tuple[int, int], out: Path) -> list[str]:
    """The command line that does a task; graphs are written beside `out`. Of T10, `out` has {} for the frame."""
    width, height = size
    a, b = picture_path(folder, "a"), picture_path(folder, "b")
    single = {
        "copy": "nop",
        "T2": "bloom radius=16 threshold=80 strength=50",
        "T3": "reinhard05",
        "T4": f"edge-sobel keep-sign=false gegl:crop width={width} height={height}",
    } | {name: f"gaussian-blur std-dev-x={s} std-dev-y={s} abyss-policy=clamp" for name, s in SIGMAS.items()}
    if task in single:
        return [program, str(a), "-o", str(out), "--", *f"gegl:{single[task]}".split()]
    if task == "T10":
        lines = [
            shlex.join([program, "-i", str(graph), "-o", str(out).format(f"{frame:04d}")])
            for frame in range(1, FRAMES + 1)
            for graph in [_write(out, f"gegl{frame}", ten(folder / SEQUENCE.format(frame), b, size))]
        ]
        return ["sh", "-c", " && ".join(lines)]
    push = 2.0 * scale_length(PUSH, width)
    move = {"amount_x": push, "amount_y": push, "sampler_type": "linear", "abyss_policy": "clamp"}
    soft = {"radius": scale_length(Lens.largest, width) / 2.0, "linear_mask": "true"}
    graph = {
        "T5": lambda: ten(a, b, size),
        "T6": lambda: whole(node("displace", node("perlin-noise", scale=64), **move) + node("exr-load", path=a)),
        "T8": lambda: whole(
            node("variable-blur", node("exr-load", path=picture_path(folder, "mask")), **soft)
            + node("exr-load", path=a)
        ),
    }[task]()
    return [program, "-i", str(_write(out, f"gegl_{task}", graph)), "-o", str(out)]


def _write(out: Path, name: str, text: str) -> Path:
    path = out.with_name(f"{name}.xml")
    path.write_text(text, "utf-8")
    return path
