"""The little of OpenGL that the raster engine needs. Import only where a context has been opened."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL
from OpenGL.GL import shaders

SHADER_FOLDER = Path(__file__).parent / "shaders"

Array = NDArray[Any]


class Program:
    """A vertex and a fragment shader, and their uniforms by name; names that no shader uses are ignored."""

    def __init__(self, vertex: str, fragment: str) -> None:
        # linked by hand: PyOpenGL's helper validates too, which fails where no vertex array is bound
        self._id = GL.glCreateProgram()
        for name, kind in ((vertex, GL.GL_VERTEX_SHADER), (fragment, GL.GL_FRAGMENT_SHADER)):
            shader = shaders.compileShader((SHADER_FOLDER / name).read_text(encoding="utf-8"), kind)
            GL.glAttachShader(self._id, shader)
        GL.glLinkProgram(self._id)
        if GL.glGetProgramiv(self._id, GL.GL_LINK_STATUS) != GL.GL_TRUE:
            raise RuntimeError(f"{vertex} and {fragment}: {GL.glGetProgramInfoLog(self._id)!r}")
        self._places: dict[str, int] = {}

    def use(self) -> None:
        """Make this the program that draws."""
        GL.glUseProgram(self._id)

    def integer(self, name: str, value: int) -> None:
        """Set a bool, an int or the unit of a sampler."""
        GL.glUniform1i(self._place(name), int(value))

    def integers(self, name: str, values: Sequence[int]) -> None:
        """Set an array of bools or ints."""
        if len(values):
            GL.glUniform1iv(self._place(name), len(values), np.asarray(values, np.int32))

    def number(self, name: str, value: float) -> None:
        """Set a float."""
        GL.glUniform1f(self._place(name), value)

    def vectors(self, name: str, values: Array) -> None:
        """Set a vector ``(3,)`` or an array of vectors ``(N, 3)`` or ``(N, 4)``."""
        rows = np.ascontiguousarray(np.atleast_2d(values), np.float32)
        if len(rows):
            setter = GL.glUniform3fv if rows.shape[1] == 3 else GL.glUniform4fv
            setter(self._place(name), len(rows), rows)

    def matrix(self, name: str, value: Array) -> None:
        """Set a 3×3 or 4×4 matrix that multiplies columns from the left."""
        setter = GL.glUniformMatrix3fv if len(value) == 3 else GL.glUniformMatrix4fv
        setter(self._place(name), 1, GL.GL_TRUE, np.ascontiguousarray(value, np.float32))

    def _place(self, name: str) -> int:
        if name not in self._places:
            self._places[name] = int(GL.glGetUniformLocation(self._id, name))
        return self._places[name]


@dataclass(frozen=True)
class Target:
    """Buffers to draw into: colour attachments of one format, and depth."""

    framebuffer: int
    width: int
    height: int
    attachments: int

    def bind(self) -> None:
        """Draw into this target from now on."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self.framebuffer)
        GL.glViewport(0, 0, self.width, self.height)
        GL.glDrawBuffers(self.attachments, [GL.GL_COLOR_ATTACHMENT0 + i for i in range(self.attachments)])

    def read(self, attachment: int = 0) -> NDArray[np.float32]:
        """The pixels ``(H, W, 4)`` of a colour attachment, row 0 first."""
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self.framebuffer)
        GL.glReadBuffer(GL.GL_COLOR_ATTACHMENT0 + attachment)
        data = GL.glReadPixels(0, 0, self.width, self.height, GL.GL_RGBA, GL.GL_FLOAT)
        return np.frombuffer(data, np.float32).reshape(self.height, self.width, 4)


def make_target(width: int, height: int, attachments: int, samples: int = 0) -> Target:
    """Create a float target; ``samples`` > 0 makes it antialiased, to be resolved before it is read."""
    framebuffer = int(GL.glGenFramebuffers(1))
    GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, framebuffer)
    colour = [(GL.GL_RGBA32F, GL.GL_COLOR_ATTACHMENT0 + index) for index in range(attachments)]
    for form, place in [*colour, (GL.GL_DEPTH_COMPONENT32F, GL.GL_DEPTH_ATTACHMENT)]:
        buffer = GL.glGenRenderbuffers(1)
        GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
        GL.glRenderbufferStorageMultisample(GL.GL_RENDERBUFFER, samples, form, width, height)
        GL.glFramebufferRenderbuffer(GL.GL_FRAMEBUFFER, place, GL.GL_RENDERBUFFER, buffer)
    _check_framebuffer()
    return Target(framebuffer, width, height, attachments)


def make_shadow_target(size: int) -> tuple[Target, int]:
    """Create a square depth map to draw into, and the texture to read it from."""
    texture = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)
    GL.glTexImage2D(
        GL.GL_TEXTURE_2D, 0, GL.GL_DEPTH_COMPONENT32F, size, size, 0, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, None
    )
    _filter(GL.GL_NEAREST, GL.GL_NEAREST, GL.GL_CLAMP_TO_EDGE)
    framebuffer = int(GL.glGenFramebuffers(1))
    GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, framebuffer)
    GL.glFramebufferTexture2D(GL.GL_FRAMEBUFFER, GL.GL_DEPTH_ATTACHMENT, GL.GL_TEXTURE_2D, texture, 0)
    GL.glDrawBuffer(GL.GL_NONE)
    GL.glReadBuffer(GL.GL_NONE)
    _check_framebuffer()
    return Target(framebuffer, size, size, 0), texture


