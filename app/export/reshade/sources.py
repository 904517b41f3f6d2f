"""Draws what a game gives into textures of an effect: its picture, its depth, and normals made of the depth."""

from __future__ import annotations

from collections.abc import Mapping

from ..game import DEPTH, NORMAL, PICTURE

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


def write_sources(roles: Mapping[int, str], size: tuple[int, int]) -> list[str]:
    """The functions that draw what the game gives."""
    width, height = size
    lines = _PICTURE_CODE.format(width=width, height=height).splitlines() if PICTURE in roles.values() else []
    if {DEPTH, NORMAL} & set(roles.values()):
        code = _DEPTH_CODE.replace("{width}", str(width)).replace("{height}", str(height))
        lines += [*DEPTH_CONTROLS, *code.splitlines()]
    return lines
