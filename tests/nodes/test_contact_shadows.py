"""Contact shadows against rays that numpy casts towards the light, past a box on a floor."""

from __future__ import annotations

import numpy as np
import pytest
from board_scene import measure_errors, take_board
from box_scene import box, dilated, taken
from geometry import rays
from halation.nodes import look_at
from halation.nodes.light.contact_shadows import ContactShadows

HARD = {"softness": 0.0, "length": 1e3, "thickness": 1e4}


def shaded(run, camera, depth, normal=None, output="shadow", **values):
    inputs = {"depth": depth, "camera": camera} | ({} if normal is None else {"normal": normal})
    found = run(ContactShadows(**(HARD | values)), inputs, output=output)
    return found[..., 0] if output == "shadow" else found


@pytest.mark.parametrize("given", [True, False], ids=["normals", "depth alone"])
@pytest.mark.parametrize("light", ["sun", "lamp"])
def test_the_shadow_of_a_box(run, light, given):
    """Within a pixel of where rays to the light meet the box."""
    camera, depth, normal, place = taken()
    sun, lamp = np.array([-0.6, -0.35, 0.7]), np.array([-1.5, -1.2, 1.6])
    way = sun if light == "sun" else lamp - place
    lifted = place + 1e-4 * normal
    enter, leave = box(lifted, np.broadcast_to(way, place.shape))
    dark = np.isfinite(enter) & (leave > 1e-3) & ((light == "sun") | (enter < 1.0))
    floor = (normal[..., 2] > 0.5) & (place[..., 2] < 1e-6)
    values = {"light": light, "direction": tuple(sun), "position": tuple(lamp)}
    found = shaded(run, camera, depth, normal if given else None, **values)
    edge = dilated(dark & floor) & dilated(~dark | ~floor)
    clear = floor & ~edge
    assert (clear & dark).sum() > 100 and (clear & ~dark).sum() > 1000
    assert np.all(found[clear & ~dark] == 1.0)
    # What lies beyond the picture throws no shadow.
    met = place + np.where(dark, enter, 0.0)[..., None] * way
    seen = met @ np.reshape(camera.rows, (3, 4))[:, :3].T + np.reshape(camera.rows, (3, 4))[:, 3]
    inside = ((seen[..., :2] > 0.02 * seen[..., 2:]) & (seen[..., :2] < 0.98 * seen[..., 2:])).all(-1)
    assert np.all(found[clear & dark & inside] == 0.0)
    dark &= inside | (found < 0.5)
    wrong = floor & ((found < 0.5) != dark)
    assert wrong.sum() < 0.1 * (edge & floor).sum() + 0.02 * dark.sum()


@pytest.mark.parametrize("softness", [0.0, 8.0])
@pytest.mark.parametrize("height", [0.05, 3.0])
def test_planes_are_not_shadowed(run, height, softness):
    """Whichever way the sun is, from right above to the horizon."""
    camera, depth, normal, _ = taken((0.0, -4.0, height), (0.0, 0.0, 0.0), (96, 54), boxed=False)
    for turn in np.radians([0, 40, 90, 160, 270]):
        for rise, one in ((0.02, normal), (0.02, None), (1.0, None)):
            sun = (np.cos(turn), np.sin(turn), rise)
            assert np.all(shaded(run, camera, depth, one, direction=sun, softness=softness) == 1.0)


@pytest.mark.parametrize("eye", [(0.4, -3.5, 2.2), (2.1, -2.3, 1.4), (-1.7, -2.0, 2.7)])
def test_edges_do_not_shadow_what_they_are_edges_of(run, eye):
    """Sides of the box that the sun shines on, however their edges run through the picture."""
    camera, depth, normal, place = taken(eye)
    for sun in ((-0.6, -0.35, 0.7), (0.5, -0.8, 0.2), (0.1, -0.1, 0.9)):
        lit = (normal @ np.array(sun) > 0.05) & ((place[..., 2] > 1e-6) | (normal[..., 2] < 0.5))
        assert lit.sum() > 1000
        for one in (normal, None):
            found = shaded(run, camera, depth, one, direction=sun)[lit]
            assert (found < 1.0).mean() < 2e-3


def test_what_faces_away_and_what_is_nothing_stays(run):
    camera, depth, normal, _ = taken()
    assert np.all(shaded(run, camera, depth, normal, direction=(0.0, 0.0, -1.0))[normal[..., 2] > 0.5] == 1.0)
    for empty in (1e10, np.inf, 0.0, -1.0, np.nan):
        assert np.all(shaded(run, camera, np.full(depth.shape, empty), softness=5.0) == 1.0)


def test_length_and_color(run):
    """The shadow fades out where the box is too far away, and only the light that is wanted is taken."""
    camera, depth, normal, place = taken()
    sun = np.array([-0.6, -0.35, 0.7])
    values = {"direction": tuple(sun)}
    whole = shaded(run, camera, depth, normal, **values)
    short = shaded(run, camera, depth, normal, length=0.3, **values)
    enter, _ = box(place + 1e-4 * normal, np.broadcast_to(sun / np.linalg.norm(sun), place.shape))
    # Seen from the camera, what is behind the front of the box is a little wider than the box.
    floor = (place[..., 2] < 1e-6) & (whole < 0.01) & (place[..., 1] < 0.5)
    assert np.all(short >= whole - 1e-6)
    assert np.all(short[floor & (enter > 0.32)] == 1.0) and np.all(short[floor & (enter < 0.12)] < 0.1)
    out = shaded(run, camera, depth, normal, output="out", color=(0.2, 0.1, 0.0, 0.5), **values)
    taken_away = 0.5 * (1 - whole)[..., None] * (1 - np.array([0.2, 0.1, 0]))
    np.testing.assert_allclose(out[..., :3], 1 - taken_away, atol=1e-6)
    assert np.all(out[..., 3] == 1.0)


