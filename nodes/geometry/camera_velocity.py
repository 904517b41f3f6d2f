from collections.abc import Mapping

from .._declare import CameraModel, CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, Vector


class CameraVelocity(Filter):
    """Compute the motion of every pixel that the camera causes, from depth and the cameras of two frames.

    Each point is placed in the world and projected by the other camera, as in TU Wien's "Screenspace Effects". Objects
    are taken to stand still. Pixels without depth are sky, which only a rotation moves. The motion is in pixels of the
    full-size picture, x to the right and y down: x and y are this frame minus the previous one, z and w the next frame
    minus this one.
    """

    aliases = (
        "motion vectors", "vector generator", "velocity", "camera motion", "motion vector pass", "vector pass", "speed",
    )  # fmt: skip

    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    camera = CameraSocket(doc="The camera of this frame.")
    before = CameraSocket(0.0, doc="The camera of the previous frame. Without a link, it is `camera` at that frame.")
    after = CameraSocket(
        0.0, doc="The camera of the next frame. If only `before` is linked, the camera keeps its speed."
    )

    velocity = OutputSocket(Vector(width=4))

    def times(self, frame: int) -> Mapping[str, tuple[int, ...]]:
        return {"camera": (frame, frame - 1, frame + 1)}

    def passes(self, draw: Draw) -> Drawn:
        camera, before, after = (draw.camera(socket) for socket in (self.camera, self.before, self.after))
        if before is None:
            before = draw.camera(self.camera, draw.frame - 1)
            after = after or draw.camera(self.camera, draw.frame + 1)
        stay = (0.0,) * 12
        return draw.point(
            "camera_velocity",
            self.depth,
            result=Vector(width=4),
            before=_change(camera, before) if camera and before else stay,
            after=_change(camera, after) if camera and after else stay,
            ahead=after is not None,
        )


def _change(camera: CameraModel, neighbor: CameraModel) -> tuple[float, ...]:
    """What the other camera adds to (u d, v d, d) that now sees: rows of a 3 x 4 matrix for (u d, v d, d, 1).

    As a difference, in 64 bits, so that a still camera makes no motion at all and a slow one loses no digits.
    """
    rays = camera.inverse
    rows: list[float] = []
    for axis in range(3):
        ahead, offset = neighbor.rows[4 * axis : 4 * axis + 3], neighbor.rows[4 * axis + 3]
        row = [sum(part * rays[4 * index + column] for index, part in enumerate(ahead)) for column in range(4)]
        row[axis] -= 1.0
        row[3] += offset
        rows += row
    return tuple(rows)
