"""Writes the pass of a program that users wrote in another format."""

from __future__ import annotations

from halation.nodes import ShaderStage, Uniform

from ..fusion.fuse import PassGroup
from ..ir import ExternalProgram
from ..plan import LINES_PER_FILE, Shader
from .names import uniform_value


def write_external(
    root: ExternalProgram, group: PassGroup, rounding: list[str]
) -> tuple[Shader, tuple[tuple[str, Uniform], ...]]:
    """The program and the values of its uniforms: samplers get the texture units of their pictures.

    `rounding` is the text of `as_half`, if the result is stored in half floats. What is added has names that begin with
    `halation_`, because the user's program may define any other name.
    """
    fragment, vertex = root.program.fragment, root.program.vertex
    color = "halation_half(halation_pixel())" if rounding else "halation_pixel()"
    rounding = [line.replace("as_half", "halation_half") for line in rounding]
    end = [
        "layout(location = 0) out vec4 halation_target;",
        *rounding,
        f"void main() {{ halation_target = {color}; }}",
    ]
    shader = Shader(
        "\n".join([_write_stage(fragment, 1), *end]) + "\n",
        "fragment",
        ("generated", fragment.file, *([vertex.file] if vertex else [])),
        False,
        _write_stage(vertex, 2) if vertex else "",
        foreign=True,
    )
    units = {ref: unit for unit, ref in enumerate(group.reads)}
    values = tuple((name, uniform_value(item)) for name, item in root.uniforms)
    return shader, (*values, *((name, units[ref]) for name, ref in root.pictures))


def _write_stage(stage: ShaderStage, file: int) -> str:
    # The second extension lets functions that return floats return integers, as older GLSL does.
    top = (
        "#version 410 core",
        "#extension GL_ARB_shading_language_packing : enable",
        "#extension GL_ARB_shading_language_420pack : enable",
        stage.head,
    )
    return "\n".join([*top, f"#line {LINES_PER_FILE * file + 1}", stage.text.rstrip("\n"), "#line 1", stage.tail])
