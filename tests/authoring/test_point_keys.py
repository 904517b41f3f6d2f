"""Points of splines that are keyed together or singly."""

from __future__ import annotations

import numpy as np
import pytest
from halation.authoring import commands as c
from halation.authoring.session import Session
from halation.document import dumps
from halation.graph import Graph, Key, Keys, Port, value_at
from halation.nodes import RotoShape, catalogue, insert_point, join_points, name_roto_shapes, split_points
from halation.resources.sandbox import UNRESTRICTED

SHAPES, POINTS = Port("roto", "shapes"), Port("roto", "shapes.box.points")
BOX = ((0.3, 0.3), (0.7, 0.3), (0.7, 0.7), (0.3, 0.7))


def point(number: int) -> Port:
    return Port("roto", f"shapes.box.points.{number}")


@pytest.fixture
def session() -> Session:
    """A square that moves by a tenth of the picture from frame 1 to 11."""
    graph = Graph().add("roto", catalogue()["roto"](shapes=name_roto_shapes(box=RotoShape(points=join_points(BOX)))))
    moved = join_points([(x + 0.1, y) for x, y in BOX])
    graph = graph.animate(POINTS, Keys((Key(1, join_points(BOX), "linear"), Key(11, moved))))
    session = Session(sandbox=UNRESTRICTED)
    session.apply(c.ReplaceGraph("Add", graph))
    return session


def places(session: Session, frame: float) -> np.ndarray:
    return np.array(split_points(value_at(session.graph, POINTS, frame)))[:, :2]


def move(session: Session, frame: int, moved: dict[int, tuple[float, float]], **flags: bool) -> None:
    session.time.seek(frame)
    points = [*split_points(value_at(session.graph, POINTS, frame))]
    for number, place in moved.items():
        points[number] = (*place, *points[number][2:])
    session.apply(c.MovePoints(POINTS, tuple(points), "Move", **flags))


def keyed_frames(session: Session, port: Port) -> list[float]:
    keys = session.graph.animation[port]
    assert isinstance(keys, Keys)
    return [key.frame for key in keys.keys]


def test_a_point_that_is_moved_singly_gets_a_key_alone(session: Session) -> None:
    before = dumps(session.graph)
    move(session, 6, {3: (0.2, 0.8)}, singly=True)
    assert keyed_frames(session, POINTS) == [1, 11]
    assert keyed_frames(session, point(3)) == [1, 6, 11] and set(session.graph.keyed_points[POINTS]) == {3}
    for frame, along in ((1, 0.0), (3.5, 0.25), (6, 0.5), (11, 1.0)):
        np.testing.assert_allclose(
            places(session, frame)[:3], np.array(BOX[:3]) + np.array((0.1 * along, 0.0)), atol=1e-9
        )
    np.testing.assert_allclose(places(session, 6)[3], (0.2, 0.8))
    np.testing.assert_allclose(places(session, 3.5)[3], (0.25, 0.75), atol=1e-9)  # linear, as the key before it
    session.undo()
    assert dumps(session.graph) == before


def test_points_are_keyed_together_where_nothing_else_is_asked(session: Session) -> None:
    move(session, 6, {0: (0.3, 0.2)})
    assert keyed_frames(session, POINTS) == [1, 6, 11] and not session.graph.keyed_points


def test_a_key_of_all_points_holds_those_with_keys_of_their_own_too(session: Session) -> None:
    move(session, 6, {3: (0.2, 0.8)}, singly=True)
    before = places(session, 8)
    move(session, 8, {0: (0.3, 0.2)})
    assert keyed_frames(session, POINTS) == [1, 8, 11] and keyed_frames(session, point(3)) == [1, 6, 8, 11]
    np.testing.assert_allclose(places(session, 8)[1:], before[1:], atol=1e-9)
    session.time.seek(9)
    session.apply(c.SetKey(POINTS))
    assert keyed_frames(session, point(3)) == [1, 6, 8, 9, 11]


def test_points_of_a_shape_without_keys_are_keyed_one_by_one(session: Session) -> None:
    session.apply(c.AnimateValue(POINTS, None, "Remove"))
    session.time.seek(1)
    session.apply(c.KeyPoints(POINTS, (1, 2), "Key"))
    move(session, 9, {1: (0.9, 0.3), 0: (0.1, 0.1)}, singly=True)
    assert keyed_frames(session, point(1)) == [1, 9] and keyed_frames(session, point(2)) == [1]
    assert POINTS not in session.graph.animation and set(session.graph.keyed_points[POINTS]) == {1, 2}
    np.testing.assert_allclose(places(session, 1), [(0.1, 0.1), *BOX[1:]])
    move(session, 9, {3: (0.3, 0.9)})
    assert POINTS not in session.graph.animation and keyed_frames(session, point(2)) == [1]
    np.testing.assert_allclose(places(session, 9), [(0.1, 0.1), (0.9, 0.3), BOX[2], (0.3, 0.9)])


