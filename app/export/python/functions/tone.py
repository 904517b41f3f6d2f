"""Tone mapping, and color in other spaces."""

from __future__ import annotations

import numpy as np

from .color import curve_at
from .pixels import Array, join, largest, luminance_of, mix, premultiply_color, smallest, smoothstep, straight


def hue_of(color: Array) -> Array:
    """Hue as a part of a turn: red 0, green 1/3, blue 2/3. Grays have hue 0."""
    red, green, blue = color[..., 0:1], color[..., 1:2], color[..., 2:3]
    high, spread = largest(color), largest(color) - smallest(color)
    safe = np.where(spread > 0.0, spread, 1.0)
    sixth = np.where(high == green, 2.0 + (blue - red) / safe, 4.0 + (red - green) / safe)
    sixth = np.where(high == red, (green - blue) / safe, sixth)
    return np.where(spread > 0.0, (sixth / 6.0) % 1.0, 0.0)


def with_hue(color: Array, hue: Array) -> Array:
    """The color with another hue; its largest and smallest channel stay."""
    share = np.clip(np.abs(((hue + np.array([0.0, 2.0, 1.0]) / 3.0) % 1.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0)
    return mix(smallest(color), largest(color), share)


# The matrices of AgX (Troy Sobotka, 2022) in Eary Chow's Rec.2020 version, as Blender 4 and 5 have it.
REC709_TO_REC2020 = np.array(
    [
        [0.627403896, 0.329283038, 0.043313066],
        [0.069097289, 0.919540395, 0.011362316],
        [0.016391439, 0.088013308, 0.895595253],
    ]
)
AGX_INSET = np.array(
    [
        [0.856627153, 0.095121241, 0.048251606],
        [0.137318973, 0.761241991, 0.101439036],
        [0.111898213, 0.076799419, 0.811302368],
    ]
)
AGX_OUTSET = np.array(
    [
        [1.127100582, -0.110606643, -0.016493939],
        [-0.141329763, 1.157823702, -0.016493939],
        [-0.141329763, -0.110606643, 1.251936407],
    ]
)


def agx(color: Array) -> Array:
    """AgX (Troy Sobotka 2022), in Eary Chow's Rec.2020 version, as in Blender.

    10 stops below and 6.5 above middle gray are bent by Jed Smith's sigmoid; 60 % of the shift of the hue is undone.
    """
    pivot, gray, slope = 10.0 / 16.5, 0.18 ** (1.0 / 2.4), 2.4
    scene = np.maximum(color @ REC709_TO_REC2020.T, 0.0) @ AGX_INSET.T
    x = (np.clip(np.log2(np.maximum(scene, 1e-10) / 0.18), -10.0, 6.5) + 10.0) / 16.5
    reach = np.where(x < pivot, 0.565675607, 0.715198286)  # so that the curve ends at 0 and 1
    u = slope * (x - pivot) / reach
    formed = np.maximum(gray + reach * u / (1.0 + np.abs(u) ** 1.5) ** (1.0 / 1.5), 0.0) ** 2.4
    shift = hue_of(formed) - hue_of(scene)
    formed = with_hue(formed, hue_of(scene) + 0.4 * (shift - np.round(shift)))
    return np.clip(formed @ AGX_OUTSET.T @ np.linalg.inv(REC709_TO_REC2020).T, 0.0, 1.0)


def aces(color: Array) -> Array:
    """The RRT and sRGB ODT of ACES (fit by Stephen Hill 2015)."""
    into = np.array([[0.59719, 0.35458, 0.04823], [0.076, 0.90834, 0.01566], [0.0284, 0.13383, 0.83777]])
    back = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
    v = color @ into.T
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return v @ back.T


def aces_narkowicz(color: Array) -> Array:
    """The ACES fit of Krzysztof Narkowicz (2015), with the exposure of ACES."""
    x = 0.6 * color
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)


def khronos_neutral(color: Array) -> Array:
    """Khronos PBR Neutral (2024): subtract the Fresnel reflection, compress above 0.8, fade the brightest to white."""
    start, low = 0.8 - 0.04, smallest(color)
    color = color - np.where(low < 0.08, low - 6.25 * low * low, 0.04)
    peak = largest(color)
    safe = np.maximum(peak, start)
    compressed = 1.0 - (1.0 - start) ** 2 / (safe + 1.0 - start - start)
    fade = 1.0 - 1.0 / (0.15 * (safe - compressed) + 1.0)
    return np.where(peak < start, color, mix(color * compressed / safe, compressed, fade))


def hable(color: Array) -> Array:
    """John Hable (2010), Uncharted 2, with white at 11.2."""

    def curve(x: Array | float) -> Array | float:
        return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3

    return np.asarray(curve(2.0 * color) / curve(11.2))


def uchimura(x: Array, slope: Array | float) -> Array:
    """Hajime Uchimura (2017), Gran Turismo: a toe, a straight line and a shoulder, joined smoothly."""
    middle, share, tightness = 0.22, 0.4, 1.33
    span = (1.0 - middle) * share / slope
    end, shown = middle + span, middle + slope * span
    line = middle + slope * (x - middle)
    toe = mix(middle * (np.maximum(x, 1e-12) / middle) ** tightness, line, smoothstep(0.0, middle, x))
    shoulder = 1.0 - (1.0 - shown) * np.exp(-slope / (1.0 - shown) * np.maximum(x - end, 0.0))
    return np.where(x >= end, shoulder, np.where(x >= middle, line, toe))


def lottes(x: Array, contrast: Array | float, white: Array | float) -> Array:
    """Timothy Lottes (2016): x^a / (b x^(a d) + c), with 0.18 at 0.267 and white at 1."""
    gray, shown = 0.18, 0.267
    a = 1.6 * contrast
    d = a * 0.977
    white = np.maximum(white, 2.0 * gray)
    span = (white**d - gray**d) * shown
    b = (white**a * shown - gray**a) / span
    c = (white**d * gray**a - white**a * gray**d * shown) / span
    x = np.maximum(x, 1e-12)
    return x**a / (b * x**d + c)


def natural_key(nits: Array | float) -> Array:
    """The middle gray that suits a scene of this luminance in cd/m2 (Krawczyk et al. 2005)."""
    return 1.03 - 2.0 / (2.0 + np.log10(np.maximum(nits, 0.0) + 1.0))


def tone_luminance(
    operator: str,
    light: Array,
    key: Array | float,
    average: Array | float,
    maximum: Array | float,
    bias: Array | float,
    q: Array | float,
    k: Array | float,
) -> Array:
    """Display luminance: Reinhard et al. 2002, exponential, logarithmic, Drago et al. 2003."""
    keyed, white = light * key / average, maximum * key / average
    if operator == "reinhard":
        return keyed / (1.0 + keyed)
    if operator == "reinhard extended":
        return keyed * (1.0 + keyed / white**2) / (1.0 + keyed)
    if operator == "reinhard unsquared":
        return keyed * (1.0 + keyed / white) / (1.0 + keyed)
    if operator == "exponential":
        return 1.0 - np.exp(-keyed)
    if operator == "logarithmic":
        return np.log(1.0 + q * light) / np.log(1.0 + k * maximum)
    base = 2.0 + 8.0 * (light / maximum) ** (np.log(bias) / np.log(0.5))
    return np.log(light / average + 1.0) / np.log(base) / np.log10(maximum / average + 1.0)


BY_CHANNEL = {
    "aces": lambda color, contrast, white: aces(color),
    "aces narkowicz": lambda color, contrast, white: aces_narkowicz(color),
    "agx": lambda color, contrast, white: agx(color),
    "khronos neutral": lambda color, contrast, white: khronos_neutral(color),
    "hable": lambda color, contrast, white: hable(color),
    "uchimura": lambda color, contrast, white: uchimura(color, contrast),
    "lottes": lambda color, contrast, white: lottes(color, contrast, white),
}
"""The operators that map each channel; all others map the luminance."""


def tone_map(
    image: Array,
    operator: str,
    exposure: Array | float,
    key: Array | float,
    auto_key: bool,
    nits: Array | float,
    average: Array | float,
    maximum: Array | float,
    bias: Array | float,
    q: Array | float,
    k: Array | float,
    contrast: Array | float,
    saturation: Array | float,
    clip: bool,
) -> Array:
    """Compress scene light to the display-linear light that a display can show."""
    color, alpha = straight(image)
    color = np.minimum(np.maximum(color, 0.0) * np.exp2(exposure), 1e9)
    average, maximum = np.maximum(average, 1e-9), np.maximum(maximum, 1e-9)
    if operator in BY_CHANNEL:
        shown = BY_CHANNEL[operator](color, contrast, maximum)
    else:  # these map luminance and keep the ratios of the channels
        light = np.maximum(luminance_of(color), 1e-12)
        if auto_key:
            key = natural_key(average * nits)
        ratios = np.maximum(color / light, 1e-12) ** saturation
        shown = tone_luminance(operator, light, key, average, maximum, bias, q, k) * ratios
    return premultiply_color(np.clip(shown, 0.0, 1.0) if clip else shown, alpha)


def cone_response(kelvin: Array | float, tint: Array | float, to_cones: Array) -> Array:
    """The response of the cones to a black body, which `tint` moves toward green or magenta.

    Krystek's polynomials (1985) give its place in CIE 1960 uv; the offset moves the locus through D65.
    """
    powers = [1.0, kelvin, np.square(kelvin)]
    rising = [0.0, 1.0, 2.0 * np.asarray(kelvin)]
    tables = (
        ((0.860117757, 1.54118254e-4, 1.28641212e-7), (1.0, 8.42420235e-4, 7.08145163e-7)),
        ((0.317398726, 4.22806245e-5, 4.20481691e-8), (1.0, -2.89741816e-5, 1.61456053e-7)),
    )
    place, along = [], []
    for over, under in tables:
        top, bottom = (sum(a * b for a, b in zip(powers, row, strict=True)) for row in (over, under))
        top_slope, bottom_slope = (sum(a * b for a, b in zip(rising, row, strict=True)) for row in (over, under))
        place.append(top / bottom)
        along.append((top_slope - top / bottom * bottom_slope) / bottom)
    size, side = np.hypot(*along), np.sign(-along[0])
    away = 0.0032647 + tint / 3000.0  # the distance of D65 from the locus
    u = place[0] + along[1] * side / size * away
    v = place[1] - along[0] * side / size * away
    x, y = 3.0 * u / (2.0 * u - 8.0 * v + 4.0), 2.0 * v / (2.0 * u - 8.0 * v + 4.0)
    xyz = np.stack(np.broadcast_arrays(x / y, 1.0, (1.0 - x - y) / y), axis=-1)
    return xyz @ to_cones.T


def white_balance(image: Array, temperature: float, tint: float, method: str) -> Array:
    """Make light of this color white: von Kries adaptation in the cones of Bradford (Lam 1985) or CAT16 (Li 2017)."""
    to_cones = {
        "bradford": np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]),
        "cat16": np.array(
            [[0.401288, 0.650173, -0.051461], [-0.250268, 1.204414, 0.045854], [-0.002079, 0.048952, 0.953127]]
        ),
    }[method]
    to_xyz = np.array(
        [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
    )
    lit = np.maximum(cone_response(min(max(temperature, 1667.0), 15000.0), tint, to_cones), 0.02)
    white = cone_response(6504.0, 0.0, to_cones)
    from_rgb = to_cones @ to_xyz
    matrix = np.linalg.inv(from_rgb) @ np.diag(np.ravel(white / lit)) @ from_rgb
    return join(image[..., :3] @ matrix.T, image[..., 3:])


TO_CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
TO_LAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)