def resolve(source: Target, target: Target) -> None:
    """Average the samples of an antialiased target into a plain one of the same size."""
    GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, source.framebuffer)
    GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, target.framebuffer)
    box = (0, 0, source.width, source.height)
    GL.glBlitFramebuffer(*box, *box, GL.GL_COLOR_BUFFER_BIT, GL.GL_NEAREST)


def picture_texture(pixels: NDArray[np.uint8]) -> int:
    """A repeating texture of an RGBA picture ``(H, W, 4)``, top row first, with v up."""
    height, width = pixels.shape[:2]
    texture = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)
    flipped = np.ascontiguousarray(pixels[::-1])
    GL.glTexImage2D(
        GL.GL_TEXTURE_2D, 0, GL.GL_RGBA8, width, height, 0, GL.GL_RGBA, GL.GL_UNSIGNED_BYTE, flipped
    )
    GL.glGenerateMipmap(GL.GL_TEXTURE_2D)
    _filter(GL.GL_LINEAR_MIPMAP_LINEAR, GL.GL_LINEAR, GL.GL_REPEAT)
    return texture


def environment_texture(image: NDArray[np.float32]) -> int:
    """A texture of linear light ``(H, W, 3)``, first row at v = 0."""
    texture = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)
    height, width = image.shape[:2]
    data = np.ascontiguousarray(image, np.float32)
    GL.glTexImage2D(GL.GL_TEXTURE_2D, 0, GL.GL_RGB32F, width, height, 0, GL.GL_RGB, GL.GL_FLOAT, data)
    _filter(GL.GL_LINEAR, GL.GL_LINEAR, GL.GL_CLAMP_TO_EDGE)
    GL.glTexParameteri(GL.GL_TEXTURE_2D, GL.GL_TEXTURE_WRAP_S, GL.GL_REPEAT)
    return texture


def bind_texture(unit: int, texture: int) -> None:
    """Put a texture on a unit."""
    GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
    GL.glBindTexture(GL.GL_TEXTURE_2D, texture)


class Geometry:
    """Triangles on the card; the vertices can be replaced from frame to frame."""

    def __init__(self, triangles: Array, uv: Array) -> None:
        self._count = triangles.size
        self._array = GL.glGenVertexArrays(1)
        GL.glBindVertexArray(self._array)
        self._buffers = [self._attribute(place, 3, len(uv)) for place in range(3)]
        _fill(self._attribute(3, 2, len(uv)), uv)
        index = GL.glGenBuffers(1)
        GL.glBindBuffer(GL.GL_ELEMENT_ARRAY_BUFFER, index)
        data = np.ascontiguousarray(triangles, np.uint32)
        GL.glBufferData(GL.GL_ELEMENT_ARRAY_BUFFER, data.nbytes, data, GL.GL_STATIC_DRAW)

    def update(self, now: Array, following: Array, normals: Array) -> None:
        """Replace positions now, positions at the next frame and normals, each ``(N, 3)``."""
        for buffer, values in zip(self._buffers, (now, following, normals), strict=True):
            _fill(buffer, values)

    def draw(self) -> None:
        """Draw with the program and the target in use."""
        GL.glBindVertexArray(self._array)
        GL.glDrawElements(GL.GL_TRIANGLES, self._count, GL.GL_UNSIGNED_INT, None)

    @staticmethod
    def _attribute(place: int, components: int, count: int) -> int:
        buffer = int(GL.glGenBuffers(1))
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, buffer)
        GL.glBufferData(GL.GL_ARRAY_BUFFER, 4 * components * count, None, GL.GL_DYNAMIC_DRAW)
        GL.glEnableVertexAttribArray(place)
        GL.glVertexAttribPointer(place, components, GL.GL_FLOAT, GL.GL_FALSE, 0, None)
        return buffer


def _fill(buffer: int, values: Array) -> None:
    data = np.ascontiguousarray(values, np.float32)
    GL.glBindBuffer(GL.GL_ARRAY_BUFFER, buffer)
    GL.glBufferSubData(GL.GL_ARRAY_BUFFER, 0, data.nbytes, data)


def _filter(minify: int, magnify: int, wrap: int) -> None:
    for name, value in (
        (GL.GL_TEXTURE_MIN_FILTER, minify),
        (GL.GL_TEXTURE_MAG_FILTER, magnify),
        (GL.GL_TEXTURE_WRAP_S, wrap),
        (GL.GL_TEXTURE_WRAP_T, wrap),
    ):
        GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)


def _check_framebuffer() -> None:
    status = GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER)
    if status != GL.GL_FRAMEBUFFER_COMPLETE:
        raise RuntimeError(f"the OpenGL driver cannot draw into float buffers (status {status:#x})")
