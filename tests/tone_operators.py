"""The tone operators by the formulas of their papers, in double precision, and pictures to try them on."""

from __future__ import annotations

import cv2
import numpy as np
from halation.nodes.tone.tone_map import ToneMap

WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
LUMINANCE_OPERATORS = (
    "reinhard",
    "reinhard extended",
    "reinhard unsquared",
    "exponential",
    "logarithmic",
    "drago",
)
OPERATORS = ToneMap.values["operator"].choices


def scene(seed: int = 0, low: float = -8.0, high: float = 6.0) -> np.ndarray:
    """Opaque light over many stops around middle gray, from muted to saturated, with a black pixel."""
    random = np.random.default_rng(seed)
    rgb = 0.18 * 2 ** random.uniform(low, high, (40, 50, 1)) * (0.2 + 3 * random.dirichlet([1, 1, 1], (40, 50)))
    rgb[0, 0] = 0.0
    return np.concatenate([rgb, np.ones((40, 50, 1))], -1).astype(np.float32)


def srgb(light: np.ndarray) -> np.ndarray:
    light = np.clip(light, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def statistics(image: np.ndarray) -> dict[str, float]:
    light = image[..., :3].astype(np.float64) @ WEIGHTS
    return {"average": float(np.exp(np.log(1e-5 + light).mean())), "maximum": float(light.max())}


# --- the formulas of the papers ------------------------------------------------------------------------------------


def reinhard(light, average, maximum, key=0.18, bias=0.85):
    scaled = key / average * light
    return scaled / (1 + scaled)


def reinhard_extended(light, average, maximum, key=0.18, bias=0.85):
    scaled, white = key / average * light, key / average * maximum
    return scaled * (1 + scaled / white**2) / (1 + scaled)


def reinhard_unsquared(light, average, maximum, key=0.18, bias=0.85):
    scaled, white = key / average * light, key / average * maximum
    return scaled * (1 + scaled / white) / (1 + scaled)


def exponential(light, average, maximum, key=0.18, bias=0.85):
    return 1 - np.exp(-light / (average / key))


def logarithmic(light, average, maximum, key=0.18, bias=0.85, q=1.0, k=1.0):
    return np.log10(1 + q * light) / np.log10(1 + k * maximum)


def drago(light, average, maximum, key=0.18, bias=0.85):
    """Equation 4 with Ldmax = 100; world luminances are divided by the log-average."""
    world, top = light / average, maximum / average
    slope = np.log(2 + 8 * (world / top) ** (np.log(bias) / np.log(0.5)))
    return 100 * 0.01 / np.log10(top + 1) * np.log(world + 1) / slope


FORMULAS = dict(
    zip(
        LUMINANCE_OPERATORS,
        (reinhard, reinhard_extended, reinhard_unsquared, exponential, logarithmic, drago),
        strict=True,
    )
)


def hill(rgb):
    into = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
    back = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
    v = rgb @ into.T
    return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081) @ back.T


def neutral(rgb):
    """The Khronos specification, with its names."""
    start_compression, desaturation = 0.8 - 0.04, 0.15
    x = rgb.min(-1, keepdims=True)
    rgb = rgb - np.where(x < 0.08, x - 6.25 * x * x, 0.04)
    peak = rgb.max(-1, keepdims=True)
    d = 1 - start_compression
    new_peak = 1 - d * d / (np.maximum(peak, start_compression) + d - start_compression)
    g = 1 - 1 / (desaturation * (peak - new_peak) + 1)
    pressed = rgb * new_peak / np.maximum(peak, 1e-9)
    return np.where(peak < start_compression, rgb, pressed * (1 - g) + new_peak * g)


def hable(rgb):
    def curve(x):
        return (x * (0.15 * x + 0.10 * 0.50) + 0.20 * 0.02) / (x * (0.15 * x + 0.50) + 0.20 * 0.30) - 0.02 / 0.30

    return curve(2 * rgb) / curve(11.2)


