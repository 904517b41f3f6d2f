"""Describes a plan for people and machines: a table of passes, JSON, or Graphviz."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from .areas import Region
from .plan import Pass, Plan, Surface


def format_bytes(count: int) -> str:
    """Bytes in the largest unit that keeps one digit before the point."""
    amount = float(count)
    for unit in ("B", "KiB", "MiB"):
        if amount < 1024.0:
            return f"{amount:.0f} {unit}" if unit == "B" else f"{amount:.1f} {unit}"
        amount /= 1024.0
    return f"{amount:.2f} GiB"


def explain(plan: Plan, views: Mapping[str, str] = MappingProxyType({})) -> str:
    """Uploads, passes with what was fused into each, formats, slots, bytes, and the peak of texture memory.

    `views` say through which view an output is written into formats for screens.
    """
    target = plan.target
    lines = [f"target    {target.renderer}, GL {target.version / 100:.1f}, {target.form} passes ({target.why})"]
    for upload in plan.uploads:
        picture, surface = upload.picture, plan.surfaces[upload.surface]
        layer = f":{picture.layer}" if picture.layer else ""
        lines.append(f"upload    {_describe_surface(upload.surface, surface)}  {upload.node} <- {picture.path}{layer}")
    goes_beyond = any(map(_goes_beyond, plan.surfaces))
    for index, pass_ in enumerate(plan.passes):
        written = ", ".join(_describe_surface(number, plan.surfaces[number]) for number in pass_.targets)
        read = " ".join(f"#{number}" for number in pass_.textures) or "-"
        ends = "  ends at the frame" if goes_beyond and pass_.shader.foreign else ""
        lines.append(f"pass {index:<4} {written}  {_describe_pass(pass_)}  reads {read}{ends}")
    for name, number in plan.outputs.items():
        lines.append(f"output    #{number}  {name}{views.get(name, '') and f'  view: {views[name]}'}")
    lines.append(f"frames    {describe_frames(plan)}")
    shaders = len({pass_.shader for pass_ in plan.passes})
    lines.append(
        f"total     {len(plan.passes)} passes, {shaders} programs, {len(plan.surfaces)} surfaces in "
        f"{len(plan.slots)} textures, peak {format_bytes(plan.peak_bytes)}"
    )
    return "\n".join([*lines, *_describe_tiles(plan)])


def _describe_tiles(plan: Plan) -> Iterator[str]:
    """How a plan that does not fit is run: what is made whole first, and then the outputs."""
    if plan.tiling is None:
        return
    yield f"tiles     {plan.tiling.why}"
    for stage in plan.tiling.stages:
        first = next(iter(stage.outputs.values()))
        whole, (width, height) = plan.tiling.program.shape(first).size, stage.tiles[0].size
        owner = plan.tiling.program.ops[first.op].owner
        yield (
            f"stage     {whole[0]}x{whole[1]} of {owner} in {len(stage.tiles)} tiles of {width}x{height}, "
            f"{len(stage.passes)} passes each"
        )
    yield f"held      at most {format_bytes(plan.tiling.nbytes)} of textures and pictures at once"


def describe_frames(plan: Plan) -> str:
    """Whether a frame can be made without the ones before it, and why not."""
    if not plan.memories:
        return "independent: each can be rendered alone, and several at a time"
    nodes = " and ".join(f"'{node}'" for node in plan.remembering)
    size = format_bytes(sum(plan.surfaces[number].nbytes for number in plan.remembered))
    return f"each is made of the one before, of which {size} are kept for {nodes}"


def plan_as_json(plan: Plan) -> dict[str, object]:
    """The same facts for machines."""
    return {
        "target": plan.target.renderer,
        "form": plan.target.form,
        "why": plan.target.why,
        "frames": {"independent": not plan.memories, "remembering": sorted(plan.remembering)},
        "uploads": [
            {"surface": item.surface, "node": item.node, "path": item.picture.path, "layer": item.picture.layer}
            for item in plan.uploads
        ],
        "passes": [
            {
                "nodes": list(pass_.nodes),
                "functions": list(pass_.functions),
                "form": pass_.shader.form,
                "reads": list(pass_.textures),
                "writes": list(pass_.targets),
            }
            for pass_ in plan.passes
        ],
        "surfaces": [_surface_as_json(item) for item in plan.surfaces],
        "outputs": dict(plan.outputs),
        "peak_bytes": plan.peak_bytes,
        "tiles": None
        if plan.tiling is None
        else {
            "why": plan.tiling.why,
            "peak_bytes": plan.tiling.nbytes,
            "stages": [
                {"outputs": list(stage.outputs), "tiles": len(stage.tiles), "size": list(stage.tiles[0].size)}
                for stage in plan.tiling.stages
            ],
        },
    }


def _surface_as_json(item: Surface) -> dict[str, object]:
    return {
        "node": item.label,
        "size": list(item.size),
        "frame": list(item.frame_size),
        "start": list(item.window.start) if item.window else [0, 0],
        "pixel_aspect": item.pixel_aspect,
        "channels": item.channels,
        "format": item.texel,
        "slot": item.slot,
        "bytes": item.nbytes,
        "first": item.first,
        "last": item.last,
        "key": item.key,
    }


def write_dot(plan: Plan) -> str:
    """The plan as a Graphviz graph: boxes are passes, edges are surfaces with their format and slot."""
    lines = ["digraph plan {", '  rankdir=LR; node [shape=box, fontname="sans-serif"]; edge [fontname="sans-serif"];']
    makers: dict[int, str] = {}
    for upload in plan.uploads:
        makers[upload.surface] = f"upload{upload.surface}"
        lines.append(f'  upload{upload.surface} [shape=folder, label="{_escape(upload.picture.path)}"];')
    for index, pass_ in enumerate(plan.passes):
        lines.append(f'  pass{index} [label="{index}: {_escape(_describe_pass(pass_))}"];')
        for number in pass_.targets:
            makers[number] = f"pass{index}"
        lines += [
            f'  {makers[number]} -> pass{index} [label="{_escape(_describe_surface(number, plan.surfaces[number]))}"];'
            for number in pass_.textures
        ]
    for name, number in plan.outputs.items():
        lines.append(f'  "out_{_escape(name)}" [shape=ellipse, label="{_escape(name)}"];')
        lines.append(f'  {makers[number]} -> "out_{_escape(name)}";')
    return "\n".join([*lines, "}"])


def _describe_pass(pass_: Pass) -> str:
    """What a pass does: one function, or all that were fused, with the nodes they came from."""
    return f"{' + '.join(pass_.functions)}  [{', '.join(pass_.nodes)}]"


def _describe_surface(number: int, surface: Surface) -> str:
    width, height = surface.size
    shape = f" pixel aspect {surface.pixel_aspect:g}" if surface.pixel_aspect != 1.0 else ""
    if surface.window and surface.window != Region.whole(surface.frame_size):
        frame = "x".join(map(str, surface.frame_size))
        shape = f" from {surface.window.x},{surface.window.y} of {frame}{shape}"
    return f"#{number} {width}x{height}{shape} {surface.texel} slot {surface.slot} ({format_bytes(surface.nbytes)})"


def _goes_beyond(surface: Surface) -> bool:
    """True if there are pixels beyond the frame."""
    return surface.window is not None and not Region.whole(surface.frame_size).contains(surface.window)


def _escape(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"')
