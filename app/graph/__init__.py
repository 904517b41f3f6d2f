"""The graph: an immutable value, its edits, its problems."""

from __future__ import annotations

from .conversion import conversion
from .faces import signature
from .graph import Graph
from .group import Group, Item
from .lookup import node_output
from .names import INPUTS, OUTPUTS, did_you_mean
from .parts import Control, Input, Output, Port, Settings, Signature, Unknown
from .problems import Problem, problems

__all__ = [
    "INPUTS", "OUTPUTS", "Control", "Graph", "Group", "Input", "Item", "Output", "Port", "Problem", "Settings",
    "Signature", "Unknown", "conversion", "did_you_mean", "node_output", "problems", "signature",
]
