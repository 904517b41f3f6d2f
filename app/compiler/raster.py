"""The GLSL of the pass that draws meshes: seven channels of what the camera sees, in one pass."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ..resources.mesh import ATTRIBUTES

CHANNELS: Mapping[str, tuple[int, bool, str]] = {
    "albedo": (4, False, "vec4(v_albedo, 1.0)"),
    "normal": (3, True, "raster_facing(v_normal, v_place, eye)"),
    "place": (4, True, "vec4(v_place, v_now.z)"),
    "emission": (4, False, "vec4(v_emission, 1.0)"),
    "metal_rough": (2, True, "v_metal_rough"),
    "velocity": (4, True, "raster_velocity(v_now, v_before, v_after, vec2(grid) / proxy)"),
    "surface": (4, True, "vec4(v_uv, v_object_material)"),
}
"""The pictures that a mesh is drawn into: channels, whether it is data, and its GLSL. The background is 0."""


def write_vertex_text(library: str) -> str:
    """The vertex shader: where every vertex is now, before and after, in the world and in the picture."""
    inputs = "\n".join(f"in {_name_type(count)} {name};" for name, count in ATTRIBUTES.items())
    return f"""#version 410 core
{library}
uniform vec4[9] cameras;
uniform vec4[9] motions;
uniform float near;
uniform vec4 window;
{inputs}
{_declare_varyings("out")}
void main() {{
    bool moving = object_material_moving.z > 0.5;
    vec3 before = moving ? raster_moved(motions, 3, place) : place;
    vec3 after = moving ? raster_moved(motions, 6, place) : place;
    v_place = moving ? raster_moved(motions, 0, place) : place;
    v_normal = moving ? raster_turned(motions, normal) : normal;
    v_now = raster_seen(cameras, 0, v_place);
    v_before = raster_seen(cameras, 3, before);
    v_after = raster_seen(cameras, 6, after);
    v_uv = uv, v_albedo = albedo, v_emission = emission, v_metal_rough = metal_rough;
    v_object_material = object_material_moving.xy;
    gl_Position = raster_clip(v_now, near, window);
}}
"""


def write_fragment_lines(library: str, channels_written: list[str]) -> Iterator[str]:
    """The fragment shader, which writes these channels in order."""
    yield from ("#version 410 core", library, "uniform vec3 eye;", "uniform ivec2 grid;", "uniform float proxy;")
    yield _declare_varyings("in")
    for number, _ in enumerate(channels_written):
        yield f"layout(location = {number}) out vec4 o{number};"
    yield "void main() {"
    for number, name in enumerate(channels_written):
        channels, _, text = CHANNELS[name]
        whole = text if channels == 4 else f"vec4({text}, {', '.join(['0.0'] * (4 - channels))})"
        yield f"    o{number} = {whole};"
    yield "}"


def _declare_varyings(qualifier: str) -> str:
    channels_by_name = {
        "v_place": 3,
        "v_normal": 3,
        "v_now": 3,
        "v_before": 3,
        "v_after": 3,
        "v_uv": 2,
        "v_albedo": 3,
        "v_emission": 3,
        "v_metal_rough": 2,
    }
    lines = [f"{qualifier} {_name_type(count)} {name};" for name, count in channels_by_name.items()]
    return "\n".join([*lines, f"flat {qualifier} vec2 v_object_material;"])


def _name_type(count: int) -> str:
    return ("float", "vec2", "vec3", "vec4")[count - 1]
