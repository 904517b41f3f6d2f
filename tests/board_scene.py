"""A board with a straight edge above a floor, seen from above, and the part of a round light that the floor sees."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from geometry import rays
from halation.nodes import CameraModel, look_at

Array = np.ndarray
SIZE = 96


class Board(NamedTuple):
    """Pixels [h, w] of a board one unit above a floor, whose edge runs through the middle of the picture."""

    camera: CameraModel
    depth: Array
    normal: Array
    place: Array
    """Where each ray meets the floor."""
    toward: Array
    """Across the edge, away from the board."""
    is_judged: Array
    """Floor near enough to the middle that all that hides a light from it is in the picture."""


def take_board(turn: float) -> Board:
    """The board with its edge turned by so many degrees."""
    eye = np.array([0.0, 0.0, 4.0])
    camera = look_at(tuple(eye), (0.0, 0.0, 0.0), (1.2, 1.2), (0.0, 1.0, 0.0))
    way = rays(camera, SIZE, SIZE)
    toward = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.0])
    covered = (eye + 3.0 * way) @ toward < 0.0
    middle = np.abs(np.arange(SIZE) - SIZE / 2) < SIZE / 4
    normal = np.broadcast_to((0.0, 0.0, 1.0), (SIZE, SIZE, 3))
    depth = np.where(covered, 3.0, 4.0)
    return Board(camera, depth, normal, eye + 4.0 * way, toward, ~covered & middle & middle[:, None])


def measure_errors(board: Board, found: Array, chord: Array) -> Array:
    """What is wrong with the part of a disc that was found, in the half shadow: the part beyond a chord is a segment.

    `chord` is how far the chord lies from the middle of the disc, in radii, on the side that is hidden.
    """
    rest = np.sqrt(np.maximum(1.0 - chord * chord, 0.0))
    expected = 0.5 + (chord * rest + np.arcsin(np.clip(chord, -1.0, 1.0))) / np.pi
    half = board.is_judged & (chord > 0.1) & (chord < 0.9)
    assert half.sum() > 300
    return (found - expected)[half]
