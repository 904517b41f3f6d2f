"""Fills the inputs of a graph in an effect: with the picture of the game, its depth, and normals made of the depth."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from halation.nodes import Kind

from ...errors import GraphError
from ...graph import INPUTS, OUTPUTS, Graph, Port
from ..package.curves import Record

PICTURE, DEPTH, NORMAL = "picture", "depth", "normal"

_PICTURES = ("beauty", "image", "picture")
"""Names by which inputs are the picture itself, where there are several inputs with color."""

DEPTH_CONTROLS = (
    'uniform float depth_of_far_plane < ui_type = "drag"; ui_min = 1.0; ui_max = 100000.0; ui_label = "Far plane"; '
    'ui_tooltip = "How far away the farthest depth of the game is, in the units of the look."; > = 1000.0;',
    'uniform float field_of_view < ui_type = "slider"; ui_min = 10.0; ui_max = 120.0; ui_label = "Field of view"; '
    'ui_tooltip = "Of the height, in degrees. Normals are made of the depth with it."; > = 45.0;',
)
_DEPTH_CODE = """
float depth_at(float2 uv) { return ReShade::GetLinearizedDepth(uv) * depth_of_far_plane; }
float4 draw_depth(float4 position : SV_Position) : SV_Target {
    return float4(depth_at(position.xy / float2({width}.0, {height}.0)), 0.0, 0.0, 1.0);
}
// The point that a pixel shows, from the camera: x right, y up, z toward the camera.
float3 point_at(float2 uv) {
    float2 ray = (uv * 2.0 - 1.0) * tan(radians(field_of_view) * 0.5) * float2({width}.0 / {height}.0, -1.0);
    return float3(ray, -1.0) * depth_at(uv);
}
// The smaller of both differences keeps edges sharp.
float3 slope(float3 before, float3 here, float3 after) {
    return abs(after.z - here.z) < abs(here.z - before.z) ? after - here : here - before;
}
float4 draw_normal(float4 position : SV_Position) : SV_Target {
    float2 step = 1.0 / float2({width}.0, {height}.0), uv = position.xy * step;
    float3 here = point_at(uv);
    float3 right = slope(point_at(uv - float2(step.x, 0.0)), here, point_at(uv + float2(step.x, 0.0)));
    float3 up = slope(point_at(uv + float2(0.0, step.y)), here, point_at(uv - float2(0.0, step.y)));
    return float4(normalize(cross(right, up)), 1.0);
}
"""
_PICTURE_CODE = """
texture2D GameTexture : COLOR;
sampler2D GameSampler {{ Texture = GameTexture; }};
float4 draw_picture(float4 position : SV_Position) : SV_Target {{
#if BUFFER_WIDTH == {width} && BUFFER_HEIGHT == {height}
    float4 game = FETCH(GameSampler, int(position.x), int(position.y));
#else
    float4 game = tex2Dlod(GameSampler, float4(position.xy / float2({width}.0, {height}.0), 0.0, 0.0));
#endif
    return float4(decode_srgb(game.rgb), 1.0);
}}
"""


def find_roles(graph: Graph) -> dict[str, str]:
    """What a game gives for inputs of a graph by name: the picture, its depth, or normals."""
    colors = [name for name, end in graph.inputs.items() if end.kind is Kind.IMAGE]
    chosen = next((name for name in _PICTURES if name in colors), colors[0] if len(colors) == 1 else "")
    roles: dict[str, str] = {}
    for name, end in graph.inputs.items():
        if name == chosen:
            roles[name] = PICTURE
        elif end.kind is Kind.FIELD and name == DEPTH:
            roles[name] = DEPTH
        elif end.kind is Kind.VECTOR and name == NORMAL:
            roles[name] = NORMAL
    return roles


def bind_blank(graph: Graph, size: tuple[int, int]) -> dict[str, np.ndarray]:
    """Pictures of a size for what the game gives. Nobody reads their pixels, but passes are planned for their size."""
    width, height = size
    channels = {PICTURE: 4, DEPTH: 1, NORMAL: 3}
    return {name: np.zeros((height, width, channels[role]), np.float32) for name, role in find_roles(graph).items()}


def refuse_layers(graph: Graph, target: Port) -> None:
    """Raise GraphError for a layer that a picture of the graph needs and no game gives."""
    shown = graph.links.get(target) if target.node == OUTPUTS else target
    needed = {shown.node, *graph.upstream(shown.node)} if shown else set[str]()
    read = [start.socket for end, start in graph.links.items() if start.node == INPUTS and end.node in needed]
    for name in sorted({*read, *([shown.socket] if shown and shown.node == INPUTS else ())} - find_roles(graph).keys()):
        if graph.inputs[name].file or graph.inputs[name].kind is Kind.IMAGE:
            raise GraphError(
                f"it reads the input '{name}', and an effect of ReShade has the picture, its depth and normals alone: "
                "link a node in place of the layer",
                node=f"{INPUTS}.{name}",
            )


def choose_roles(graph: Graph, sources: list[Record], used: set[int]) -> dict[int, str]:
    """What a game gives for each used source that is an input of the graph, by number."""
    known = find_roles(graph)
    inputs = {at: sources[at]["name"] for at in sorted(used) if sources[at]["is_end"]}
    return {at: known[name] for at, name in inputs.items() if name in known}


def write_sources(roles: Mapping[int, str], size: tuple[int, int]) -> list[str]:
    """The functions that draw what the game gives."""
    width, height = size
    lines = _PICTURE_CODE.format(width=width, height=height).splitlines() if PICTURE in roles.values() else []
    if {DEPTH, NORMAL} & set(roles.values()):
        code = _DEPTH_CODE.replace("{width}", str(width)).replace("{height}", str(height))
        lines += [*DEPTH_CONTROLS, *code.splitlines()]
    return lines
