"""Files: pictures as arrays, and arrays as pictures."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .pixels import Array, premultiply_color, srgb_decode, srgb_encode, straight
from .places import fit

CHANNELS = {1: ["Y"], 2: ["X", "Y"], 3: ["X", "Y", "Z"], 4: ["R", "G", "B", "A"]}


def file_of_frame(path: str, frame: int, new: bool = False) -> str:
    """The file of a frame, of names such as shot.####.exr: `new`, or one that exists.

    Where it is missing, it is the last one before it, or else the first of all.
    """
    folder, name = Path(path).parent, Path(path).name
    if "#" not in name or (not new and Path(path).exists()):
        return path

    def number(at: int) -> str:
        return re.sub("#+", lambda marks: f"{at:0{len(marks[0])}}", name)

    if new or (folder / number(frame)).exists():
        return str(folder / number(frame))
    pattern = re.compile("(-?[0-9]+)".join(map(re.escape, re.split("#+", name))))
    found = {int(match[1]): each for each in folder.iterdir() if (match := pattern.fullmatch(each.name))}
    if not found:
        raise SystemExit(f"{path}: there is no such file")
    return str(found[max((at for at in found if at <= frame), default=min(found))])


def read_picture(path: str, layer: str, channels: int, width: int, height: int) -> Array:
    """A picture [height, width, channels] from a .npy or, by OpenImageIO, from any other file.

    Integers are taken as sRGB, floats as scene-linear light. NaN becomes 0.
    """
    if Path(path).suffix == ".npy":
        pixels, names = np.load(path), []
    else:
        pixels, names = read_file(path, layer)
        if channels == 4 and names == ["integers"]:
            pixels = premultiply_color(srgb_decode(straight(pixels)[0]), pixels[..., 3:])
    pixels = np.nan_to_num(np.asarray(pixels, np.float64), nan=0.0, posinf=65504.0, neginf=-65504.0)
    if channels == 4 and pixels.shape[2] < 4:  # gray or without alpha
        color = np.broadcast_to(pixels[..., :3], (*pixels.shape[:2], 3))
        pixels = np.concatenate([color, np.ones_like(color[..., :1])], axis=-1)
    return fit(pixels[..., :channels], width, height, nearest=channels != 4)


def read_file(path: str, layer: str) -> tuple[Array, list[str]]:
    """The pixels of a layer, and ["integers"] if the file holds such."""
    import OpenImageIO as oiio

    part = 0
    while True:
        picture = oiio.ImageBuf(path, part, 0)
        if picture.has_error:
            raise SystemExit(f"{path}: {f'it has no layer {layer!r}' if part else picture.geterror()}")
        names = list(picture.spec().channelnames)
        groups = [name.rpartition(".")[0] for name in names]
        channels = [at for at, group in enumerate(groups) if not layer or group == layer or group.endswith(f".{layer}")]
        if channels:
            break
        part += 1
    order = {name: at for at, name in enumerate("RGBAXYZUV")}
    channels.sort(key=lambda at: order.get(names[at].rpartition(".")[2].upper(), at))
    pixels = np.asarray(picture.get_pixels(oiio.FLOAT, picture.roi_full), np.float64)[..., channels[:4]]
    is_integer = str(picture.spec().format).startswith(("u", "int"))
    if pixels.shape[2] == 3 and is_integer:
        pixels = np.concatenate([pixels, np.ones_like(pixels[..., :1])], axis=-1)
    return pixels, ["integers"] if is_integer else []


def write_picture(path: str, pixels: Array) -> None:
    """Write .npy or .exr as scene-linear light; any other file as sRGB codes, without a view."""
    if Path(path).suffix == ".npy":
        np.save(path, pixels)
        return
    import OpenImageIO as oiio

    if Path(path).suffix != ".exr" and pixels.shape[2] == 4:
        color, alpha = straight(pixels)
        pixels = premultiply_color(srgb_encode(np.clip(color, 0.0, 1.0)), np.clip(alpha, 0.0, 1.0))
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, oiio.FLOAT if Path(path).suffix == ".exr" else oiio.UINT8)
    spec.channelnames = CHANNELS[channels]
    picture = oiio.ImageBuf(spec)
    picture.set_pixels(picture.roi, np.ascontiguousarray(pixels, np.float32))
    if not picture.write(path):
        raise SystemExit(f"{path}: {picture.geterror()}")
