"""Custom nodes: node classes that are made from code of users, in a graph or in a file beside it.

There are two languages, GLSL (`glsl`) and the Interactive Shader Format (`isf`). Both end in `make_class`, which
returns a class with sockets, values and a shader like those in `nodes/`, so the compiler treats them alike. The class
is cached by its code: equal code is one class, and changed code is another one with another shader.

A GLSL node is one function. Its signature declares sockets and values, and a comment beside each parameter its default
and range (`notes`, `values`). If it reads only its own pixel it is pointwise, and is fused with its neighbors; if it
reads others (`image_at(p)`) it is a filter. Since it may share a pass with code of other nodes, its names get a prefix
(`prefixes`). An ISF node has a program of its own, because such shaders define whatever they like.

Before a driver sees any of it, the text is expanded, bounded and guarded (`securing`, `ending`, and `halation.glsl`).
"""

from __future__ import annotations

from .code import Code, CodeFault, CustomNode, Language, strip_prefix

__all__ = ["Code", "CodeFault", "CustomNode", "Language", "node_type", "strip_prefix"]


def node_type(code: Code) -> type[CustomNode]:
    """The class of the nodes that this code describes; the same class for equal code. Raises CodeFault."""
    if code.language == "isf":
        from .isf import make_isf_class

        return make_isf_class(code)
    from .glsl import make_glsl_class

    return make_glsl_class(code)
