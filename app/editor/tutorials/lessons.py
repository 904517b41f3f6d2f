"""The lessons: what an artist needs in the first hour, on the sample render. Each takes about five minutes."""

from __future__ import annotations

from ...graph import Keys, Port
from .lesson import Lesson, Step, adds, changes, draws, links, selects, shows, undoes
from .moment import Moment, Question

_GLOW = Port("bloom", "intensity")


def _has_keys(count: int) -> Question:
    def is_done(_: Moment, now: Moment) -> bool:
        keys = now.graph.animation.get(_GLOW)
        return isinstance(keys, Keys) and len(keys.frames) >= count

    return is_done


_SELECT_SAMPLE = Step(
    "This node reads a render. Click it: a new node is fed by what is selected.", "title neon", selects("neon")
)

_LOOK = Lesson(
    "first_look",
    "First Look",
    "Nodes, the inspector, the viewer and undo.",
    "soft_bloom",
    (
        Step(
            "Pictures flow through the graph from left to right. Click the node bloom.", "title bloom", selects("bloom")
        ),
        Step(
            "The inspector shows the values of the node. Drag intensity to the right: there is more glow.",
            "field bloom.intensity",
            changes("bloom.intensity"),
        ),
        Step(
            "Move the mouse over the graph and press {node.add}. Type vignette, then Enter. The new node is fed by the"
            " selected one.",
            "Graph",
            adds("vignette"),
        ),
        Step(
            "Positions have handles on the picture. Drag the ring to where the picture should be brightest.",
            "handle vignette.center",
            changes("vignette.center"),
        ),
        Step("Double-click the node bloom: the viewer shows its picture.", "title bloom", shows("bloom")),
        Step(
            "Double-click image, the output of the graph, to see the result again.",
            "title outputs.image",
            shows("outputs"),
        ),
        Step("Every step can be undone. Press {edit.undo}.", "Graph", undoes),
        Step(
            "That is all you need to begin. {file.save} saves the graph, {help.palette} finds every command.", "Viewer"
        ),
    ),
)

_LAYERS = Lesson(
    "layers",
    "Layers of a Render",
    "Depth and other layers of a render make effects that know the scene.",
    "sample",
    (
        Step("This node reads a render. Click it.", "title neon", selects("neon")),
        Step(
            "Its outputs are layers of the render. Click the output depth to see it.",
            "pin out neon.depth",
            shows("neon", "depth"),
        ),
        Step(
            "Press {node.add} over the graph. Type fog, then Enter. Its inputs are linked to the layers of the"
            " same name.",
            "Graph",
            adds("fog"),
        ),
        Step("Double-click fog to see it.", "title fog", shows("fog")),
        Step("Click fog, and drag density.", "field fog.density", changes("fog.density")),
        Step("Other nodes use other layers: try ambient_occlusion, depth_of_field and motion_blur.", "Graph"),
    ),
)

_MASKS = Lesson(
    "masks",
    "Masks",
    "An effect in a part of the picture.",
    "sample",
    (
        _SELECT_SAMPLE,
        Step("Press {node.add} over the graph. Type grade, then Enter.", "Graph", adds("grade")),
        Step("Drag the point of the gain wheel: the whole picture changes.", "wheel grade.gain", changes("grade.gain")),
        Step("Now a mask. Press {node.add} over the graph. Type shape, then Enter.", "Graph", adds("shape")),
        Step(
            "Press Home to see all nodes. Then drag from the output mask of shape to the input mask of grade, at its"
            " upper left corner: only the shape is graded.",
            "pin in grade.mask",
            links("grade.mask"),
        ),
        Step("Click shape, and drag softness: the edge gets soft.", "field shape.softness", changes("shape.softness")),
        Step(
            "Click grade, and turn invert mask on: the rest of the picture is graded.",
            "field grade.invert_mask",
            changes("grade.invert_mask"),
        ),
        Step(
            "Every node that changes a picture has such a mask, and mix, which says how much of it is seen.",
            "Inspector",
        ),
    ),
)

_ANIMATION = Lesson(
    "animation",
    "Animation",
    "Keys, the timeline and curves.",
    "soft_bloom",
    (
        Step(
            "The graph has one frame. Click the last frame, type 24, then Enter.",
            "field timeline last",
            lambda _, now: now.graph.settings.frames == (1, 24),
        ),
        Step("Click the node bloom.", "title bloom", selects("bloom")),
        Step("Click the diamond beside intensity: it sets a key.", "diamond bloom.intensity", _has_keys(1)),
        Step("Click the last frame on the ruler.", "ruler 24", lambda _, now: now.frame == 24),
        Step("Drag intensity: a change at another frame sets another key.", "field bloom.intensity", _has_keys(2)),
        Step("Click the button that plays.", "button time.play", lambda before, now: now.frame != before.frame),
        Step(
            "Press Space to stop. Then click the tab Animation: keys and curves are there.", "Graph", draws("Animation")
        ),
        Step("Drag keys to other frames; Tab switches between keys and curves.", "Animation"),
    ),
)

_CODE = Lesson(
    "own_glsl",
    "Your Own GLSL",
    "A node that you write.",
    "sample",
    (
        _SELECT_SAMPLE,
        Step(
            "Press {node.add} over the graph. Type code, then Enter.", "Graph", lambda _, now: "code" in now.graph.nodes
        ),
        Step("Double-click the node code: the panel shows its GLSL.", "title code", draws("code text")),
        Step(
            "A parameter with a comment is a value. Drag amount in the inspector.",
            "field code.amount",
            changes("code.amount"),
        ),
        Step(
            "Click the code and change it. A moment after the last key, the picture shows what it does.",
            "code text",
            lambda before, now: (
                now.find_type("code") != "" and type(before.graph.nodes["code"]) is not type(now.graph.nodes["code"])
            ),
        ),
        Step(
            "The ? in the panel lists all functions. A file of GLSL that is dropped on the graph is a node too.", "Code"
        ),
    ),
)

LESSONS = (_LOOK, _LAYERS, _MASKS, _ANIMATION, _CODE)
"""All lessons, in their order."""