def to_oklab(color: Array) -> Array:
    """OKLab (Ottosson 2020): lightness, red-green and yellow-blue."""
    return np.cbrt(color @ TO_CONES.T) @ TO_LAB.T


def from_oklab(lab: Array) -> Array:
    """The inverse of `to_oklab`."""
    return (lab @ np.linalg.inv(TO_LAB).T) ** 3 @ np.linalg.inv(TO_CONES).T


def rotate_hue(lab: Array, angle: Array | float, factor: Array | float) -> Array:
    """OKLab with the hue rotated by `angle` radians and the chroma scaled."""
    lightness, a, b = lab[..., 0:1], lab[..., 1:2], lab[..., 2:3]
    cos, sin = np.cos(angle), np.sin(angle)
    return np.concatenate([lightness, factor * (cos * a - sin * b), factor * (sin * a + cos * b)], axis=-1)


def hue_saturation(
    image: Array, mode: str, hue: Array | float, saturation: Array | float, value: Array | float
) -> Array:
    """Rotate hues and scale colors: in OKLab, around the gray axis (Haeberli 1993), or as HSV (Smith 1978)."""
    color = image[..., :3]
    if mode == "perceptual":
        changed = from_oklab(rotate_hue(to_oklab(color), hue, saturation))
    elif mode == "luminance":  # Rodrigues' rotation around the gray axis, then gray so that the luminance stays
        gray = np.full(3, np.sqrt(1.0 / 3.0))
        along = gray * (color * gray).sum(axis=-1, keepdims=True)
        rotated = color * np.cos(hue) + np.cross(gray, color) * np.sin(hue) + along * (1.0 - np.cos(hue))
        rotated = rotated + luminance_of(color) - luminance_of(rotated)
        changed = mix(luminance_of(color), rotated, saturation)
    else:  # saturation is limited to where the smallest channel becomes 0
        high, spread = largest(color), largest(color) - smallest(color)
        strongest = np.where(spread > 0.0, np.maximum(high / np.where(spread > 0.0, spread, 1.0), 1.0), 1.0)
        rotated = with_hue(color, hue_of(color) + hue / (2.0 * np.pi))
        changed = mix(high, rotated, np.minimum(saturation, strongest))
    return join(changed * value, image[..., 3:])


