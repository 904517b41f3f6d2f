"""Lessons about buffers and filters: what a render holds, sums of neighbors, and how wide sums get cheap."""

from __future__ import annotations

from ...authoring.commands import Connect, SetValue
from ...graph import Port
from ..shared.window_commands import PanelTitle
from .conditions import AllHold, IsChosen, IsLinked
from .lesson import Lesson, Step

_MASKED = IsLinked("gray.mask", "slice.mask")

BUFFERS = Lesson(
    "buffers",
    "Buffers of a Render",
    "A render is more than a picture: its buffers say where surfaces are.",
    "lessons/buffers",
    (
        Step(
            "A renderer can write more than a color for each pixel: how far away the surface is, which way it faces, "
            "how it moves. These pictures of numbers are buffers (Saito and Takahashi 1990).",
            "title scene",
        ),
        Step(
            "This is depth, the distance along the camera's axis. It is data, not light: the viewer scales it from "
            "its least number to its largest.",
            "Viewer",
            show="scene.depth",
        ),
        Step(
            "This is the normal: red, green and blue are x, y and z. Never blur or mix data as if it were color. "
            "Halfway between a near and a far surface there is no surface.",
            "Viewer",
            show="scene.normal",
        ),
        Step(
            "A question to a buffer makes a mask. Here: which surfaces are between 7 and 9.5 units away? 19 % of the "
            "pixels.",
            "title slice",
            show="slice.mask",
        ),
        Step(
            "Your turn. The node gray takes the color from the whole picture. Drag from the output mask of slice to "
            "the input mask of gray.",
            "pin in gray.mask",
            _MASKED,
            show="outputs.image",
            solution=(Connect(Port("slice", "mask"), Port("gray", "mask")),),
        ),
        Step(
            "Only what is that far away is gray. Look at the passes: slice and gray have become one. Both need "
            "nothing but the pixel itself, so nothing has to be written in between.",
            "Passes",
            panel=PanelTitle.PASSES,
        ),
    ),
)

_NORMALIZED = IsChosen("kernel.normalize", "sum")

CONVOLUTION = Lesson(
    "convolution",
    "Convolution",
    "A weighted sum of neighbors: the sum of the weights is the brightness.",
    "lessons/convolution",
    (
        Step(
            "A convolution gives each pixel a weighted sum of its neighbors. The node kernel has 3 x 3 weights, and "
            "all of them are 1.",
            "title kernel",
            show="outputs.image",
        ),
        Step(
            "The sum of the weights is 9. So the picture is 9 times too bright, which is 3.17 stops: the logarithm of"
            " 9 to the base 2.",
            "Viewer",
        ),
        Step(
            "Your turn. Click kernel and set normalize to sum: the weights are divided by their sum, and an even area"
            " keeps its brightness.",
            "title kernel",
            _NORMALIZED,
            solution=(SetValue(Port("kernel", "normalize"), "sum"),),
        ),
        Step(
            "Now it is a small blur. Try other presets. The weights of sharpen add up to 1, so it keeps the "
            "brightness. Those of laplacian 4 add up to 0: even areas turn black, and edges are left.",
            "title kernel",
        ),
        Step(
            "One pass reads 9 pixels for each one that it makes. A blur of 33 x 33 pixels would read 1089. The next "
            "lesson does it with 66.",
            "Passes",
            panel=PanelTitle.PASSES,
        ),
    ),
)

_BOTH_WAYS = AllHold((IsLinked("down.image", "across.out"), IsLinked("outputs.image", "down.out")))

SEPARABLE_BLUR = Lesson(
    "separable_blur",
    "Separable Blur",
    "A wide blur as one pass along rows and one along columns.",
    "lessons/separable_blur",
    (
        Step(
            "A Gaussian blur weighs a neighbor by its distance. exp(-(x² + y²)) is exp(-x²) times exp(-y²): each "
            "weight is a factor for the row times a factor for the column.",
            "title across",
            show="outputs.image",
        ),
        Step(
            "So the sum over a square can be done in two steps. The node across does the first one: its pass sums "
            "along rows only.",
            "Passes",
            panel=PanelTitle.PASSES,
        ),
        Step(
            "Your turn. Link the output of across to the image of down, and the output of down to the output of the "
            "graph.",
            "title down",
            _BOTH_WAYS,
            solution=(
                Connect(Port("across", "out"), Port("down", "image")),
                Connect(Port("down", "out"), Port("outputs", "image")),
            ),
        ),
        Step(
            "The second pass reads what the first has made, and sums along columns. With a square of n x n pixels, "
            "two passes read 2 n pixels instead of n².",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="convolve y",
        ),
        Step(
            "Here sigma is 4 pixels, and the weights reach 16 pixels to each side: 66 reads instead of 1089. With "
            "2160 lines the same blur is eight times as wide, and saves eight times as much.",
            "Passes",
            panel=PanelTitle.PASSES,
        ),
        Step(
            "The node whole blurs both ways at once. Its passes are the same two, and so is its picture: double-click"
            " down and whole to compare.",
            "title whole",
            show="whole.out",
        ),
    ),
)

_ADDS_PYRAMID = IsLinked("sum.a", "pyramid.glow")

BLOOM_PYRAMID = Lesson(
    "bloom_pyramid",
    "Bloom with a Pyramid",
    "A pyramid makes a wide, round glow for the cost of a small one.",
    "lessons/bloom_pyramid",
    (
        Step(
            "Only bright light shall glow. This is what the threshold leaves: the lamps, and their reflections.",
            "title lamps",
            show="lamps.out",
        ),
        Step(
            "A box blur of 81 x 81 pixels. Each small lamp becomes a square: a blur of one size shows the shape of "
            "its filter.",
            "Viewer",
            show="box.out",
        ),
        Step(
            "A pyramid halves the picture again and again, and adds the levels up on the way back. Each pass reads a "
            "few neighbors only, but one pixel of the smallest level is 32 pixels wide.",
            "Passes",
            show="pyramid.glow",
            panel=PanelTitle.PASSES,
            marks="bloom_shrink",
        ),
        Step(
            "1/4 + 1/16 + 1/64 and so on is 1/3: all smaller levels together have a third of the pixels of the "
            "picture. So a wide glow costs hardly more than a narrow one (Jimenez 2014).",
            "Passes",
            panel=PanelTitle.PASSES,
        ),
        Step(
            "Your turn. The node sum still adds the box. Link the output glow of pyramid to the input a of sum.",
            "pin in sum.a",
            _ADDS_PYRAMID,
            show="outputs.image",
            solution=(Connect(Port("pyramid", "glow"), Port("sum", "a")),),
        ),
        Step(
            "The glow is round, strong at the lamp and faint far away, as in a lens: it is a sum of blurs of many "
            "sizes. Click pyramid and change radius: the times of the passes hardly change.",
            "title pyramid",
        ),
    ),
)
