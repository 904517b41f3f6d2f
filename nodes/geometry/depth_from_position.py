from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, Vector


class DepthFromPosition(Filter):
    """Find how deep every pixel lies in the picture, from its place in the world and the camera.

    The depth is planar, in world units, along the way the camera looks. It is 1e10 where there is nothing: at 0, 0, 0,
    which renderers write there, and behind the camera.
    """

    aliases = ("depth", "z depth", "position to depth", "depth generator", "world to depth")

    position = Vector(width=3, doc="Places in the world.")
    camera = CameraSocket(doc="The camera that the positions were rendered with.")

    depth = OutputSocket(Field())

    def passes(self, draw: Draw) -> Drawn:
        camera = draw.camera(self.camera)
        rows = camera.rows if camera else (0.0,) * 12
        return draw.point("depth_from_position", self.position, result=Field(), rows=rows)
