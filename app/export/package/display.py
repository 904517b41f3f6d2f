"""Writes the last program of a package: what makes a picture for a screen of scene light."""

from __future__ import annotations

from halation.nodes import Kind

from ...color.gpu_programs import write_view_program
from ...color.management import get_color_manager
from ...compiler import Plan
from ...graph import OUTPUTS, color_settings
from ...inputs.default_view import PictureEncodings, choose_default_view
from ...resources.color_program import LookupTable
from ..order import ExportOrder

_COLOR = """    vec4 c = texelFetch(t0, ivec2(gl_FragCoord.xy), 0);
    vec3 light = c.a > 0.0 && c.a != 1.0 ? c.rgb / c.a : c.rgb;
    vec3 shown = clamp({function}(vec4(light, 1.0)).rgb, 0.0, 1.0);
    o0 = vec4(shown, clamp(c.a, 0.0, 1.0));"""

_DATA = "    o0 = vec4(clamp(texelFetch(t0, ivec2(gl_FragCoord.xy), 0).{channels}, 0.0, 1.0), 1.0);"


def write_display_program(
    order: ExportOrder, plan: Plan, surface: int, encodings: PictureEncodings
) -> tuple[str, tuple[LookupTable, ...], str]:
    """The fragment shader, GLSL 4.10, its tables, and the name of the view. The result has straight alpha."""
    graph, channels = order.graph, plan.surfaces[surface].channels
    output = graph.outputs.get(order.target.socket) if order.target.node == OUTPUTS else None
    is_color = output.kind is Kind.IMAGE if output else channels == 4
    head = ["#version 410 core", "uniform sampler2D t0;", "layout(location = 0) out vec4 o0;"]
    if not is_color:
        body = _DATA.format(channels="rrr" if channels == 1 else "rgb")
        return "\n".join([*head, "void main() {", body, "}", ""]), (), "numbers"
    view = (output.view if output else "") or choose_default_view(plan, surface, encodings)
    program = write_view_program(view, manager=get_color_manager(color_settings(graph), order.sandbox))
    body = _COLOR.format(function=program.function)
    return "\n".join([*head, program.text.body, "void main() {", body, "}", ""]), program.tables, view or "default"
