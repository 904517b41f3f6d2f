"""The camera of a render, solved from the positions of its pixels, or read from its header.

A place P seen at (u, v) obeys (u d, v d, d) = M (P, 1) for a 3 x 4 matrix M. Without depth, u (M3 P) - M1 P = 0 and
v (M3 P) - M2 P = 0 are linear in M up to its scale: the direct linear transform (Hartley and Zisserman, "Multiple View
Geometry", 2nd edition, 7.1), here weighted by 1 / d so that what is minimal is the distance in the picture. With
planar depth all three rows are least squares of their own.

Renders hold positions that are not surfaces (background, averages at silhouettes), so the solution has three steps: a
sample of pixels that show a surface; those of them that one camera explains (all, or the largest consensus of random
sets); and fits that leave out outliers. Points are first moved around the origin, for numerical precision. A camera
that does not explain half of the picture within a pixel is refused: a wrong camera is worse than none.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Mapping
from typing import TypeGuard

import numpy as np
from halation.nodes import CameraModel, Size
from msgspec import Struct

from ..color.transforms import Array
from ..errors import InputError

SAMPLES = 3000
"""Pixels in the sample, evenly spread. On nine frames of a street by Blender the camera that they give is off by 2e-5
pixels in the median and 3e-4 in the worst of a hundred, which is the precision of floats: more would not help."""

FARTHEST = 1e9
"""Distances from here on are background: renderers write 1e10 (Blender), 1e30 or infinity there."""

_FEWEST_POINTS = 12
"""The fewest points: twice the six that determine a camera, so that it can be checked."""

_CONSENSUS_DRAWS = 160
"""Random sets of six points. If 60 % of the points are good, a set is good with 0.6^6, and 160 sets are all bad in one
of 2000 cases (Fischler and Bolles, 1981)."""

_CONSENSUS_JUDGES = 1500
"""Points that vote on each set: half of the sample, to save time."""

_FIT_ROUNDS = 4
"""Fits without the outliers of the fit before. On those frames the error falls by less than 1 % after the fourth."""

_SLICE_ROWS = 128
"""Rows of one QR decomposition: about ten times the 12 columns, which stays in the caches of a processor."""

_SEED = 20
"""A fixed seed: the same picture gives the same camera."""

_INLIER_PIXELS = 1.0
"""Pixels. A point within this distance is explained: pixel centers alone leave half a pixel open."""

_WORST_MEDIAN_PIXELS = 0.5
"""Pixels. A camera with a larger median error explains nothing."""

_REPORT_MEDIANS = 6.0
_FIT_MEDIANS = 5.0
"""A point that is farther off than so many medians is an outlier of the report, or of a fit. Of errors that are
normally distributed in the plane 2^-25 exceed five medians and 2^-36 six, so noise alone excludes none of the
sample. With a third and with three times as many all tests pass."""

_SMALLEST_LIMIT = 1e-6
"""Pixels. Exact positions in double precision differ by less, and none of them is an outlier."""

_EXPLAINED_SHARE = 0.5
"""Share of the points that a camera must explain: of two cameras that do, both would have points in common."""

_CLEAN_SHARE = 0.9
"""Share of the points that a first fit must explain, so that no consensus is needed: a shortcut that saves time."""

_CONSENSUS_REACH = 1.5
"""Times `_INLIER_PIXELS`. The camera through six points alone is less exact than a fit, so its inliers may be farther
off; the fits that follow are strict again. Chosen by judgement: with 4.5 all tests pass, with 0.45 not."""

_FLAT_DEPTH = 1e-5
"""Change of depth over the spread of the points, relative to the depth, below which there is no perspective: floats of
32 bits have 6e-8, which is 0.6 % of that."""

_SINGULAR = 1e-6
"""Share of the largest singular value below which another one is 0: positions are floats of 32 bits, off by 6e-8."""

_OPEN_RATIO = 0.3
"""Of the two smallest singular values: 0 if one matrix explains all points, 1 if any mixture of two does so as well.
Chosen by judgement: with 0.9 all tests pass, with 0.09 not."""

_TINY = 1e-12
"""A length or a determinant of rows near 1 that is 0 but for the rounding of doubles, which is 2e-16 an operation."""

_FEWEST_REPEATS = 3.0
"""Pixels of a small picture that may share a position whatever their share is. Chosen by judgement: with 9 all tests
pass, with 0.9 not."""

_REPEATED_SHARE = 0.01
"""Share of the pixels. A position that more pixels have is the renderer's mark for the background. Chosen by
judgement."""

_NO_PINHOLE = "no pinhole camera sees these positions where the picture has them"
_MIXER = np.array([1.0, 2.0**0.5, 3.0**0.5])
"""Turns a position into one number, different for different positions: the square roots are linearly independent over
the rationals."""


class CameraSolution(Struct, frozen=True):
    """A camera, and how well it explains the picture.

    `residual` is the median, `worst` the 99th percentile of the distance in pixels between where a place is seen and
    where the camera sees it; `share` is the part of the places that it explains.
    """

    camera: CameraModel
    residual: float
    worst: float
    share: float


class _Correspondences(Struct, frozen=True):
    """Positions, homogeneous, where they are seen as fractions of the picture, and depths if known."""

    points: Array
    image_points: Array
    depths: Array | None
    size: Size

    def select(self, keep: Array) -> _Correspondences:
        return _Correspondences(
            self.points[keep], self.image_points[keep], None if self.depths is None else self.depths[keep], self.size
        )

    def reprojection_error(self, matrix: Array) -> Array:
        """Distances in pixels; infinite behind the camera."""
        projected = self.points @ matrix.T
        with np.errstate(divide="ignore", invalid="ignore"):
            apart = np.hypot(*((projected[:, :2] / projected[:, 2:] - self.image_points) * self.size).T)
        return np.where(projected[:, 2] > 0.0, apart, np.inf)


def solve_camera(position: Array, depth: Array | None = None) -> CameraSolution:
    """The camera of a picture of positions [h, w, 3], with planar depths [h, w] if they are known.

    Background and averages at silhouettes are left out.

    Raises:
        InputError: the rest of a sentence about the picture that says why it has no camera.
    """
    correspondences = _collect_correspondences(np.asarray(position), None if depth is None else np.asarray(depth))
    if len(correspondences.points) < _FEWEST_POINTS:
        raise InputError("too few pixels have a position")
    matrix = _fit_robustly(correspondences.select(_find_inliers(correspondences)))
    error = correspondences.reprojection_error(matrix)
    close = error < max(_INLIER_PIXELS, _REPORT_MEDIANS * float(np.median(error)))
    if float(np.median(error)) > _WORST_MEDIAN_PIXELS or np.count_nonzero(close) < _EXPLAINED_SHARE * len(error):
        raise InputError(_NO_PINHOLE)
    camera = CameraModel(tuple(float(part) for part in matrix.ravel()))
    return CameraSolution(
        camera, float(np.median(error[close])), float(np.percentile(error[close], 99)), float(close.mean())
    )


def measure_camera(camera: CameraModel, position: Array) -> CameraSolution:
    """How well a known camera explains a picture of positions. Raises InputError if there are too few."""
    correspondences = _collect_correspondences(np.asarray(position), None)
    if len(correspondences.points) < _FEWEST_POINTS:
        raise InputError("too few pixels have a position")
    error = correspondences.reprojection_error(np.reshape(camera.rows, (3, 4)))
    finite = error[np.isfinite(error)] if np.isfinite(error).any() else np.array([np.inf])
    share = float((error < _INLIER_PIXELS).mean())
    return CameraSolution(camera, float(np.median(finite)), float(np.percentile(finite, 99)), share)


def sample_pixels(size: Size, samples: int = SAMPLES, margin: int = 0) -> tuple[Array, Array]:
    """Rows and columns of about this many pixels, evenly spread and away from the border."""
    width, height = size
    step = max(1.0, (width * height / samples) ** 0.5)
    across, down = (max(1, round((side - 2 * margin) / step)) for side in size)
    rows, columns = (
        np.unique((margin + (np.arange(count) + 0.5) * (side - 2 * margin) / count).astype(int).clip(0, side - 1))
        for count, side in ((down, height), (across, width))
    )
    grid = np.meshgrid(rows, columns, indexing="ij")
    return grid[0].ravel(), grid[1].ravel()


def find_surface_points(places: Array) -> Array:
    """True where positions [n, 3] are on a surface: finite, not zero, and not shared by many pixels."""
    with np.errstate(invalid="ignore"):
        good = (np.abs(places) < FARTHEST).all(axis=1) & (places != 0.0).any(axis=1)
    if good.any():
        mixed = places[good] @ _MIXER
        _, groups, counts = np.unique(mixed, return_inverse=True, return_counts=True)
        good[good] = counts[groups] <= max(_FEWEST_REPEATS, _REPEATED_SHARE * len(places))
    return good


def _collect_correspondences(position: Array, depth: Array | None) -> _Correspondences:
    """A sample of the pixels that show a surface."""
    size = (position.shape[1], position.shape[0])
    rows, columns = sample_pixels(size)
    places = position[rows, columns, :3].astype(np.float64)
    keep = find_surface_points(places)
    depths = None
    if depth is not None:
        depths = depth[rows, columns].astype(np.float64).reshape(-1)
        with np.errstate(invalid="ignore"):
            keep &= (depths > 0.0) & (depths < FARTHEST)
        depths = depths[keep]
    at = (np.stack([columns, rows], axis=1) + 0.5) / size
    return _Correspondences(np.pad(places[keep], ((0, 0), (0, 1)), constant_values=1.0), at[keep], depths, size)


def _fit_robustly(correspondences: _Correspondences) -> Array:
    """The matrix with the least error, fitted repeatedly without outliers."""
    if len(correspondences.points) < _FEWEST_POINTS:
        raise InputError(_NO_PINHOLE)
    weights = np.ones(len(correspondences.points))
    matrix, inliers = np.empty((3, 4)), correspondences
    for _ in range(_FIT_ROUNDS):
        matrix = _fit_linearly(inliers, weights)
        error = correspondences.reprojection_error(matrix)
        limit = max(_SMALLEST_LIMIT, _FIT_MEDIANS * float(np.median(error)))
        keep = error <= limit
        if not np.isfinite(limit) or np.count_nonzero(keep) < _FEWEST_POINTS:
            break
        inliers = correspondences.select(keep)
        weights = 1.0 / (inliers.points @ matrix[2])
    return matrix


def _fit_linearly(correspondences: _Correspondences, weights: Array) -> Array:
    """The least-squares matrix; its third row has unit length, so that d is in world units."""
    middle = correspondences.points[:, :3].mean(axis=0)
    spread = float(correspondences.points[:, :3].std()) or 1.0
    shift = _normalizing_matrix(middle, spread)
    places = correspondences.points @ shift.T
    at = 2.0 * correspondences.image_points - 1.0
    solved = (
        _solve_without_depth(places, at, weights)
        if correspondences.depths is None
        else _solve_with_depth(places, at, correspondences.depths)
    )
    matrix = np.array([[0.5, 0.0, 0.5], [0.0, 0.5, 0.5], [0.0, 0.0, 1.0]]) @ solved @ shift
    length = float(np.linalg.norm(matrix[2, :3]))
    if length * spread < _FLAT_DEPTH * abs(float(matrix[2] @ np.append(middle, 1.0))):
        raise InputError("the picture has no perspective: its camera is orthographic, or everything is far away")
    ahead = float(np.median(correspondences.points @ matrix[2]))
    return matrix / (length if ahead > 0.0 else -length)


def _solve_without_depth(places: Array, at: Array, weights: Array) -> Array:
    """Without depth: the direction in which the equations of all pixels are closest to zero."""
    _, sizes, rows = np.linalg.svd(_reduce_rows(_make_equations(places * weights[:, None], at)))
    if sizes[-2] < _SINGULAR * sizes[0] or sizes[-1] > _OPEN_RATIO * sizes[-2]:
        raise InputError("the positions lie in one plane, or are too coarse, which leaves the camera open")
    return rows[-1].reshape(3, 4)


def _reduce_rows(rows: Array) -> Array:
    """R of the QR decomposition of many rows, slice by slice: for all at once, threads cost more than they save."""
    while len(rows) > 2 * _SLICE_ROWS:
        slices = np.pad(rows, ((0, -len(rows) % _SLICE_ROWS), (0, 0))).reshape(-1, _SLICE_ROWS, rows.shape[1])
        rows = np.asarray(np.linalg.qr(slices, mode="r")).reshape(-1, rows.shape[1])
    return np.asarray(np.linalg.qr(rows, mode="r"))


def _solve_with_depth(places: Array, at: Array, depths: Array) -> Array:
    sides = np.concatenate([at, np.ones((len(at), 1))], axis=1)
    rows, _, rank, sizes = np.linalg.lstsq(places / depths[:, None], sides, rcond=None)
    if rank < 4 or sizes[-1] < _SINGULAR * sizes[0]:
        raise InputError("the positions lie in one plane, which leaves the camera open")
    return rows.T


def _make_equations(places: Array, at: Array) -> Array:
    """Two rows per pixel, [..., 2 n, 12]."""
    zero = np.zeros_like(places)
    across = np.concatenate([places, zero, -at[..., :1] * places], axis=-1)
    down = np.concatenate([zero, places, -at[..., 1:] * places], axis=-1)
    return np.concatenate([across, down], axis=-2)


def _find_inliers(correspondences: _Correspondences) -> Array:
    """True for positions that one camera sees: all if a first fit is good, else the largest consensus."""
    with contextlib.suppress(InputError):
        good = (
            correspondences.reprojection_error(_fit_linearly(correspondences, np.ones(len(correspondences.points))))
            < _INLIER_PIXELS
        )
        if np.count_nonzero(good) > _CLEAN_SHARE * len(good):
            return good
    return correspondences.reprojection_error(_fit_by_consensus(correspondences)) < _CONSENSUS_REACH * _INLIER_PIXELS


def _fit_by_consensus(correspondences: _Correspondences) -> Array:
    """The matrix through six positions with the largest consensus (Fischler and Bolles, 1981)."""
    random = np.random.default_rng(_SEED)
    draws = random.integers(0, len(correspondences.points), (_CONSENSUS_DRAWS, 6))
    middle = np.median(correspondences.points[:, :3], axis=0)
    spread = float(np.median(np.abs(correspondences.points[:, :3] - middle))) or 1.0
    shift = _normalizing_matrix(middle, spread)
    _, _, rows = np.linalg.svd(
        _make_equations(correspondences.points[draws] @ shift.T, correspondences.image_points[draws])
    )
    judges = correspondences.select(random.permutation(len(correspondences.points))[:_CONSENSUS_JUDGES])
    best, most = np.eye(3, 4), -1
    for row in rows[:, -1]:
        matrix = row.reshape(3, 4) @ shift
        matrix *= np.sign(np.median(judges.points @ matrix[2])) or 1.0
        count = int(np.count_nonzero(judges.reprojection_error(matrix) < _INLIER_PIXELS))
        if count > most:
            best, most = matrix, count
    return best


def _normalizing_matrix(middle: Array, spread: float) -> Array:
    """The 4 x 4 matrix that moves positions around the origin, for numerical precision."""
    return np.diag([1.0 / spread] * 3 + [1.0]) @ np.concatenate(
        [np.eye(4, 3), np.append(-middle, 1.0)[:, None]], axis=1
    )


def read_header_camera(attributes: Mapping[str, object], size: Size) -> CameraModel | None:
    """The camera that the header names: `worldToNDC` or `worldToScreen`, else `worldToCamera` and `screenWindowWidth`.

    OpenEXR does not define whether such coordinates go from 0 to 1, downward, or from -1 to 1, upward. The place where
    the camera's axis meets the picture tells: 0.5 or 0.
    """
    matrices = {name.casefold(): _parse_matrix(value) for name, value in attributes.items()}
    for name in ("worldtondc", "worldtoscreen"):
        if (matrix := matrices.get(name)) is not None and (camera := _from_projection(matrix)) is not None:
            return camera
    matrix, window = matrices.get("worldtocamera"), attributes.get("screenWindowWidth", 1.0)
    if matrix is None or not _is_finite(window) or window in (0.0, 1.0):
        return None  # writers that do not know it write 1
    pixel = attributes.get("PixelAspectRatio", 1.0)
    aspect = size[0] / size[1] * (pixel if _is_finite(pixel) and pixel > 0.0 else 1.0)
    return _from_placement(matrix, float(window), aspect)


def _parse_matrix(value: object) -> Array | None:
    """16 numbers for row vectors, as in Imath, as a matrix for column vectors."""
    if not isinstance(value, tuple) or len(value) != 16 or not all(map(_is_finite, value)):
        return None
    return np.array(value, np.float64).reshape(4, 4).T


def _is_finite(value: object) -> TypeGuard[float]:
    """True for a finite number: a damaged header may hold a text instead."""
    return isinstance(value, int | float) and math.isfinite(value)


def _from_projection(matrix: Array) -> CameraModel | None:
    """The camera of a projection of the world; None if it has no perspective."""
    rows = matrix[[0, 1, 3]]
    length = float(np.linalg.norm(rows[2, :3]))
    if length < _TINY:
        return None
    rows = rows / length
    center = rows[:2, :3] @ rows[2, :3]
    if np.abs(center).max() < np.abs(center - 0.5).max():
        rows = np.array([[0.5, 0.0, 0.5], [0.0, -0.5, 0.5], [0.0, 0.0, 1.0]]) @ rows
    return _make_camera(rows)


def _from_placement(matrix: Array, window: float, aspect: float) -> CameraModel | None:
    """The camera from its position, and the width of the picture at distance 1. Left-handed cameras look along +z."""
    length = float(np.linalg.norm(matrix[2, :3]))
    if length < _TINY:
        return None
    axes = matrix[:3] / length
    ahead = axes[2] if np.linalg.det(axes[:, :3]) < 0.0 else -axes[2]
    return _make_camera(np.stack([axes[0] / window + 0.5 * ahead, -axes[1] * aspect / window + 0.5 * ahead, ahead]))


def _make_camera(rows: Array) -> CameraModel | None:
    """The camera with these rows; None if they are linearly dependent, so that nothing is visible."""
    if abs(np.linalg.det(rows[:, :3])) < _TINY:
        return None
    return CameraModel(tuple(float(part) for part in rows.ravel()))
