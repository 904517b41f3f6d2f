"""Parts of pictures: a region of an output, and pictures that are too large to be made at once.

Both rest on footprints. For a rectangle of its own pixels every operation reads a rectangle of each input, known before
anything runs (`Op.footprint`): the same pixels for a pointwise function, some more on each side for a blur, all of the
picture for a function that may look anywhere. `regions` goes through the passes from the last to the first and finds
which rectangle of each picture is needed. A program with such windows is scheduled like any other; only coordinates are
shifted, so that every pixel gets the same bits as in the whole picture.

The editor shows a region that way when the user has zoomed in (`focus_program`).

A picture may be larger than a texture can be, or all textures larger than the memory that may be used. Then `tiling`
plans it in stages. Pictures that are read anywhere must be whole before their readers begin, and so must small ones
that many tiles would otherwise compute again; each of these is a stage of its own, put together in memory. The outputs
come last. Every stage is cut into tiles as large as fits: the tile is halved until all textures of the passes that one
tile needs, with their overlap, are within the limits. Since the overlap has a fixed width, larger tiles waste less.

Only a few tiles are measured, those in corners, along edges and in the middle: all others need as much as one of these.

`plan_tile` schedules one tile. All tiles of a stage have the same passes and differ in uniforms, so their programs are
compiled once.
"""
