"""A job's scene on the graphics card, and its frames."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL
from PIL import Image
from scipy.spatial.transform import Rotation

from render_jobs.colour import linear
from render_jobs.errors import RenderJobError
from render_jobs.job import RenderJob
from render_jobs.raster import gl
from render_jobs.raster.lighting import light_arrays
from render_jobs.raster.surfaces import Surface, surface_of
from render_jobs.raster.surroundings import surroundings_of

Floats = NDArray[np.float32]

NEAR_M, FAR_M = 0.05, 5000.0
SHADOW_SIZE = 2048
SHADOW_REACH_M = 12.0
"""Half the width of the area, around the people, that the shadow map covers."""
TEXTURE_UNIT, SHADOW_UNIT, ENVIRONMENT_UNIT = 0, 1, 2


@dataclass(frozen=True)
class _Drawn:
    """A mesh on the card."""

    surface: Surface
    geometry: gl.Geometry
    texture: int | None


class Canvas:
    """Draws frames of one job. Needs a current context; of the quality only the antialiasing is of use."""

    def __init__(self, job: RenderJob) -> None:
        self._job = job
        self._K, self._pose = job.camera_with_neighbours()
        self._textures = lru_cache(maxsize=None)(_load_texture)
        self._drawn = [self._upload(surface_of(mesh)) for mesh in job.meshes]
        self._drawn.sort(key=lambda drawn: drawn.surface.mesh.material.alpha_mode == "blend")
        width, height = job.camera.width, job.camera.height
        self._label_target = gl.make_target(width, height, 3)
        samples = min(int(GL.glGetIntegerv(GL.GL_MAX_SAMPLES)), 4 if job.quality.samples < 16 else 8)
        self._picture_target = gl.make_target(width, height, 1, samples)
        self._shadow_target, self._shadow_map = gl.make_shadow_target(SHADOW_SIZE)
        self._surroundings = surroundings_of(job.environment)
        self._lights = light_arrays(job.lights, self._surroundings)
        self._environment = gl.environment_texture(self._surroundings.image)
        self._labels = gl.Program("surface.vert", "labels.frag")
        self._picture = gl.Program("surface.vert", "picture.frag")
        self._shadow = gl.Program("surface.vert", "shadow.frag")
        self._backdrop = gl.Program("backdrop.vert", "backdrop.frag")
        self._to_shadow = np.eye(4)
        GL.glEnable(GL.GL_DEPTH_TEST)
        # row 0 of our buffers is the top of the image, so that windings appear mirrored
        GL.glFrontFace(GL.GL_CW)

    def set_frame(self, frame: int, shift: float = 0.0, lens: tuple[float, float] = (0.0, 0.0)) -> None:
        """Bring the vertices of a frame to the card, and set the camera.

        Args:
            frame: its number.
            shift: time from the frame, −½ … ½ of the time to the next, for motion blur.
            lens: point of the lens to look through, in the unit disc, for depth of field.
        """
        for drawn in self._drawn:
            if drawn.surface.mesh.animated:
                _send(drawn, frame, shift)
        self._now = frame + 1  # row of the camera arrays, which start at frame −1
        self._eye_K, self._eye_pose = moved_camera(self._job, frame, shift, lens)

    def labels(self) -> tuple[Floats, Floats, Floats]:
        """Id and depth ``(H, W, 2)`` (depth 0: no hit), normals ``(H, W, 3)`` and flow ``(H, W, 2)``."""
        self._label_target.bind()
        GL.glDisable(GL.GL_BLEND)
        GL.glClearColor(0.0, 0.0, 0.0, 0.0)
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)
        self._labels.use()
        self._set_camera(self._labels)
        self._labels.matrix("intrinsics_next", self._K[self._now + 1])
        for drawn in self._drawn:
            mesh = drawn.surface.mesh
            self._labels.number("track_id", float(mesh.track_id))
            self._labels.integer("uses_alpha", mesh.material.alpha_mode != "opaque")
            self._draw(self._labels, drawn)
        surface, facing, motion = (self._label_target.read(index) for index in range(3))
        return surface[..., :2], facing[..., :3], motion[..., :2]

    def picture(self) -> Floats:
        """Linear light ``(H, W, 3)``."""
        self._draw_shadow_map()
        self._picture_target.bind()
        GL.glClear(GL.GL_DEPTH_BUFFER_BIT)
        self._draw_backdrop()
        self._picture.use()
        self._set_camera(self._picture)
        self._set_lights()
        for drawn in self._drawn:
            self._set_material(drawn)
            blends = drawn.surface.mesh.material.alpha_mode == "blend"
            (GL.glEnable if blends else GL.glDisable)(GL.GL_BLEND)
            GL.glBlendFunc(GL.GL_SRC_ALPHA, GL.GL_ONE_MINUS_SRC_ALPHA)
            GL.glDepthMask(not blends)
            self._draw(self._picture, drawn)
        GL.glDepthMask(True)
        gl.resolve(self._picture_target, self._label_target)
        return self._label_target.read()[..., :3]

    def _upload(self, surface: Surface) -> _Drawn:
        path = surface.mesh.material.base_color_texture
        texture = None if path is None else self._textures(path)
        drawn = _Drawn(surface, gl.Geometry(surface.triangles, surface.uv), texture)
        _send(drawn, 0, 0.0)
        return drawn

    def _set_camera(self, program: gl.Program) -> None:
        camera = self._job.camera
        program.matrix("world_to_camera_now", np.linalg.inv(self._eye_pose))
        program.matrix("world_to_camera_next", np.linalg.inv(self._pose[self._now + 1]))
        program.matrix("projection", projection(self._eye_K, camera.width, camera.height))
        program.matrix("world_to_shadow", self._to_shadow)

    def _draw(self, program: gl.Program, drawn: _Drawn) -> None:
        mesh = drawn.surface.mesh
        program.integer("smooth_shading", mesh.smooth)
        program.integer("one_sided", not mesh.material.double_sided)
        program.integer("has_texture", drawn.texture is not None)
        program.integer("base_texture", TEXTURE_UNIT)
        if drawn.texture is not None:
            gl.bind_texture(TEXTURE_UNIT, drawn.texture)
        for placement in np.eye(4)[None] if mesh.placements is None else mesh.placements:
            program.matrix("placement", placement)
            drawn.geometry.draw()

    def _set_material(self, drawn: _Drawn) -> None:
        material = drawn.surface.mesh.material
        self._picture.vectors("base_color", np.array(linear(material.base_color)))
        self._picture.vectors("emission", material.emission_strength * np.array(linear(material.emission)))
        self._picture.number("roughness", material.roughness)
        self._picture.number("metallic", material.metallic)
        self._picture.number("specular", material.specular)
        self._picture.integer("cut_alpha", material.alpha_mode == "clip")
        self._picture.integer("blend_alpha", material.alpha_mode == "blend")

    def _set_lights(self) -> None:
        lights, picture = self._lights, self._picture
        picture.vectors("eye", self._eye_pose[:3, 3])
        picture.vectors("ambient_above", self._surroundings.above)
        picture.vectors("ambient_below", self._surroundings.below)
        picture.integer("num_lights", len(lights.color))
        picture.vectors("light_position", lights.position)
        picture.vectors("light_color", lights.color)
        picture.vectors("light_axis", lights.axis)
        picture.integers("light_is_flat", lights.flat)
        picture.integer("shadow_of", lights.shadow_of)
        gl.bind_texture(SHADOW_UNIT, self._shadow_map)
        picture.integer("shadow_map", SHADOW_UNIT)

    def _draw_shadow_map(self) -> None:
        if self._lights.shadow_of < 0:
            return
        self._to_shadow = shadow_matrix(self._lights.position[self._lights.shadow_of, :3], self._centre())
        self._shadow_target.bind()
        GL.glClear(GL.GL_DEPTH_BUFFER_BIT)
        self._shadow.use()
        self._set_camera(self._shadow)
        self._shadow.matrix("projection", self._to_shadow @ self._eye_pose)
        for drawn in self._drawn:
            self._shadow.integer("uses_alpha", drawn.surface.mesh.material.alpha_mode != "opaque")
            self._draw(self._shadow, drawn)

    def _centre(self) -> NDArray[np.float64]:
        """The middle of what moves, or the origin."""
        moving = [d.surface.mesh.frame(self._now - 1) for d in self._drawn if d.surface.mesh.animated]
        if not moving:
            return np.zeros(3)
        centre: NDArray[np.float64] = np.mean([vertices.mean(axis=0) for vertices in moving], axis=0)
        return centre

    def _draw_backdrop(self) -> None:
        self._backdrop.use()
        pixel_to_world = self._eye_pose[:3, :3] @ np.linalg.inv(self._eye_K)
        self._backdrop.matrix("pixel_to_world", pixel_to_world)
        gl.bind_texture(ENVIRONMENT_UNIT, self._environment)
        self._backdrop.integer("environment", ENVIRONMENT_UNIT)
        GL.glDisable(GL.GL_BLEND)
        GL.glDrawArrays(GL.GL_TRIANGLES, 0, 3)


def projection(K: NDArray[np.float64], width: int, height: int) -> NDArray[np.float64]:
    """From camera axes (x right, y down, z forward) to clip space whose row 0 is the top of the image."""
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[0, 2] = 2 * K[0, 0] / width, 2 * K[0, 2] / width - 1
    matrix[1, 1], matrix[1, 2] = 2 * K[1, 1] / height, 2 * K[1, 2] / height - 1
    matrix[2, 2] = (FAR_M + NEAR_M) / (FAR_M - NEAR_M)
    matrix[2, 3] = -2 * FAR_M * NEAR_M / (FAR_M - NEAR_M)
    matrix[3, 2] = 1.0
    return matrix


def shadow_matrix(towards: Floats, centre: NDArray[np.float64]) -> NDArray[np.float64]:
    """From the world to the clip space of a light at infinity: a box around ``centre``."""
    forward = -towards.astype(np.float64)
    side = np.cross(forward, [0.0, 0.0, 1.0] if abs(forward[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([side, np.cross(forward, side), forward]) / SHADOW_REACH_M
    matrix[:3, 3] = -matrix[:3, :3] @ centre
    return matrix


def moved_camera(
    job: RenderJob, frame: int, shift: float, lens: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """``K`` and ``T_world_camera`` at a time beside a frame, seen through a point of the lens.

    The eye moves on the lens, and the image with it, so that what lies in the plane of focus stays in place.
    """
    K, pose = job.camera_with_neighbours()
    here, there = frame + 1, frame + 1 + (1 if shift > 0 else -1)
    share = abs(shift)
    eye_K = (1 - share) * K[here] + share * K[there]
    eye_pose = pose[here].copy()
    if share:
        turn = Rotation.from_matrix(pose[here, :3, :3].T @ pose[there, :3, :3]).as_rotvec()
        eye_pose[:3, :3] = pose[here, :3, :3] @ Rotation.from_rotvec(share * turn).as_matrix()
        eye_pose[:3, 3] += share * (pose[there, :3, 3] - pose[here, :3, 3])
    if job.focus_distance is not None:
        offset = job.apertures[here] / 2 * np.array(lens)
        eye_pose[:3, 3] += eye_pose[:3, :2] @ offset
        eye_K[:2, 2] += eye_K[[0, 1], [0, 1]] * offset / job.focus_distance[here]
    return eye_K, eye_pose


def _send(drawn: _Drawn, frame: int, shift: float) -> None:
    surface = drawn.surface
    now = surface.positions(frame)
    if shift:
        beside = surface.positions(frame + (1 if shift > 0 else -1))
        now = (now + np.float32(abs(shift)) * (beside - now)).astype(np.float32)
    drawn.geometry.update(now, surface.positions(frame + 1), surface.normals(frame))


def _load_texture(path: Path) -> int:
    try:
        with Image.open(path) as image:
            pixels = np.asarray(image.convert("RGBA"))
    except OSError as error:
        raise RenderJobError(f"{path}: the image is damaged or of an unknown kind") from error
    return gl.picture_texture(pixels)
