"""The graph: an immutable value, its edits, its problems."""

from __future__ import annotations

from .animation import ANIMATED, Animation
from .color import color_settings
from .conversion import conversion, make_socket
from .evaluate_at_frame import animation_fault, evaluate_at_frame, find_key_range, is_animated, value_at
from .expressions import Expression
from .graph import Graph, Group, Item, signature
from .keys import Extrapolation, Interpolation, Key, Keys
from .lookup import find_declaration, find_node_output, list_sockets
from .model import Control, Input, Output, Port, Settings, Signature, Unknown
from .names import INPUTS, OUTPUTS, did_you_mean
from .problems import Problem, problems

__all__ = [
    "ANIMATED",
    "INPUTS",
    "OUTPUTS",
    "Animation",
    "Control",
    "Expression",
    "Extrapolation",
    "Graph",
    "Group",
    "Input",
    "Interpolation",
    "Item",
    "Key",
    "Keys",
    "Output",
    "Port",
    "Problem",
    "Settings",
    "Signature",
    "Unknown",
    "animation_fault",
    "color_settings",
    "conversion",
    "did_you_mean",
    "evaluate_at_frame",
    "find_declaration",
    "find_key_range",
    "find_node_output",
    "is_animated",
    "list_sockets",
    "make_socket",
    "problems",
    "signature",
    "value_at",
]
