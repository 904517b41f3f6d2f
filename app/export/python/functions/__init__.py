"""What nodes do, as short functions of numpy and scipy.

`halation export --to python` copies those that a graph needs into a script. A function has the name of its node, and
its parameters those of the inputs and values that it reads. It may also ask for `width`, `height` (of the result, in
pixels), `frame` and `rate`, frames per second. A choice that it knows only in part is annotated with the `Literal`s
that it knows. An input that it reads at other frames is a `Clip`, a function of the frame. A function that asks for
`memory` also returns, last, what it wants to be given there in the next frame; in the first one that is None.

Pictures are arrays [height, width, channels]: an Image has four channels (scene-linear, premultiplied), a Field one, a
Vector two or three. A Number is an array [1, 1, 1], so that a value may be a plain number or vary from pixel to pixel.
Lengths are in pixels and angles in radians.

The text is written for readers of a script: no module here is imported by Halation itself.
"""
