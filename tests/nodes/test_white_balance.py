"""White balance against the published matrices, tables of black bodies and standard illuminants."""

from __future__ import annotations

import numpy as np
import pytest
from halation.nodes.color.white_balance import WhiteBalance

METHODS = WhiteBalance.values["method"].choices
CONES = {
    "bradford": [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]],
    "cat16": [[0.401288, 0.650173, -0.051461], [-0.250268, 1.204414, 0.045854], [-0.002079, 0.048952, 0.953127]],
}
TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
DUV_OF_D65 = 0.0032

# Robertson's table of the Planckian locus (Wyszecki and Stiles 1982): mired, u, v, slope of the isotherm.
ROBERTSON = [
    (80, 0.18740, 0.28668, -0.40955),
    (100, 0.19032, 0.29326, -0.47888),
    (150, 0.19962, 0.30921, -0.70471),
    (200, 0.21142, 0.32312, -1.0182),
    (250, 0.22511, 0.33439, -1.4512),
    (300, 0.24010, 0.34308, -2.0637),
    (350, 0.25591, 0.34951, -2.9641),
    (400, 0.27218, 0.35407, -4.3633),
]


def xyz(u: float, v: float) -> np.ndarray:
    x, y = 3 * u / (2 * u - 8 * v + 4), 2 * v / (2 * u - 8 * v + 4)
    return np.array([x / y, 1.0, (1 - x - y) / y])


def light_that_becomes_white(run, node: WhiteBalance) -> np.ndarray:
    """Its CIE 1960 uv: what the node, a matrix, turns into equal channels."""
    basis = np.concatenate([np.eye(3), np.ones((3, 1))], -1)[None]
    matrix = run(node, {"image": basis})[0, :, :3].T.astype(np.float64)
    x, y, z = TO_XYZ @ np.linalg.solve(matrix, np.ones(3))
    return np.array([4 * x, 6 * y]) / (x + 15 * y + 3 * z)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("row", ROBERTSON, ids=lambda row: f"{row[0]} mired")
@pytest.mark.parametrize("tint", [-60.0, 0.0, 40.0])
def test_the_light_of_a_black_body_becomes_white(run, method, row, tint):
    """Krystek promises 8e-5, the table has five digits, the Duv of D65 four; tint goes across within 2 degrees."""
    mired, u, v, slope = row
    greener = np.array([1.0, slope]) / np.hypot(1.0, slope) * np.sign(slope)
    expected = np.array([u, v]) + greener * (DUV_OF_D65 + tint / 3000)
    found = light_that_becomes_white(run, WhiteBalance(temperature=1e6 / mired, tint=tint, method=method))
    assert np.hypot(*(found - expected)) < 2e-4 + abs(tint) / 3000 * np.radians(2.0)


@pytest.mark.parametrize(
    ("kelvin", "duv", "x", "y"),
    [
        (2855.5, 0.0, 0.44758, 0.40745),
        (5003.0, 0.0032, 0.34567, 0.35851),
        (5503.0, 0.0033, 0.33243, 0.34744),
        (7504.0, 0.0031, 0.29903, 0.31488),
        (6504.0, 0.0032, 0.31272, 0.32903),
    ],
    ids=["A", "D50", "D55", "D75", "D65"],
)
def test_a_standard_illuminant_becomes_white(run, kelvin, duv, x, y):
    node = WhiteBalance(temperature=kelvin, tint=(duv - DUV_OF_D65) * 3000)
    expected = np.array([4 * x, 6 * y]) / (-2 * x + 12 * y + 3)
    assert np.hypot(*(light_that_becomes_white(run, node) - expected)) < 2e-4


def krystek(t: float) -> np.ndarray:
    u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t)
    v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t)
    return np.array([u, v])


def white(t: float, tint: float) -> np.ndarray:
    along = krystek(t * 1.0001) - krystek(t * 0.9999)
    greener = np.array([-along[1], along[0]]) / np.hypot(*along)
    greener *= np.sign(greener[1])
    return xyz(*(krystek(t) + greener * (0.0032647 + tint / 3000)))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("kelvin", "tint"), [(2000, 0), (3200, 20), (5000, -80), (6504, 50), (12000, 100)])
def test_the_eye_adapts_by_the_published_matrices(run, hdr, method, kelvin, tint):
    picture = hdr(11, 9)
    cones = np.array(CONES[method])
    adapted = np.diag((cones @ white(6504, 0)) / (cones @ white(kelvin, tint)))
    matrix = np.linalg.inv(TO_XYZ) @ np.linalg.inv(cones) @ adapted @ cones @ TO_XYZ
    expected = picture[..., :3].astype(np.float64) @ matrix.T
    out = run(WhiteBalance(temperature=kelvin, tint=tint, method=method), {"image": picture})
    scale = np.maximum(np.abs(picture[..., :3]) @ np.abs(matrix).T, 1e-3)
    assert (np.abs(out[..., :3] - expected) / scale).max() < 2e-5
    np.testing.assert_array_equal(out[..., 3], picture[..., 3])


def test_it_is_linear(run, hdr):
    one, other = hdr(9, 7), hdr(9, 7)[::-1].copy()
    node = WhiteBalance(temperature=3000.0, tint=10.0)
    apart = run(node, {"image": one}) + 2.0 * run(node, {"image": other})
    together = run(node, {"image": one + 2.0 * other})
    assert np.abs(together - apart).max() < 2e-6 * np.abs(apart).max()


def test_higher_is_warmer_and_tint_is_magenta(run):
    gray = np.float32([[[0.18, 0.18, 0.18, 1.0]]])
    warm = run(WhiteBalance(temperature=8000.0), {"image": gray})[0, 0]
    cold = run(WhiteBalance(temperature=4000.0), {"image": gray})[0, 0]
    assert warm[0] > 0.18 > warm[2] and cold[0] < 0.18 < cold[2]
    assert run(WhiteBalance(tint=30.0), {"image": gray})[0, 0, 1] < 0.18


def test_daylight_is_neutral():
    assert WhiteBalance().identity() == "image" and WhiteBalance(method="cat16").identity() == "image"
    assert WhiteBalance(tint=1.0).identity() is None
