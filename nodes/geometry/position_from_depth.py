from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, Vector


class PositionFromDepth(Filter):
    """Compute the position of every pixel in the world, from its depth and the camera.

    The position is `eye + depth * ray`, in world units, as exact as the depth. On the background it is 0, 0, 0, as
    renderers write it.
    """

    aliases = (
        "world position", "depth to position", "position pass", "depth to points", "p world", "unproject", "world pos",
        "reconstruct position", "points", "position to points",
    )  # fmt: skip

    depth = Field(doc="Planar depth: the distance along the camera's axis.")
    camera = CameraSocket(doc="The camera that the depth was rendered with.")

    position = OutputSocket(Vector(width=3))

    def passes(self, draw: Draw) -> Drawn:
        camera = draw.camera(self.camera)
        rays = camera.inverse if camera else (0.0,) * 12
        return draw.point("position_from_depth", self.depth, result=Vector(width=3), rays=rays)
