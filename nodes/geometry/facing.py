from .._declare import CameraSocket, Draw, Drawn, Field, Filter, OutputSocket, ProxyNote, Vector


class Facing(Filter):
    """Measure how much every surface faces the camera: 1 straight on, 0 where it turns away.

    The cosine of the angle between the normal and the way to the camera; surfaces seen from behind, and the
    background, are 0. Where antialiasing has mixed several normals, it is the mean of what the pixels around say.
    """

    aliases = ("facing ratio", "fresnel", "incidence", "falloff", "layer weight", "rim", "silhouette")

    proxy_notes = (ProxyNote(("facing",), "it weighs the next pixels, which are farther away in a proxy"),)

    normal = Vector(width=3, doc="Directions of surfaces.")
    camera = CameraSocket(0.0, doc="Without one, normals are the camera's own: x right, y up, z towards it.")

    facing = OutputSocket(Field(doc="0..1."))

    def passes(self, draw: Draw) -> Drawn:
        camera = draw.camera(self.camera)
        # As seen from far away, along -z.
        rays = camera.inverse if camera else (0.0,) * 10 + (-1.0, 0.0)
        return draw("facing", self.normal, overlap=1, result=Field(), rays=rays)
