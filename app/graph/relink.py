"""Moves links, controls and animation when a node is replaced by one with other sockets."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from halation.nodes import Value

from .animation import ANIMATED, Animation
from .model import Control, Port, Signature

Find = Callable[[str], Value | None]
"""The declaration of a value of the new node, or None."""

Fits = Callable[[Port, Port], bool]
"""True if a link from the first port to the second is valid."""


def move_links(links: Mapping[Port, Port], moves: Mapping[Port, Port]) -> dict[Port, Port]:
    """All links with some ports replaced by others."""
    return {moves.get(target, target): moves.get(source, source) for target, source in links.items()}


def relink(links: Mapping[Port, Port], id: str, old: Signature, new: Signature, fits: Fits) -> dict[Port, Port]:
    """All links by target, with those of node `id` moved from its old sockets to its new ones.

    A link stays on the socket of the same name if it fits, else moves to the first free one that fits, else is removed.
    """
    other_links = {target: source for target, source in links.items() if id not in (target.node, source.node)}
    rank = {name: place for place, name in enumerate((*old.inputs, *old.values))}
    into = [(target, source) for target, source in links.items() if target.node == id != source.node]
    into.sort(key=lambda link: (rank.get(link[0].socket, len(rank)), link[0]))
    homeless: list[Port] = []
    for target, source in into:
        if fits(source, target):
            other_links[target] = source
        else:
            homeless.append(source)
    for source in homeless:
        ends = (Port(id, name) for name in new.inputs)
        if end := next((end for end in ends if end not in other_links and fits(source, end)), None):
            other_links[end] = source
    for target, source in links.items():
        if source.node == id != target.node:
            starts = (source, *(Port(id, name) for name in new.outputs))
            if start := next((start for start in starts if fits(start, target)), None):
                other_links[target] = start
    return other_links


def keep_controls(controls: Mapping[str, Control], id: str, interface: Signature, find: Find) -> dict[str, Control]:
    """All controls, without those of values that node `id` does not have."""
    return {
        name: control
        for name, control in controls.items()
        if control.target.node != id or interface.anything or find(control.target.socket)
    }


def keep_animation(
    animation: Mapping[Port, Animation], id: str, interface: Signature, find: Find
) -> dict[Port, Animation]:
    """All animation, without that of values that node `id` does not have or that cannot be animated."""
    return {
        port: item
        for port, item in animation.items()
        if port.node != id or interface.anything or ((value := find(port.socket)) and value.type in ANIMATED)
    }
