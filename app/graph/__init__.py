"""The graph: an immutable value, its edits, its problems."""

from __future__ import annotations

from .animation import ANIMATED, Animation, animation_fault, is_animated, keyed_range, still, value_at
from .conversion import conversion, make_socket
from .expressions import Expression
from .faces import signature
from .graph import Graph
from .group import Group, Item
from .keys import Interpolation, Key, Keys, Outside
from .lookup import node_output
from .names import INPUTS, OUTPUTS, did_you_mean
from .parts import Control, Input, Output, Port, Settings, Signature, Unknown
from .problems import Problem, problems

__all__ = [
    "ANIMATED", "INPUTS", "OUTPUTS", "Animation", "Control", "Expression", "Graph", "Group", "Input", "Interpolation",
    "Item", "Key", "Keys", "Output", "Outside", "Port", "Problem", "Settings", "Signature", "Unknown",
    "animation_fault", "conversion", "did_you_mean", "is_animated", "keyed_range", "make_socket", "node_output",
    "problems", "signature", "still", "value_at",
]
