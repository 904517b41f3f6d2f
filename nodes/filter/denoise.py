from typing import Annotated, Any, Literal

from .._declare import Doc, Draw, Drawn, Filter, HostProgram, Image, ProxyNote, Vector


class Denoise(Filter):
    """Remove the noise of a path-traced render by Open Image Denoise.

    A neural network that was trained with renders (Áfra 2025). With the layers albedo and normal as guides it keeps
    textures and edges. It belongs directly after the render, before anything blurs or resamples. It runs on the
    processor, while the editor goes on. It needs an extra: `pip install halation[denoise]`.
    """

    aliases = (
        "degrain",
        "oidn", "noise reduction", "remove noise", "ai denoise", "open image denoise", "clean up", "intel denoise",
        "denoise sharpen", "remove grain",
    )  # fmt: skip
    proxy_notes = (ProxyNote(("out",), "a network sees other noise in a smaller picture"),)

    image = Image(doc="The noisy render. Negative light becomes 0.")
    albedo = Image((1.0, 1.0, 1.0, 1.0), doc="The color of the surfaces, from the same render.")
    normal = Vector(0.0, width=3, doc="The normals, from the same render.")
    quality: Annotated[Literal["high", "balanced", "fast"], Doc("How good the result is, and how long it takes.")] = (
        "high"
    )
    guides: Annotated[
        Literal["noisy", "clean"],
        Doc("Whether albedo and normal have noise too, as with depth of field or few samples: then they are denoised."),
    ] = "noisy"
    hdr: Annotated[bool, Doc("The picture is scene light. Off: display colors from 0 to 1.")] = True

    def passes(self, draw: Draw) -> Drawn:
        pictures: dict[str, Any] = {"color": draw.point("denoise_color", self.image, hdr=self.hdr)}
        if draw.is_linked(self.albedo) or draw.is_linked(self.normal):
            pictures["albedo"] = draw.point("denoise_albedo", image=pictures["color"], albedo=self.albedo)
        if draw.is_linked(self.normal):
            pictures["normal"] = draw.point("denoise_normal", self.normal, result=Vector(width=3))
        settings = (("guides", self.guides), ("hdr", self.hdr), ("quality", self.quality))
        denoised = draw.host(HostProgram("open_image_denoise", settings), **pictures)
        return draw.point("denoise", self.image, denoised=denoised)
