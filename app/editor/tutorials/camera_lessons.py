"""Lessons about paths and places: motion blur, warps, depth of field, and lines from geometry."""

from __future__ import annotations

from ...authoring.commands import Connect, SetValue
from ...graph import Port
from ..shared.window_commands import PanelTitle
from .conditions import IsLinked, IsWithin
from .lesson import Lesson, Step

_OPENED, _ORDERED = IsWithin("motion.shutter", 180.0, 720.0), IsLinked("motion.depth", "scene.depth")

MOTION_BLUR = Lesson(
    "motion_blur",
    "Motion Blur",
    "Moving surfaces cover their neighbors: a pixel needs the velocities around it.",
    "lessons/motion_blur",
    (
        Step(
            "Velocity says how many pixels each surface has moved since the frame before. The fastest one here moves "
            "23 pixels.",
            "Viewer",
            show="scene.velocity",
        ),
        Step(
            "Your turn. The shutter is open for no time, so nothing is blurred. Click motion and set shutter to 360 "
            "degrees: open from frame to frame, so that each surface is seen along its whole path.",
            "title motion",
            _OPENED,
            show="outputs.image",
            solution=(SetValue(Port("motion", "shutter"), 360.0),),
        ),
        Step(
            "A resting pixel beside a moving thing is covered by it for a while, though its own velocity is 0. So two"
            " passes find the fastest motion in each tile of 22 x 22 pixels, and one looks at the tiles around it.",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="motion_blur_fastest",
        ),
        Step(
            "The last pass looks along the pixel's own path, and along that of the fastest neighbor. But which of the"
            " two is in front? Link the output depth of scene to the input depth of motion.",
            "pin in motion.depth",
            _ORDERED,
            solution=(Connect(Port("scene", "depth"), Port("motion", "depth")),),
        ),
        Step(
            "What is near now smears over what is far, and not the other way round (McGuire et al. 2012, Guertin et "
            "al. 2014). Two passes more repair the edges of the picture, where a pixel holds two surfaces.",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="motion_blur",
        ),
    ),
)

_WARPED, _DETAILED = IsLinked("warp.vector", "waves.vector"), IsWithin("waves.octaves", 4, 16)

NOISE_AND_WARPS = Lesson(
    "noise_and_warps",
    "Noise and Warps",
    "Noise says where each pixel reads from.",
    "lessons/noise_and_warps",
    (
        Step(
            "A warp does not push pixels around. Each pixel of the result asks from where it reads: so none stays "
            "empty, and none is written twice.",
            "title warp",
            show="outputs.image",
        ),
        Step(
            "Noise is random, but smooth, and the same each time (Perlin 1985). This one has a single octave, with "
            "waves of 60 pixels.",
            "title waves",
            show="waves.out",
        ),
        Step(
            "Your turn. Link the output vector of waves, two noises for x and y, to the input vector of warp.",
            "pin in warp.vector",
            _WARPED,
            show="outputs.image",
            solution=(Connect(Port("waves", "vector"), Port("warp", "vector")),),
        ),
        Step(
            "The waves are wide and soft. Click waves and set octaves to 4: each octave has half the size and half "
            "the strength of the one before.",
            "title waves",
            _DETAILED,
            solution=(SetValue(Port("waves", "octaves"), 4),),
        ),
        Step(
            "1 + 1/2 + 1/4 + 1/8 is 1.875. The noise is divided by that, so its range stays: more octaves add detail,"
            " not distance. This sum is called fBm (Mandelbrot and van Ness 1968).",
            "Viewer",
        ),
    ),
)

_FOCUSED, _OPEN = IsWithin("lens.focus_distance", 7.4, 8.0), IsWithin("lens.f_number", 0.5, 2.0)

DEPTH_OF_FIELD = Lesson(
    "depth_of_field",
    "Depth of Field",
    "A point out of focus becomes a disc: its size follows from the lens.",
    "lessons/depth_of_field",
    (
        Step(
            "A point out of focus becomes a disc, the circle of confusion. Its diameter is f² |d - s| / (N d (s - "
            "f)): focal length f, f-number N, focus s, depth d (Potmesil and Chakravarty 1981).",
            "title lens",
            show="lens.coc",
        ),
        Step(
            "The lens is focused at 4 units, where nothing is. So every surface is blurred a little.",
            "Viewer",
            show="outputs.image",
        ),
        Step(
            "Your turn. The head is 7.7 units away. Click lens and set focus distance to 7.7.",
            "title lens",
            _FOCUSED,
            solution=(SetValue(Port("lens", "focus_distance"), 7.7),),
        ),
        Step(
            "Set the f-number to 1.4. In the formula it is below the line: half of it makes all discs twice as large.",
            "title lens",
            _OPEN,
            solution=(SetValue(Port("lens", "f_number"), 1.4),),
        ),
        Step(
            "What is near is blurred apart from what is far. Discs of near surfaces spread over sharp ones; light "
            "from behind must not. So there are passes for near and for far, at half the size.",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="depth_of_field_near",
        ),
    ),
)

_FOLDS, _INKED = IsLinked("shape_edges.normal", "scene.normal"), IsLinked("inked.factor", "shape_edges.edges")

EDGES_AND_CARTOONS = Lesson(
    "edges_and_cartoons",
    "Edges and Cartoons",
    "Lines from geometry, not from color.",
    "lessons/edges_and_cartoons",
    (
        Step(
            "An edge filter draws a line where the color changes. But shadows, reflections and lamps change the color"
            " too.",
            "title color_edges",
            show="color_edges.magnitude",
        ),
        Step(
            "Depth changes where a surface ends, whatever the light is. These lines are where it jumps by more than 5"
            " percent.",
            "title shape_edges",
            show="shape_edges.edges",
        ),
        Step(
            "Your turn. Link the output normal of scene to the input normal of shape_edges: folds of more than 35 "
            "degrees get lines too.",
            "pin in shape_edges.normal",
            _FOLDS,
            solution=(Connect(Port("scene", "normal"), Port("shape_edges", "normal")),),
        ),
        Step(
            "Now the ink. Link the output edges of shape_edges to the input factor of inked.",
            "pin in inked.factor",
            _INKED,
            show="outputs.image",
            solution=(Connect(Port("shape_edges", "edges"), Port("inked", "factor")),),
        ),
        Step(
            "The node toon gives the tones, in five steps of brightness. Lines from buffers are as old as buffers "
            "(Saito and Takahashi 1990); cartoons of this kind are by Decaudin (1996).",
            "title paint",
        ),
    ),
)
