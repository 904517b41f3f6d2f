"""Last stage: passes become a plan, which says everything that a renderer does.

Formats come first: each texture is as narrow as its data allows. Data (depth, normals, ids) keeps 32 bits, a file of
half floats stays half, and color follows the precision that is asked for.

Then each pass gets its program, and each picture its key (`fingerprints`). Equal keys mean equal pixels, so a renderer
may keep any picture by its key and need not make it again. There are no dirty flags: what changed has another key, and
so has all that was made of it.

Textures are shared: a picture lives from the pass that makes it to the last pass that reads it, and after that another
picture of the same size and format can have its texture. Pictures are taken in the order in which they are made, and
each gets a free texture, if there is one, or a new one. For intervals in order of their start this greedy way needs the
fewest textures of each size and format. What a node remembers for the next frame is never overwritten.

`reschedule` makes a plan of a known one where only numbers changed (`differences`): formats, textures and the order of
passes stay. It writes only the passes again whose numbers changed, and finds new keys for what comes after them. That
is what makes dragging a slider in a graph of hundreds of nodes take two milliseconds.
"""
