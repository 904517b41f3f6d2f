from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, ProxyNote, Vector


class Facing(Filter):
    """Measure how much every surface faces the camera: 1 if it faces it directly, 0 if it turns away.

    The cosine of the angle between the normal and the direction to the camera. It is 0 for surfaces seen from behind,
    and for the background. Where antialiasing has mixed several normals, it is the mean of the pixels around.
    """

    aliases = ("facing ratio", "fresnel", "incidence", "falloff", "layer weight", "rim", "silhouette")

    proxy_notes = (ProxyNote(("facing",), "it compares neighboring pixels, which are farther apart in a proxy"),)

    normal = Vector(width=3, doc="Normals of surfaces.")
    camera = CameraSocket(0.0, doc="Without one, normals are the camera's own: x right, y up, z toward it.")

    facing = OutputSocket(Field(doc="1 where a surface faces the camera, 0 where it turns away."))

    def passes(self, draw: Draw) -> Drawn:
        camera = draw.camera(self.camera)
        # As seen from far away, along -z.
        rays = camera.inverse if camera else (0.0,) * 10 + (-1.0, 0.0)
        return draw("facing", self.normal, overlap=1, result=Field(), rays=rays)
