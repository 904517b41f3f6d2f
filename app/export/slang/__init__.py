"""The compiler Slang: `compiler` calls it, `source` spells a program of GLSL so that it is read."""

from __future__ import annotations
