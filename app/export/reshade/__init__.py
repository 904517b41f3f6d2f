"""A graph as an effect of ReShade, which draws looks over games.

An effect is one text, compiled where the game runs: no program of ours is there. So all that a reader of a package
computes is written as code of ReShade FX:

- `translation` writes a program of the compiler: Slang makes HLSL of it, of which ReShade FX is a dialect.
- `numbers` writes the numbers that controls change as a small picture, drawn anew in each frame.
- `pictures` stores files, tables and lists of numbers in PNG files, which ReShade reads.
- `sources` draws what the game gives: its picture, its depth, and normals made of it.
- `controls` writes what a user changes, `programs` the functions of a pass.
- `parts` collects textures, functions and passes; `effect` puts all together, and `files` writes it.
"""

from __future__ import annotations
