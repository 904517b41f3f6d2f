"""A graph as passes in WGSL, the shading language of WebGPU.

The compiler writes GLSL. `translation` spells a program so that Slang reads it, and finds in Slang's answer where the
program reads its numbers and pictures; `folder` writes the package.
"""

from __future__ import annotations
