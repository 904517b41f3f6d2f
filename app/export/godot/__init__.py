"""A graph as an effect of Godot, which draws looks over what a camera sees.

The folder is a package with a reader in GDScript, Godot's language: `assets/godot_effect.gd` runs the passes on Godot's
rendering device, and `assets/godot_numbers.gd` computes their numbers.

- `shaders` writes programs as Godot reads them, and finds where they read numbers and pictures.
- `script` writes the controls of the look, which are what the inspector of Godot shows.
- `files` writes the folder.
"""

from __future__ import annotations
