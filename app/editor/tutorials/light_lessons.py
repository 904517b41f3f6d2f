"""Lessons about light: its range, the exposure, lamps after the render, and what surfaces hide from each other."""

from __future__ import annotations

from ...authoring.commands import Connect, SetValue
from ...graph import Port
from ..shared.window_commands import PanelTitle
from .conditions import AllHold, IsChosen, IsLinked, IsUpstream, IsWithin
from .lesson import Lesson, Step

_GLOW_FIRST = AllHold((IsUpstream("bloom", of="tone_map"), IsLinked("outputs.image", "tone.out")))

TONE_MAPPING = Lesson(
    "tone_mapping",
    "HDR and Tone Mapping",
    "Tone mapping before the glow kills the glow.",
    "lessons/tone_mapping",
    (
        Step(
            "A render holds light, not codes for a screen. The brightest lamp here has a luminance of 1784, where a "
            "white paper has about 1. 6 % of the pixels are above 1.",
            "Viewer",
            show="scene.color",
        ),
        Step(
            "Tone mapping fits light into what a screen can show, 0 to 1. After it the lamp is 1 too: hardly brighter"
            " than a white wall.",
            "title tone",
            show="tone.out",
        ),
        Step(
            "The glow comes after tone mapping here. It spreads lamps that are only 1 bright: the picture gets misty,"
            " and the lamps hardly shine.",
            "title glow",
            show="outputs.image",
        ),
        Step(
            "Your turn. Put the glow first: link color of scene to image of glow, the output of glow to image of "
            "tone, and the output of tone to the output of the graph.",
            "title glow",
            _GLOW_FIRST,
            solution=(
                Connect(Port("scene", "color"), Port("glow", "image")),
                Connect(Port("glow", "out"), Port("tone", "image")),
                Connect(Port("tone", "out"), Port("outputs", "image")),
            ),
        ),
        Step(
            "Over the dark parts, those below 0.5, there is 3 times as much glow now. The rule: what happens to light"
            " in a lens comes before tone mapping.",
            "Viewer",
        ),
    ),
)

_FOLLOWS_LOGARITHM = IsLinked("eye.luminance", "measure.log_average")

ADAPTATION = Lesson(
    "adaptation",
    "Adaptation",
    "Measure the light before you choose the exposure.",
    "lessons/adaptation",
    (
        Step(
            "Who chooses an exposure measures first. The passes of measure shrink the picture step by step, until one"
            " pixel is left: one number for 129,600 pixels.",
            "Passes",
            show="outputs.image",
            panel=PanelTitle.PASSES,
            marks="reduce",
        ),
        Step(
            "The node eye brings that number to middle gray, 0.18. But the mean is 0.98, because of lamps of up to "
            "1784. So the rest of the picture is too dark.",
            "title measure",
        ),
        Step(
            "Your turn. The mean of the logarithms hardly cares for a few lamps. Link the output log_average of "
            "measure to the input luminance of eye.",
            "pin in eye.luminance",
            _FOLLOWS_LOGARITHM,
            solution=(Connect(Port("measure", "log_average"), Port("eye", "luminance")),),
        ),
        Step(
            "The log average is 0.27. 0.98 is 3.7 times as much, so the picture is 1.9 stops brighter now. Most tone "
            "mapping begins with this number (Reinhard et al. 2002).",
            "Viewer",
        ),
        Step(
            "In an animation the eye follows with a delay: here 0.4 s in more light and 1.2 s in less. A real eye "
            "needs more than half an hour for the dark (Ferwerda et al. 1996).",
            "title eye",
        ),
    ),
)

_FACES, _SWARMS = IsLinked("light.normal", "scene.normal"), IsWithin("light.swarm", 100, 1024)

DEFERRED_LIGHT = Lesson(
    "deferred_light",
    "Deferred Light",
    "Light a picture after it was rendered, from its buffers.",
    "lessons/deferred_light",
    (
        Step("Albedo is the color of the surfaces, without any light.", "Viewer", show="scene.albedo"),
        Step(
            "Position says where each surface is. With the albedo and the normal that is all that a lamp has to know:"
            " no geometry is drawn again (Deering et al. 1988).",
            "Viewer",
            show="scene.position",
        ),
        Step(
            "Your turn. Without normals no lamp can know which way a surface faces, and all is black. Link the output"
            " normal of scene to the input normal of light.",
            "pin in light.normal",
            _FACES,
            show="outputs.image",
            solution=(Connect(Port("scene", "normal"), Port("light", "normal")),),
        ),
        Step(
            "Click light and set swarm to 100: a hundred small lamps.",
            "title light",
            _SWARMS,
            solution=(SetValue(Port("light", "swarm"), 100),),
        ),
        Step(
            "The cost is pixels times lamps, whatever the geometry is. These lamps reach 2.5 units, and pixels that "
            "are farther away leave them out: so a hundred lamps are cheap. Look at the times.",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="deferred_lighting_lit",
        ),
    ),
)

_HALF, _BOUNCES = IsChosen("occlusion.resolution", "half"), IsLinked("outputs.image", "bounce.out")

AMBIENT_OCCLUSION = Lesson(
    "ambient_occlusion",
    "Ambient Occlusion and Indirect Light",
    "How much of the sky a surface sees, and what it sees instead.",
    "lessons/ambient_occlusion",
    (
        Step(
            "Ambient light comes from everywhere, but a corner sees less of it. Depth is enough to tell how much: "
            "each pixel looks at 64 depths around it (Jimenez et al. 2016).",
            "title occlusion",
            show="occlusion.out",
        ),
        Step(
            "Look at the times: nearly all of it is spent in the pass that looks around, ambient_occlusion_horizons.",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="ambient_occlusion_horizons",
        ),
        Step(
            "Your turn. Occlusion is soft, so a quarter of the pixels will do. Click occlusion and set resolution to "
            "half.",
            "title occlusion",
            _HALF,
            solution=(SetValue(Port("occlusion", "resolution"), "half"),),
        ),
        Step(
            "That pass makes 240 x 135 pixels now. The one that enlarges them reads depth too, and mixes only pixels "
            "of the same surface: a plain enlargement would smear the dark of a sphere onto the wall behind.",
            "Passes",
            panel=PanelTitle.PASSES,
            marks="ambient_occlusion_enlarge",
        ),
        Step(
            "Where the sky is hidden it is not black: something hides it, and that has light and color of its own. "
            "This is what neighbors reflect onto each other. Look below the spheres.",
            "title bounce",
            show="bounce.light",
        ),
        Step(
            "The node bounce adds that light. Link its output out to the output of the graph.",
            "title bounce",
            _BOUNCES,
            show="outputs.image",
            solution=(Connect(Port("bounce", "out"), Port("outputs", "image")),),
        ),
        Step(
            "This is one bounce of indirect light (Ritschel et al. 2009). It looks around in the same way, and asks "
            "each place for its color too. Occlusion itself belongs on ambient light only: it has darkened the lamps.",
            "Viewer",
        ),
    ),
)
