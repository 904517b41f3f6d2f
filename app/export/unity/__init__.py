"""A graph as an effect of Unity, which draws looks over what a camera of its Universal Render Pipeline sees.

The folder has what Unity imports: a shader with a pass for each program, scripts in C#, and pixels as text assets.
`assets/unity_pass.cs` runs the passes in Unity's render graph, `assets/unity_numbers.cs` computes their numbers, and
`assets/unity_data.cs` says what is in their file.

- `shaders` writes programs as passes of a shader of Unity.
- `data` writes what runs when, as Unity's own reader of JSON takes it.
- `script` writes the controls of the look, which are what the inspector of Unity shows.
- `files` writes the folder.
"""

from __future__ import annotations