def test_points_follow_the_keys_of_the_shape_again(session: Session) -> None:
    move(session, 6, {3: (0.2, 0.8), 2: (0.9, 0.9)}, singly=True)
    session.apply(c.DropPointKeys(POINTS, (3,), "Together"))
    assert set(session.graph.keyed_points[POINTS]) == {2}
    np.testing.assert_allclose(places(session, 6)[3], (0.35, 0.7))
    session.apply(c.AnimateValue(POINTS, None, "Remove"))
    session.apply(c.DropPointKeys(POINTS, (2,), "Together"))
    assert not session.graph.animation
    np.testing.assert_allclose(places(session, 1)[2], (0.9, 0.9))


def test_ripple_moves_the_keys_of_single_points_too(session: Session) -> None:
    move(session, 6, {3: (0.2, 0.8)}, singly=True)
    before = {frame: places(session, frame) for frame in (1, 6, 11)}
    move(session, 6, {3: (0.25, 0.8), 0: (0.35, 0.2)}, ripples=True)
    for frame, earlier in before.items():
        offset = places(session, frame) - earlier
        np.testing.assert_allclose(offset, [(0.0, -0.1), (0.0, 0.0), (0.0, 0.0), (0.05, 0.0)], atol=2e-6)


def test_a_point_beside_one_with_keys_of_its_own_is_inserted_on_the_curve(session: Session) -> None:
    move(session, 6, {3: (0.2, 0.8)}, singly=True)
    session.apply(c.KeyPoints(POINTS, (1,), "Key"))
    points = {frame: split_points(value_at(session.graph, POINTS, frame)) for frame in (1, 6, 11)}
    change = c.ChangePoints(POINTS, lambda rows: insert_point(rows, 2, 0.25), "Insert", origins=(0, 1, 2, None, 3))
    session.apply(change)
    assert set(session.graph.keyed_points[POINTS]) == {1, 3, 4}
    for frame, rows in points.items():
        expected = insert_point(rows, 2, 0.25)
        np.testing.assert_allclose(split_points(value_at(session.graph, POINTS, frame)), expected, atol=1e-6)
    session.undo()
    assert set(session.graph.keyed_points[POINTS]) == {1, 3}


def test_keys_of_points_stay_with_them_when_others_are_removed(session: Session) -> None:
    move(session, 6, {3: (0.2, 0.8)}, singly=True)
    before = [places(session, frame) for frame in (1, 4, 6, 9)]
    session.apply(c.ChangePoints(POINTS, lambda rows: rows[1:], "Remove", origins=(1, 2, 3)))
    assert set(session.graph.keyed_points[POINTS]) == {2}
    for frame, earlier in zip((1, 4, 6, 9), before, strict=True):
        np.testing.assert_allclose(places(session, frame), earlier[1:], atol=2e-6)
    session.apply(c.ChangePoints(POINTS, lambda rows: rows[:2], "Remove", origins=(0, 1)))
    assert not session.graph.keyed_points


def test_keys_of_points_follow_a_shape_that_is_renamed_copied_and_removed(session: Session) -> None:
    move(session, 6, {3: (0.2, 0.8)}, singly=True)
    copied = session.apply(c.DuplicateItem(SHAPES, "box"))
    assert set(session.graph.keyed_points[Port("roto", f"shapes.{copied}.points")]) == {3}
    session.apply(c.RenameItem(SHAPES, "box", "face"))
    assert set(session.graph.keyed_points[Port("roto", "shapes.face.points")]) == {3}
    session.apply(c.RemoveItem(SHAPES, "face"))
    assert set(session.graph.keyed_points) == {Port("roto", f"shapes.{copied}.points")}


def test_the_shown_graph_has_single_points_where_their_keys_are(session: Session) -> None:
    """Also where they are as in the file: keys of all points have moved them away from there."""
    session.apply(c.AnimateValue(point(3), Keys((Key(1, (*BOX[3], *(0.0,) * 5)),)), "Hold"))
    session.time.seek(11)
    shown = split_points(session.time.evaluated_graph.value(POINTS))
    np.testing.assert_allclose([row[:2] for row in shown], [*np.array(BOX[:3]) + np.array((0.1, 0.0)), BOX[3]])
