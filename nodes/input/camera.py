from collections.abc import Mapping
from typing import Annotated, Literal

from .._declare import CameraModel as Placed
from .._declare import CameraSocket, Doc, Draw, Filter, OutputSocket, Slider, look_at

Place = Annotated[tuple[float, float, float], Slider(-10.0, 10.0, unit="scene")]


class Camera(Filter):
    """A camera set by hand, for pictures whose file does not contain one.

    The field of view is `2 atan(sensor / (2 focal))` across the picture. Depth is measured along its axis.
    """

    aliases = ("camera 3d", "lens", "projection", "view", "camera3d")

    eye: Annotated[Place, Doc("The position of the camera.")] = (0.0, -5.0, 1.5)
    target: Annotated[Place, Doc("The point that the camera looks at.")] = (0.0, 0.0, 1.0)
    focal: Annotated[
        float, Slider(8.0, 200.0, unit="mm", minimum=0.1, maximum=10000.0, doc="Focal length in millimeters.")
    ] = 50.0
    sensor: Annotated[
        float,
        Slider(
            4.0,
            70.0,
            unit="mm",
            minimum=0.1,
            maximum=1e3,
            doc="Width of the sensor in millimeters, 36 for full frame.",
        ),
    ] = 36.0
    up: Annotated[Literal["z", "y"], Doc("The axis of the world that points up: z in Blender, y in Maya.")] = "z"

    camera = OutputSocket(CameraSocket())

    def passes(self, draw: Draw) -> Mapping[str, Placed]:
        width, height = draw.size
        across = self.focal / self.sensor
        up = (0.0, 0.0, 1.0) if self.up == "z" else (0.0, 1.0, 0.0)
        return {"camera": look_at(self.eye, self.target, (across, across * width / height), up)}
