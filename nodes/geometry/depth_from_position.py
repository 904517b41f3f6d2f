from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, Vector


class DepthFromPosition(Filter):
    """Compute the depth of every pixel from its position in the world and the camera.

    The depth is planar, in world units, along the camera's axis. It is 1e10 on the background, where renderers write
    the position 0, 0, 0, and behind the camera.
    """

    aliases = ("depth", "z depth", "position to depth", "depth generator", "world to depth")

    position = Vector(width=3, doc="Positions in the world.")
    camera = CameraSocket(doc="The camera that the positions were rendered with.")

    depth = OutputSocket(Field())

    def passes(self, draw: Draw) -> Drawn:
        camera = draw.camera(self.camera)
        rows = camera.rows if camera else (0.0,) * 12
        return draw.point("depth_from_position", self.position, result=Field(), rows=rows)
