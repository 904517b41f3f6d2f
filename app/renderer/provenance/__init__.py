"""Renders a picture again from its header, and tells whether the result is the same.

The header of a picture that Halation wrote holds the graph, the settings, and the names and hashes of the files that it
read (see `jobs.header`). So a picture can be checked years later, or its graph opened in the editor.

`recipe` reads the header into a `Recipe`. `file_finder` then looks for the files: where the user says, at the path in
the graph, beside the picture, and in folders that the user names. A file counts as the same only if its hash is; in
named folders files are also found by hash under another name. `reproduction` renders the recipe with these files on a
device that is as close as possible to the one of then, and compares. On the same renderer, driver and version all bits
must be equal; if one of these differs, one step of 8 bits is allowed, and the report names the difference.
"""
