"""Shows a picture as a game would: in a window, by Vulkan; run on its own by test_export_reshade.

Arguments: the picture as .npy [height, width, 4] of uint8, the picture of the screen that Xvfb keeps as a file, frames
to show, and the .npy to write: [height, width, 3] of uint8, what the screen has then.
"""

from __future__ import annotations

import struct
import sys
import time
from pathlib import Path

import glfw
import numpy as np
import wgpu
from rendercanvas.glfw import RenderCanvas

SHADER = """
@group(0) @binding(0) var picture: texture_2d<f32>;
@vertex fn cover(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32((i << 1u) & 2u), f32(i & 2u)) * 2.0 - 1.0, 0.0, 1.0);
}
@fragment fn show(@builtin(position) p: vec4f) -> @location(0) vec4f { return textureLoad(picture, vec2i(p.xy), 0); }
"""


def read_screen(path: Path) -> np.ndarray:
    """The picture of the screen, in the format of xwd: a header, colors, then rows of four bytes for each pixel."""
    content = path.read_bytes()
    head = struct.unpack(">25I", content[:100])
    width, height, row, colors = head[4], head[5], head[12], head[19]
    begin = head[0] + 12 * colors
    rows = np.frombuffer(content, np.uint8, height * row, begin).reshape(height, row)
    return rows[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]


def show(picture: np.ndarray, screen: Path, frames: int) -> np.ndarray:
    """What the screen has after some frames."""
    height, width = picture.shape[:2]
    glfw.init()
    glfw.window_hint(glfw.DECORATED, False)
    canvas = RenderCanvas(size=(width, height), title="game", update_mode="manual", vsync=False)
    device = wgpu.gpu.request_adapter_sync(canvas=canvas).request_device_sync()
    context = canvas.get_wgpu_context()
    context.configure(device=device, format="bgra8unorm")
    texture = device.create_texture(size=(width, height, 1), format="rgba8unorm", usage="TEXTURE_BINDING|COPY_DST")
    layout = {"bytes_per_row": 4 * width, "rows_per_image": height}
    device.queue.write_texture({"texture": texture}, np.ascontiguousarray(picture), layout, (width, height, 1))
    module = device.create_shader_module(code=SHADER)
    pipeline = device.create_render_pipeline(
        layout="auto",
        vertex={"module": module, "entry_point": "cover"},
        fragment={"module": module, "entry_point": "show", "targets": [{"format": "bgra8unorm"}]},
    )
    entries = [{"binding": 0, "resource": texture.create_view()}]
    group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=entries)

    @canvas.request_draw
    def draw() -> None:
        encoder = device.create_command_encoder()
        view = context.get_current_texture().create_view()  # pyright: ignore[reportAttributeAccessIssue]
        target = {"view": view, "load_op": "clear", "store_op": "store"}
        step = encoder.begin_render_pass(color_attachments=[target])
        step.set_pipeline(pipeline)
        step.set_bind_group(0, group)
        step.draw(3)
        step.end()
        device.queue.submit([encoder.finish()])

    for _ in range(frames):
        canvas.force_draw()
        glfw.poll_events()
    time.sleep(0.5)  # the last frame is on its way to the screen
    x, y = glfw.get_window_pos(canvas._window)  # pyright: ignore[reportArgumentType]
    return read_screen(screen)[y : y + height, x : x + width]


if __name__ == "__main__":
    np.save(sys.argv[4], show(np.load(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])))