def hue_curves(
    image: Array,
    hue_by_hue: tuple[float, ...],
    saturation_by_hue: tuple[float, ...],
    light_by_hue: tuple[float, ...],
    saturation_by_saturation: tuple[float, ...],
) -> Array:
    """Change the hue, saturation or brightness of some hues only: curves over the hue of HSV, changes in OKLab."""
    positive = np.maximum(image[..., :3], 0.0)
    most, span = largest(positive), largest(positive) - smallest(positive)
    gray = (span <= 1e-6 * most) | (most <= 0.0)
    hue = np.where(gray, 0.0, hue_of(positive))
    saturation = np.where(gray, 0.0, span / np.where(gray, 1.0, most))
    angle = 2.0 * np.pi * saturation * curve_at(hue_by_hue, hue)
    factor = mix(1.0, curve_at(saturation_by_hue, hue), saturation)
    factor = factor * curve_at(saturation_by_saturation, saturation)
    light = mix(1.0, curve_at(light_by_hue, hue), saturation)
    return join(light * from_oklab(rotate_hue(to_oklab(image[..., :3]), angle, factor)), image[..., 3:])


def over_exposure(
    image: Array, stops: Array | float, white: Array | float, shoulder: Array | float, bleach: Array | float
) -> Array:
    """Overexpose: the brightest channel is compressed exponentially toward white, and lost light bleaches the color."""
    color, alpha = straight(image)
    color = np.minimum(color * np.exp2(stops), 1e9)
    peak, start = largest(color), np.multiply(white, 1.0 - np.asarray(shoulder))
    room = np.maximum(white - start, 1e-12)
    above = np.maximum(peak - start, 0.0)
    held = np.where(room > 1e-6 * white, start + room * (1.0 - np.exp(-above / room)), white)
    safe = np.where(peak > start, peak, 1.0)
    lost = bleach * (peak - held) / white
    fade = lost / (1.0 + lost)
    shown = (1.0 - fade) * color * (held / safe) + fade * held
    return premultiply_color(np.where(peak <= start, color, shown), alpha)