PRIMARIES = {
    709: [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
    2020: [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
}


def to_xyz(space: int) -> np.ndarray:
    """The matrix that a color space's chromaticities and white D65 imply."""

    def xyz(chromaticity):
        x, y = chromaticity
        return np.array([x / y, 1.0, (1 - x - y) / y])

    columns = np.stack([xyz(primary) for primary in PRIMARIES[space]], -1)
    return columns * np.linalg.solve(columns, xyz((0.3127, 0.3290)))


def agx(rgb):
    """AgXBaseRec2020.py of Eary Chow's AgX_LUT_Gen: inset, log2, sigmoid, power 2.4, 40 % hue shift, outset."""
    inset = np.array(
        [
            [0.856627153315983, 0.0951212405381588, 0.0482516061458583],
            [0.137318972929847, 0.761241990602591, 0.101439036467562],
            [0.11189821299995, 0.0767994186031903, 0.811302368396859],
        ]
    )
    outset = np.linalg.inv(
        [
            [0.899796955911611, 0.0871996192028351, 0.013003424885555],
            [0.11142098895748, 0.875575586156966, 0.0130034248855548],
            [0.11142098895748, 0.0871996192028349, 0.801379391839686],
        ]
    )
    rec2020 = np.linalg.solve(to_xyz(2020), to_xyz(709))
    scene_referred = rgb @ rec2020.T @ inset.T
    stops = np.clip(np.log2(np.maximum(scene_referred, 1e-10) / 0.18), -10, 6.5)
    x, slope, power = (stops + 10) / 16.5, 2.4, 1.5
    pivot_x, pivot_y = 10 / 16.5, 0.18 ** (1 / 2.4)

    def branch(to_end_x, to_end_y):
        scale = ((slope * to_end_x) ** -power * ((slope * to_end_x / to_end_y) ** power - 1)) ** (-1 / power)
        term = slope * np.abs(x - pivot_x) / scale
        return scale * term / (1 + term**power) ** (1 / power)

    curved = np.where(x < pivot_x, pivot_y - branch(pivot_x, pivot_y), pivot_y + branch(1 - pivot_x, 1 - pivot_y))
    formed = np.maximum(curved, 0) ** 2.4
    before = cv2.cvtColor(scene_referred.astype(np.float32), cv2.COLOR_RGB2HSV)[..., 0] / 360.0
    hsv = cv2.cvtColor(formed.astype(np.float32), cv2.COLOR_RGB2HSV)
    turn = hsv[..., 0] / 360.0 - before
    hsv[..., 0] = (before + 0.4 * (turn - np.round(turn))) % 1.0 * 360.0
    formed = cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB).astype(np.float64)
    return np.clip(formed @ outset.T @ np.linalg.inv(rec2020).T, 0, 1)


def narkowicz(rgb):
    """The article's curve, after the 0.6 that its author says undoes its exposure."""
    x = 0.6 * rgb
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)


def uchimura(x, contrast=1.0):
    """The slides' equations: a linear section from `start` on, a toe of power 1.33, a shoulder up to 1."""
    top, start, share, toe_power = 1.0, 0.22, 0.4, 1.33
    length = (top - start) * share / contrast
    ends, height = start + length, start + contrast * length
    steepness = contrast * top / (top - height)
    t = np.clip(x / start, 0, 1)
    in_toe, in_shoulder = 1 - t * t * (3 - 2 * t), (x >= ends) * 1.0
    toe, linear = start * (x / start) ** toe_power, start + contrast * (x - start)
    shoulder = top - (top - height) * np.exp(-steepness * (x - ends) / top)
    return toe * in_toe + linear * (1 - in_toe - in_shoulder) + shoulder * in_shoulder


def lottes(x, a=1.6, hdr_max=16.0):
    """The slides' equations: contrast a, shoulder d, middle gray in and out; b and c solved from two points."""
    d, mid_in, mid_out = 0.977, 0.18, 0.267
    # mid_in^a = mid_out (mid_in^(a d) b + c) and hdr_max^a = hdr_max^(a d) b + c
    system = np.array([[mid_out * mid_in ** (a * d), mid_out], [hdr_max ** (a * d), 1.0]])
    b, c = np.linalg.solve(system, [mid_in**a, hdr_max**a])
    return x**a / (x ** (a * d) * b + c)


PER_CHANNEL = {
    "aces": hill,
    "aces narkowicz": narkowicz,
    "khronos neutral": neutral,
    "hable": hable,
    "uchimura": uchimura,
    "lottes": lottes,
}
