"""Writes the passes of a graph as one HTML page: what each reads and makes, as pictures, its time and its GLSL.

The page loads nothing and runs nothing: pictures are inside it, and it has no script. Several passes may read one
picture, so each is in the page once, as an SVG image with an id, and figures show it by that id. All that comes from a
graph, such as the names of its nodes, is escaped.
"""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping
from html import escape
from pathlib import Path

from msgspec import Struct, field
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers.graphics import GLShaderLexer

from ..compiler import Pass, Plan, Shader, Surface
from ..compiler.explain import describe_frames, format_bytes
from ..media.pictures.stored import Array, encode_png
from ..renderer import PassTrace
from ..version import VERSION
from .shipped_files import read_shipped_text
from .surface_picture import picture_surface

WIDTH = 320
"""Pixels across of a picture on the page: two of them and their reads fit beside each other on a laptop."""


class Thumbnail(Struct, frozen=True):
    """A small PNG of a surface, its width and height, and what is black and white in it."""

    png: bytes
    size: tuple[int, int]
    span: tuple[float, float] | None
    """For data: the numbers that are shown black and white."""


class PassesPage(Struct):
    """Collects the passes of a plan while they run; `text` is the page."""

    plan: Plan
    title: str
    about: str
    view: str
    """Through which view light is shown."""
    seconds: list[float] = field(default_factory=list[float])
    thumbnails: dict[int, Thumbnail] = field(default_factory=dict[int, Thumbnail])

    def add_pixels(self, pixels: Mapping[int, Array]) -> None:
        """Keep small pictures of surfaces, [height, width, channels], by their numbers."""
        for number, array in pixels.items():
            self.thumbnails[number] = shrink_surface(array, self.plan.surfaces[number], self.view)

    def add_pass(self, trace: PassTrace) -> None:
        """Add the next pass that has run."""
        self.seconds.append(trace.seconds)
        self.add_pixels(trace.pixels)

    @property
    def text(self) -> str:
        """The page."""
        filled = {
            "GENERATOR": f"Halation {VERSION}",
            "TITLE": escape(self.title),
            "ABOUT": escape(self.about),
            "FACTS": "".join(f"<dt>{escape(name)}</dt><dd>{escape(fact)}</dd>" for name, fact in self._list_facts()),
            "PICTURES": self._embed_pictures(),
            "SECTIONS": "\n".join((self._describe_uploads(), *map(self._describe_pass, range(len(self.plan.passes))))),
        }
        text = read_shipped_text("passes.html")
        for name, part in filled.items():
            text = text.replace(f"/*{name}*/", part)
        return text

    def _list_facts(self) -> Iterable[tuple[str, str]]:
        plan, programs = self.plan, len({render_pass.shader for render_pass in self.plan.passes})
        yield "Device", f"{plan.target.renderer}, OpenGL {plan.target.version / 100:.1f}, {plan.target.form} passes"
        time = f"{1000.0 * sum(self.seconds):.1f} ms together"
        worked = f"{len(plan.passes)} by {_count(programs, 'program')}, {time}"
        yield "Passes", worked if plan.passes else "none: the output is what is read"
        pictures, textures = _count(len(plan.surfaces), "picture"), _count(len(plan.slots), "texture")
        yield "Memory", f"{pictures} in {textures}, {format_bytes(plan.peak_bytes)}"
        yield "Frames", describe_frames(plan)
        yield "Outputs", ", ".join(f"{name} (#{number})" for name, number in plan.outputs.items())
        yield (
            "Light is shown",
            "as its numbers" if self.view == "none" else f"through {self.view or 'the default view'}",
        )

    def _describe_uploads(self) -> str:
        figures = [
            self._draw_figure(upload.surface, f"{upload.node}: {Path(upload.picture.path).name} {upload.picture.layer}")
            for upload in self.plan.uploads
        ]
        if not figures:
            return ""
        pictures = f'<div class="pictures writes">{"".join(figures)}</div>'
        return f'<section id="files"><h2>Read from outside</h2>{pictures}</section>'

    def _describe_pass(self, index: int) -> str:
        render_pass, surfaces = self.plan.passes[index], self.plan.surfaces
        milliseconds, longest = 1000.0 * self.seconds[index], max(self.seconds) or 1.0
        share = 100.0 * self.seconds[index] / longest
        read = "".join(self._draw_figure(number, surfaces[number].label) for number in render_pass.textures)
        written = "".join(self._draw_figure(number, surfaces[number].label) for number in render_pass.targets)
        nodes, functions = ", ".join(render_pass.nodes), ", ".join(dict.fromkeys(render_pass.functions))
        return (
            f'<section id="pass-{index}"><h2>{index}. {escape(nodes)} <span class="dim">{escape(functions)}</span></h2>'
            f'<p class="time" style="background-size: {share:.1f}% 100%">{milliseconds:.2f} ms</p><div class="row">'
            + (f'<div><h3>Reads</h3><div class="pictures reads">{read}</div></div>' if read else "")
            + f'<div><h3>Makes</h3><div class="pictures writes">{written}</div></div></div>'
            f"{_describe_numbers(render_pass)}{self._describe_program(index)}</section>"
        )

    def _describe_program(self, index: int) -> str:
        render_pass = self.plan.passes[index]
        if render_pass.host is not None:
            return f'<p class="dim">On the processor: {escape(render_pass.host.program.name)}</p>'
        first = next(at for at, other in enumerate(self.plan.passes) if other.shader == render_pass.shader)
        if first < index:
            return f'<p class="dim">The same program as <a href="#pass-{first}">pass {first}</a></p>'
        return _describe_shader(render_pass.shader)

    def _draw_figure(self, number: int, label: str) -> str:
        surface, thumbnail = self.plan.surfaces[number], self.thumbnails.get(number)
        makers = [at for at, render_pass in enumerate(self.plan.passes) if number in render_pass.targets]
        target = f"pass-{makers[0]}" if makers else "files"
        span = (
            f", {thumbnail.span[0]:.4g} is black, {thumbnail.span[1]:.4g} white" if thumbnail and thumbnail.span else ""
        )
        width, height = surface.size
        return (
            f"<figure>{self._draw_picture(number, label)}"
            f'<figcaption><a href="#{target}">#{number}</a> {escape(label)}<br>'
            f"{width}x{height} {surface.texel}, {format_bytes(surface.nbytes)}, texture {surface.slot}{span}"
            "</figcaption></figure>"
        )

    def _embed_pictures(self) -> str:
        """All pictures, each once: figures show them by their ids."""
        images = [
            f'<image id="picture-{number}" width="{thumbnail.size[0]}" height="{thumbnail.size[1]}" '
            f'href="data:image/png;base64,{b64encode(thumbnail.png).decode()}"/>'
            for number, thumbnail in self.thumbnails.items()
        ]
        return "\n".join(images)

    def _draw_picture(self, number: int, label: str) -> str:
        thumbnail = self.thumbnails.get(number)
        if thumbnail is None:
            return ""
        view_box = f"0 0 {thumbnail.size[0]} {thumbnail.size[1]}"
        return (
            f'<svg role="img" aria-label="{escape(label)}" viewBox="{view_box}"><use href="#picture-{number}"/></svg>'
        )


