"""Socket kinds are declared in one place, and everything else follows."""

from __future__ import annotations

import pytest
from halation.document.records import type_names
from halation.editor.theme.palette import DARK, LIGHT
from halation.graph import Input
from halation.graph.conversion import conversion, make_socket
from halation.nodes import KINDS, CameraModel, Kind, Socket, look_at
from halation.nodes._declare.camera import read_camera

CAMERA = look_at((0.0, -5.0, 1.5), (0.0, 0.0, 1.0), (1.4, 2.5))


def test_every_kind_is_declared_has_a_socket_and_a_color() -> None:
    assert list(KINDS) == list(Kind)
    assert {cls.kind for cls in Socket.__subclasses__()} == set(Kind)
    assert len(Socket.__subclasses__()) == len(Kind)
    assert all(set(palette.kinds) == set(Kind) for palette in (DARK, LIGHT))
    assert {kind for kind, _ in type_names().values()} == set(Kind)


@pytest.mark.parametrize("kind", Kind)
def test_what_the_table_says_is_what_sockets_do(kind: Kind) -> None:
    socket = make_socket(kind)
    facts = kind.facts
    assert (socket.channels, socket.single) == (facts.channels, facts.carried != "pixels")
    assert (socket.single, facts.is_color) == (kind.is_single, kind.is_color)
    assert (facts.read is not None) == kind.is_planned == (facts.carried == "plan")
    assert Input(kind).width == facts.channels
    fitting = {other for other in Kind if conversion(make_socket(kind, 3), make_socket(other, 3)) is None}
    assert fitting == facts.fits | {kind}


def test_only_pictures_and_colors_are_color() -> None:
    assert {kind for kind in Kind if kind.is_color} == {Kind.IMAGE, Kind.COLOR}


@pytest.mark.parametrize("kind", [kind for kind in Kind if kind.is_planned])
def test_planned_kinds_fit_nothing_else(kind: Kind) -> None:
    for other in set(Kind) - {kind}:
        for ends in ((make_socket(kind), make_socket(other)), (make_socket(other), make_socket(kind))):
            noun = (kind if kind is ends[0].kind or not other.is_planned else other).facts.noun
            assert f"a {noun} can only be linked to a " in (conversion(*ends) or "")


def test_numbers_in_a_file_are_a_camera() -> None:
    assert read_camera(CAMERA.rows) == CAMERA
    assert read_camera((0.0,) * 12) is None and read_camera((0.0,)) is None
    assert str(CameraModel((-0.0,) * 12).rows[0]) == "0.0"
