"""Renders frames of a graph into files.

A job is a `pipeline` of three stages that work on different frames at the same time. While the device renders a frame,
worker threads decode the pictures of the next one (`Runner.start_decoding`) and another thread encodes and writes the
frame before (`write_queue`). Each stage holds a few pictures at most, so memory does not grow with the frame count.

Before anything is rendered, `destinations` decides which outputs go into which files, and refuses what cannot be
written or would overwrite a picture that the graph reads. So a long job does not fail at its end for a reason that was
known at its start.

Every picture carries a header (`header`): the graph, the settings, and the hashes of the files that were read
(`source_files`), but neither a time nor a path of the machine. The same graph and files therefore give the same bytes,
and `provenance` can render the picture again. A key in the header tells whether a file is still what would be written:
`--resume` keeps such files. The key covers the contents of files, not their dates.

Files appear under their names only when they are complete. A video is one file for all frames (`video_writers`), and a
picture that no memory can hold is written by rows while it is rendered (`scanline_writers`).

`job` starts the pipeline, for one graph or for many items; `item_session` is one item on its way through.
`render_job` is a job as a value, which can be sent to another process, and `sweep` renders one graph with many values
onto one sheet.
"""
