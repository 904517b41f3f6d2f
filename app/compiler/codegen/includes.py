"""Includes shader files in a pass: only the functions that it needs, in an order in which they compile.

A file is cut to the functions that the pass calls, directly or through others. Files that read a picture through an
accessor (`image_at`) come after the accessors of the pass, all others before. The macros of a node's choices are
defined around its own file only, and `#line` makes drivers report the line of the file.

An inlined gather may stand in a pass several times, with other pictures each time. Its file is then included once for
each, with macros that give its functions and accessors a prefix.
"""

from __future__ import annotations

from ...glsl import GlslText, macro_name, words
from ..library import PASS_UNIFORMS, Lines
from ..plan import LINES_PER_FILE
from .pass_parts import InlinedGather, PassContext, PassParts


def include_files(context: PassContext, parts: PassParts) -> Lines:
    """The lines of the files of a pass, remembered: many passes of a large graph differ in numbers alone."""
    if any(op.color_programs for op in context.members):
        return _find_lines(context, parts)
    key = (
        *parts.shaders,
        None,
        *parts.functions,
        None,
        *parts.body,
        None,
        *parts.results,
        parts.accessors,
        *((op.shader, op.function, op.choices) for op in context.functions),
        *(gather.prefix for gather in parts.inlined),
    )
    return context.library.remember_lines(key, lambda: _find_lines(context, parts))


def select_texts(context: PassContext, parts: PassParts) -> tuple[GlslText, ...]:
    """The shader files of a pass, includes first, with only the functions that it needs."""
    selected: list[GlslText] = []
    needed = words(*parts.functions, *parts.body, *parts.results)
    inlined_words = frozenset[str]().union(*(gather.text.words for gather in parts.inlined))
    inlined_files = {gather.text.name for gather in parts.inlined}
    included = (name for gather in parts.inlined for name in gather.text.includes)
    files = context.library.closure(tuple(dict.fromkeys((*parts.shaders, *included))), context.root.owner)
    programs = dict.fromkeys(program for op in context.members for program in op.color_programs)
    for text in reversed((*files, *(program.text for program in programs))):
        # The own file of an inlined gather is included with the gather.
        cut_text = text.keep_needed(needed if text.name in inlined_files else needed | inlined_words)
        needed |= cut_text.words
        selected.append(cut_text)
    return tuple(reversed(selected))


def split_by_accessors(texts: tuple[GlslText, ...], parts: PassParts) -> tuple[list[GlslText], list[GlslText]]:
    """The files that come before the functions of a pass, and those that read through its accessors and follow them."""
    early, late = list[GlslText](), list[GlslText]()
    for text in texts:
        reads = text.words & parts.accessors.union(*(item.functions for item in late))
        (late if reads else early).append(text)
    return early, late


def find_macros(text: GlslText, context: PassContext) -> list[tuple[str, int]]:
    """The macros of a node's choices that its file uses, and their numbers."""
    choices = next((op.choices for op in context.functions if op.shader == text.name), ())
    macros = ((macro_name(name, choice), number) for name, names in choices for number, choice in enumerate(names))
    return [(name, number) for name, number in macros if name in text.words]


def _find_lines(context: PassContext, parts: PassParts) -> Lines:
    texts, files = select_texts(context, parts), ["generated"]
    early, late = (
        [line for text in side for line in _include(text, files, context)] for side in split_by_accessors(texts, parts)
    )
    late += [line for gather in parts.inlined for line in _include_inlined(gather, files, context)]
    uniforms = frozenset[str]().union(*(text.words for text in texts)) & PASS_UNIFORMS
    return (*early,), (*late,), (*files,), uniforms


def _include_inlined(gather: InlinedGather, files: list[str], context: PassContext) -> list[str]:
    """The file of an inlined gather, with its prefix for names."""
    return [
        *(f"#define {word} {gather.prefix}{word}" for word in gather.renamed_words),
        *_include(gather.text, files, context),
        *(f"#undef {word}" for word in gather.renamed_words),
    ]


def _include(text: GlslText, files: list[str], context: PassContext) -> list[str]:
    """A shader file, with the macros of its node's choices around it and its own line numbers."""
    macros = find_macros(text, context)
    files.append(text.file)
    return [
        *(f"#define {name} {number}" for name, number in macros),
        f"#line {LINES_PER_FILE * (len(files) - 1) + 1}",
        text.body.rstrip("\n"),
        "#line 1",
        *(f"#undef {name}" for name, _ in macros),
    ]