def photoreceptor_tone_map(
    image: Array,
    brightness: float,
    contrast: float,
    light_adaptation: float,
    color_adaptation: float,
    stretch: bool,
) -> Array:
    """V = C / (C + (f Ia)^m), where Ia is the light to which a cell has adapted (Reinhard and Devlin 2005)."""
    color, alpha = straight(image)
    weight = np.where(alpha > 1e-6, alpha, 0.0)
    lit = np.maximum(color, 0.0)
    logs = np.log(np.maximum(luminance_of(lit), 1e-4))
    counted = logs[weight > 0.0]
    if not counted.size:
        return image
    mean = (weight * lit).sum(axis=(0, 1)) / weight.sum()
    span = counted.max() - counted.min()
    key = np.clip((counted.max() - (weight * logs).sum() / weight.sum()) / span, 0.0, 1.0) if span > 0.0 else 0.0
    power = contrast if contrast > 0.0 else 0.3 + 0.7 * key**1.4
    own = mix(luminance_of(lit), lit, color_adaptation)
    others = mix(luminance_of(mean), mean, color_adaptation)
    adapted = np.exp(-brightness) * mix(others, own, light_adaptation)
    shown = lit / np.maximum(lit + np.maximum(adapted, 1e-12) ** power, 1e-12)
    if stretch:
        seen = shown[weight[..., 0] > 0.0]
        low, high = seen.min(), seen.max()
        if high - low > 1e-6:
            shown = np.clip((shown - low) / (high - low), 0.0, 1.0)
    return premultiply_color(shown, alpha)