def shrink_surface(array: Array, surface: Surface, view: str) -> Thumbnail:
    """A small PNG of the pixels of a surface."""
    picture = picture_surface(array, surface, view, WIDTH)
    return Thumbnail(encode_png(picture.codes), (picture.codes.shape[1], picture.codes.shape[0]), picture.span)


def _describe_numbers(render_pass: Pass) -> str:
    """The uniforms of a pass."""
    rows = "".join(
        f"<tr><td>{escape(name)}</td><td>{escape(_spell_number(number))}</td></tr>"
        for name, number in render_pass.uniforms
    )
    return (
        f"<details><summary>{len(render_pass.uniforms)} numbers</summary><table>{rows}</table></details>"
        if rows
        else ""
    )


def _spell_number(number: object) -> str:
    if isinstance(number, tuple):
        return ", ".join(map(_spell_number, number))
    return f"{number:.6g}" if isinstance(number, float) else str(number)


def _describe_shader(shader: Shader) -> str:
    """The program, highlighted by Pygments, which escapes it."""
    code = highlight(shader.source, GLShaderLexer(), HtmlFormatter(nowrap=True))
    lines = shader.source.count("\n") + 1
    return f"<details><summary>GLSL, {lines} lines</summary><pre>{code}</pre></details>"


def _count(number: int, noun: str) -> str:
    """A number of things, such as `1 texture`."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
