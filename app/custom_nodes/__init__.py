"""Nodes that a user wrote: classes made of code that stands in a graph, or in a file beside it."""

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