def test_soft_edges_grow_with_the_distance(run):
    """A disc of light over the box's edge: the width of the half shadow against numpy's rays through the disc."""
    camera, depth, normal, place = taken(size=(160, 90))
    sun = np.array([-0.75, 0.0, 0.66])
    sun /= np.linalg.norm(sun)
    found = shaded(run, camera, depth, normal, direction=tuple(sun), softness=12.0, quality="reference")
    across, up = np.array([0.0, 1.0, 0.0]), np.cross(sun, (0.0, 1.0, 0.0))
    turn, away = np.meshgrid(np.linspace(0, 2 * np.pi, 24, False), np.sqrt((np.arange(12) + 0.5) / 12))
    spread = np.tan(np.radians(6.0)) * away
    ways = sun + spread.ravel()[:, None] * (np.cos(turn).ravel()[:, None] * across + np.sin(turn).ravel()[:, None] * up)
    floor = (normal[..., 2] > 0.5) & (place[..., 2] < 1e-6)
    part = np.mean([~np.isfinite(box(place + 1e-4 * normal, np.broadcast_to(way, place.shape))[0]) for way in ways], 0)
    half = floor & (part > 0.1) & (part < 0.9) & (place[..., 1] > 0.1) & (place[..., 1] < 0.5) & (place[..., 0] > 0.6)
    assert half.sum() > 40
    error = (found - part)[half]
    assert abs(error.mean()) < 0.05 and np.sqrt((error**2).mean()) < 0.1


@pytest.mark.parametrize("turned", [False, True], ids=["rows", "columns"])
def test_soft_shadows_hide_the_period_of_their_noise(run, turned):
    """Below a bar from edge to edge every pixel along it sees the same light: 4 x 4 pixels hold all its directions."""
    width, height = (48, 64) if turned else (64, 48)
    up = (0.0, 1.0, 0.0)
    camera = look_at((0.0, 0.0, 4.0), (0.0, 0.0, 0.0), (1.2, 1.2 * width / height), up)
    way, eye = rays(camera, width, height), np.array([0.0, 0.0, 4.0])
    across = 0 if turned else 1
    top = eye + 3.5 * way
    bar = np.abs(top[..., across]) < 0.3
    depth = np.where(bar, 3.5, 4.0)
    normal = np.broadcast_to((0.0, 0.0, 1.0), (height, width, 3))
    sun = (-0.8, 0.0, 1.0) if turned else (0.0, -0.8, 1.0)
    shadow = shaded(run, camera, depth, normal, direction=sun, softness=40.0, quality="preview")
    lines = shadow.T if turned else shadow
    lines = lines[4:-4, 12:-12]
    half = (lines.mean(1) > 0.1) & (lines.mean(1) < 0.9)
    assert half.sum() > 5
    # Few neighbors differ: by the rank of a direction within its sixteenth, which is blue noise.
    assert (np.diff(lines[half], axis=1) == 0.0).mean() > 0.6


def meet_corner(eye, way):
    """The distance to the nearer of two walls that meet upright, and its normal; the right one leans a little."""
    normals, places = np.array([(0.0, -1.0, 0.0), (-0.997, 0.0, 0.077)]), np.array([-4.0, -1.5])
    away = ((places - normals @ eye) / (way @ normals.T)).astype(float)
    away = np.where(away > 0.0, away, np.inf)
    return away.min(-1), normals[away.argmin(-1)]


@pytest.mark.parametrize("softness", [0.0, 2.0])
@pytest.mark.parametrize("light", ["sun", "lamp"])
def test_a_corner_in_shadow_has_no_bright_line(run, light, softness):
    """Where a wall in shadow meets the one that hides the light, a pixel has some of both: no part of it is lit."""
    width, height, parts, eye = 96, 54, 8, np.array((0.0, 0.0, 1.0))
    camera, sun = look_at(tuple(eye), (0.9, 4.0, 1.1), (1.2, 1.2 * width / height)), np.array([0.62, -0.35, 0.4])
    depth, _ = meet_corner(eye, rays(camera, width, height))
    _, fine = meet_corner(eye, rays(camera, parts * width, parts * height))
    normal = fine.reshape(height, parts, width, parts, 3).mean((1, 3))
    corner = np.linalg.norm(normal, axis=-1) < 0.99
    corner[: height // 6] = False  # from there, rays leave the picture before they are behind the wall
    assert corner.sum() > 40
    lamp = np.array([1.5, 4.0, 1.0]) + 3.0 * sun
    values = {"light": light, "direction": tuple(sun), "position": tuple(lamp), "softness": softness, "length": 6.0}
    found = shaded(run, camera, depth, normal, **values)
    assert found[corner].max() < 0.05


@pytest.mark.parametrize("turn", [0, 45, 90, 135, 200])
def test_a_penumbra_is_as_wide_whichever_way_its_edge_runs(run, turn):
    """A disc of light right above the edge of a board."""
    board = take_board(turn)
    sun = {"direction": (0.0, 0.0, 1.0), "softness": 60.0, "quality": "reference"}
    found = shaded(run, board.camera, board.depth, board.normal, **sun)
    error = measure_errors(board, found, board.place @ board.toward / np.tan(np.radians(30.0)))
    assert abs(error.mean()) < 0.01 and np.sqrt((error**2).mean()) < 0.015
