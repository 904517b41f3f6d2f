"""Why a node does nothing whose type is not known here, and what to install."""

from __future__ import annotations

import re
from collections.abc import Mapping

from halation.nodes import Node, catalogue, plugins

from . import rules
from .model import Unknown
from .names import did_you_mean
from .rules import Rule

_REQUIREMENT = r"[A-Za-z0-9][A-Za-z0-9._-]*==[A-Za-z0-9][A-Za-z0-9.+!_-]*"
"""A package and its version, as pip takes them. Anything else in a file is not repeated as a command to type."""


def explain_unknown(id: str, item: Unknown, node_types: Mapping[str, type[Node]] | None = None) -> tuple[str, Rule]:
    """What is wrong with a node of an unknown type, in a sentence that says what to do, and the rule for it.

    `node_types` are the installed ones, for suggestions.
    """
    if item.fault:
        return f"node '{id}': {item.fault}", rules.BROKEN_CODE
    if fault := _find_plugin_fault(item):
        return f"node '{id}' has the type '{item.type}' {fault}", rules.MISSING_PLUGIN
    hint = did_you_mean(item.type, catalogue() if node_types is None else node_types)
    if not hint:
        cure = "install the plug-in that brings it" if "." in item.type else "update Halation"
        hint = f": {cure}, or remove the node"
    return f"node '{id}' has the unknown type '{item.type}'{hint}", rules.UNKNOWN_TYPE


def _find_plugin_fault(item: Unknown) -> str:
    """Why the plug-in that a node comes from does not give it, and what to install; "" for a node of none."""
    package = item.raw.get("package")
    if package is None and "." not in item.type:
        return ""
    requirement = package if isinstance(package, str) and re.fullmatch(_REQUIREMENT, package) else ""
    namespace = item.type.partition(".")[0]
    name = _normalize(requirement.partition("==")[0])
    installed = [
        plugin
        for plugin in (plugins() if "." in item.type else ())
        if plugin.namespace == namespace or _normalize(plugin.package) == name
    ]
    for plugin in installed:
        if plugin.fault:
            return f"of the plug-in {plugin}, which cannot be loaded: {plugin.fault}"
    if not requirement:
        return ""
    lack = f"the installed {installed[0]} does not have it" if installed else "which is not installed"
    return f"of the plug-in {requirement.replace('==', ' ')}, {lack}: pip install {requirement}"


def _normalize(package: str) -> str:
    """The name of a package as indexes compare it (PEP 503)."""
    return re.sub(r"[-_.]+", "-", package).lower()
