"""Second stage: operations are grouped into passes.

Each pass is one draw or dispatch. What it costs is mostly the pictures that it reads and stores, not the arithmetic: a
chain of ten color corrections takes ten reads and ten stores as ten passes, and one of each as one. So passes should
be as large as the device allows.

`fuse` goes over the operations from the last to the first. An operation joins the pass of its reader if nothing else
reads it, if it is not needed as a picture itself, and if the reader wants each of its pixels exactly once: a pointwise
operation does, and so does a reduction. An operation that looks around in a picture cannot have producers in its pass,
because it would compute them once for every neighbor. It may itself be computed within the pass of a pointwise reader
(an inlined gather), if it is light.

Then two rewrites change passes for others that make the same pixels. `recompute` leaves out a pass that is cheap, and
has each of its readers compute it again: that saves a picture. `merge` makes one pass of several that read the same
pictures or each other's: it writes several pictures. `recompute` comes first, since a picture that is not stored needs
no merging.

All of it depends on the structure of a program alone, never on numbers (`Op.without_numbers`). So while a value is
dragged, the passes stay. The order of operations within a pass is that of the program, and fused functions are kept
apart by seams (primitive/settled.glsl), so that a driver cannot round across them: fused and unfused pictures are equal
to the last bit.

What limits a pass: the pictures, tables and uniforms that a device can bind at once, how many pictures it can write,
and how long a driver may take to compile it.

Constants in this folder were compared on the plans of the 68 presets at full size, for the software rasterizer. With
the values below they have 1283 passes, which read 198 and store 122 megapixels in all.
"""
