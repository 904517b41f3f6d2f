"""A small color config of a made-up house, written by hand: spaces, file rules, a look, two displays."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import PyOpenColorIO

OCIO: Any = PyOpenColorIO
"""OpenColorIO, whose compiled module declares no types."""

AP1_TO_AP0 = np.array(
    [
        [0.6954522414, 0.1406786965, 0.1638690622],
        [0.0447945634, 0.8596711185, 0.0955343182],
        [-0.0055258826, 0.0040252103, 1.0015006723],
    ]
)
"""ACEScg to ACES2065-1: Academy, S-2014-004."""
REC709_TO_AP0 = np.array(
    [
        [0.4396329819, 0.3829886982, 0.1773783199],
        [0.0897764430, 0.8134394286, 0.0967841284],
        [0.0175411704, 0.1115465500, 0.8709122797],
    ]
)
"""Rec.709 to ACES2065-1 with Bradford's adaptation, as the Academy's CTL and colour-science have it."""
AP1_TO_REC709 = np.array(
    [
        [1.7050509, -0.6217921, -0.0832589],
        [-0.1302564, 1.1408048, -0.0105483],
        [-0.0240034, -0.1289690, 1.1529723],
    ]
)
"""ACEScg to Rec.709 with Bradford's adaptation (Academy, TB-2018-001 and colour-science)."""
AP1_LUMINANCE = (0.2722287168, 0.6740817658, 0.0536895174)
"""The second row of the matrix from AP1 to XYZ (Academy, S-2014-004)."""


def _matrix(rows: np.ndarray) -> str:
    full = np.eye(4)
    full[:3, :3] = rows
    return ", ".join(f"{number:.10f}" for number in full.ravel())


HOUSE = f"""ocio_profile_version: 2
search_path: luts
roles:
  {{aces_interchange: exchange, scene_linear: house linear, data: numbers, default: numbers, color_timing: house log}}
file_rules:
  - !<Rule> {{name: plates, colorspace: house log, pattern: "*plates*", extension: "*"}}
  - !<Rule> {{name: maps, colorspace: numbers, pattern: "*_map*", extension: "*"}}
  - !<Rule> {{name: textures, colorspace: house texture, regex: ".*/tex/.*[.]png"}}
  - !<Rule> {{name: Default, colorspace: exchange}}
displays:
  Screen:
    - !<View> {{name: Plain, colorspace: house texture}}
    - !<View> {{name: Warm, colorspace: house texture, looks: warm}}
  Projector:
    - !<View> {{name: Dim, colorspace: house dim}}
active_displays: [Screen, Projector]
active_views: []
looks:
  - !<Look> {{name: warm, process_space: house linear, transform: !<CDLTransform> {{slope: [1.2, 1, 0.8]}}}}
colorspaces:
  - !<ColorSpace> {{name: exchange, encoding: scene-linear}}
  - !<ColorSpace>
    name: house linear
    aliases: [lin_ap1]
    encoding: scene-linear
    to_scene_reference: !<MatrixTransform> {{matrix: [{_matrix(AP1_TO_AP0)}]}}
  - !<ColorSpace>
    name: house seven
    encoding: scene-linear
    to_scene_reference: !<MatrixTransform> {{matrix: [{_matrix(REC709_TO_AP0)}]}}
  - !<ColorSpace>
    name: house texture
    encoding: sdr-video
    to_scene_reference: !<GroupTransform>
      children:
        - !<ExponentWithLinearTransform> {{gamma: 2.4, offset: 0.055}}
        - !<MatrixTransform> {{matrix: [{_matrix(REC709_TO_AP0)}]}}
  - !<ColorSpace>
    name: house log
    encoding: log
    to_scene_reference: !<GroupTransform>
      children:
        - !<LogAffineTransform> {{base: 2, log_side_slope: 0.06, log_side_offset: 0.6, direction: inverse}}
        - !<MatrixTransform> {{matrix: [{_matrix(AP1_TO_AP0)}]}}
  - !<ColorSpace>
    name: house dim
    encoding: sdr-video
    to_scene_reference: !<GroupTransform>
      children:
        - !<ExponentTransform> {{value: 2.6}}
        - !<MatrixTransform> {{matrix: [{_matrix(2.0 * REC709_TO_AP0)}]}}
  - !<ColorSpace> {{name: numbers, isdata: true}}
"""


def write_house(folder: Path, name: str = "house.ocio", text: str = HOUSE) -> Path:
    """Write the config into a folder."""
    path = folder / name
    path.write_text(text)
    return path


def read_config(path: Path) -> Any:
    """A config as OpenColorIO reads it."""
    return OCIO.Config.CreateFromFile(str(path))


def through(config: Any, rgb: np.ndarray, *steps: Any) -> np.ndarray:
    """What OpenColorIO's CPU path makes of colors [..., 3]; `steps` are names of two spaces, or transforms."""
    colors = np.array(rgb, np.float32).reshape(-1, 3)
    made = config.getProcessor(*steps)
    made.getOptimizedCPUProcessor(OCIO.OPTIMIZATION_LOSSLESS).applyRGB(colors)
    return colors.reshape(rgb.shape)


@cache
def studio() -> Any:
    """OpenColorIO's own studio config, which nobody changes."""
    return OCIO.Config.CreateFromBuiltinConfig("ocio://studio-config-latest")
