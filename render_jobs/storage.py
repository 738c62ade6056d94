"""Job folders: plain JSON, plain arrays and copies of the textures, all under a checksum.

Use :meth:`RenderJob.save` and :meth:`RenderJob.load`; this module is how they do it.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from pathlib import Path, PurePosixPath
from typing import Annotated, Any, Literal, TypeVar, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from camera_rigs import CameraPath, PlanError
from render_jobs.errors import RenderJobError
from render_jobs.job import ImageFormat, RenderJob, Tone
from render_jobs.quality import Quality
from render_jobs.scene import Environment, Light, Material, Mesh, SceneValue

JOB_FILE = "job.json"
OUTPUT_FOLDER = "out"
TEXTURE_SUFFIXES = (".png", ".jpg", ".jpeg")
HDRI_SUFFIXES = (".exr", ".hdr")
Value = TypeVar("Value", Material, Environment)
ArrayName = Literal["vertices", "faces", "uv", "placements"]
ARRAYS: tuple[ArrayName, ...] = get_args(ArrayName)


class MeshRecord(SceneValue):
    """A mesh in ``job.json``; its arrays lie in ``folder``."""

    name: str
    folder: str
    arrays: tuple[ArrayName, ...]
    material: Material
    track_id: int
    smooth: bool
    subdivision: int


class JobRecord(SceneValue):
    """What ``job.json`` holds."""

    format: Literal["render-job"] = "render-job"
    version: Literal[1] = 1
    width: int
    height: int
    fps: float
    num_frames: int
    meshes: tuple[MeshRecord, ...]
    lights: tuple[Light, ...]
    environment: Environment
    quality: Quality
    passes: tuple[str, ...]
    image_format: ImageFormat
    shutter: float
    f_number: float | None = None
    exposure: float
    noise: float = 0.0
    tone: Tone
    seed: int
    files: dict[str, Annotated[str, Field(pattern="^[0-9a-f]{64}$")]]
    """sha256 of every other file, by path."""


def save_job(job: RenderJob, folder: Path) -> None:
    """See :meth:`RenderJob.save`."""
    if folder.exists() and any(folder.iterdir()) and not (folder / JOB_FILE).is_file():
        raise RenderJobError(f"{folder}: exists and is no job folder; name another or remove it")
    folder.parent.mkdir(parents=True, exist_ok=True)
    fresh = folder.with_name(f".{folder.name}.new-{os.getpid()}")
    shutil.rmtree(fresh, ignore_errors=True)
    fresh.mkdir()
    try:
        _write(job, fresh)
        _put_in_place(fresh, folder)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def load_job(folder: Path) -> RenderJob:
    """See :meth:`RenderJob.load`."""
    record = read_record(folder)
    try:
        _verify(folder, record.files)
        meshes = tuple(read_mesh(folder, mesh) for mesh in record.meshes)
        camera, neighbours = _load_camera(folder, record)
        return RenderJob(
            camera=camera,
            meshes=meshes,
            lights=record.lights,
            environment=with_folder(record.environment, folder),
            quality=record.quality,
            passes=record.passes,
            image_format=record.image_format,
            camera_neighbours=neighbours,
            shutter=record.shutter,
            f_number=record.f_number,
            focus_distance=_load_focus(folder) if record.f_number is not None else None,
            exposure=record.exposure,
            noise=record.noise,
            tone=record.tone,
            seed=record.seed,
        )
    except RenderJobError as error:
        raise RenderJobError(f"{folder}: {error}") from error


def read_record(folder: Path) -> JobRecord:
    """Read and check ``job.json`` alone: cheap, enough to know which frames a job has.

    Raises:
        RenderJobError: the file is missing or says something impossible.
    """
    path = folder / JOB_FILE
    try:
        return JobRecord.model_validate_json(path.read_bytes())
    except OSError as error:
        raise RenderJobError(f"{path}: cannot be read ({error.strerror}); is this a job folder?") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        raise RenderJobError(f"{path}: {where}: {first['msg']}; save the job again") from error


def _write(job: RenderJob, folder: Path) -> None:
    meshes = tuple(write_mesh(mesh, index, folder) for index, mesh in enumerate(job.meshes))
    environment = job.environment
    if environment.kind == "hdri" and isinstance(environment.hdri, Path):
        copied = _copy(environment.hdri, folder, HDRI_SUFFIXES)
        environment = environment.model_copy(update={"hdri": copied})
    _write_camera(job, folder)
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    record = JobRecord(
        width=job.camera.width,
        height=job.camera.height,
        fps=job.camera.fps,
        num_frames=job.num_frames,
        meshes=meshes,
        lights=job.lights,
        environment=environment,
        quality=job.quality,
        passes=job.passes,
        image_format=job.image_format,
        shutter=job.shutter,
        f_number=job.f_number,
        exposure=job.exposure,
        noise=job.noise,
        tone=job.tone,
        seed=job.seed,
        files={path.relative_to(folder).as_posix(): _sha256(path) for path in paths},
    )
    text = json.dumps(record.model_dump(mode="json"), indent=1, ensure_ascii=False)
    (folder / JOB_FILE).write_text(text + "\n", encoding="utf-8")


def write_mesh(mesh: Mesh, index: int, folder: Path) -> MeshRecord:
    """Write a mesh's arrays and copies of its textures into the folder, as its number ``index``.

    Raises:
        RenderJobError: a texture cannot be copied.
    """
    place = Path("meshes", f"{index:04d}")
    (folder / place).mkdir(parents=True)
    arrays = tuple(name for name in ARRAYS if getattr(mesh, name) is not None)
    for name in arrays:
        np.save(folder / place / f"{name}.npy", getattr(mesh, name), allow_pickle=False)
    material = mesh.material
    for key in ("base_color_texture", "normal_texture"):
        source = getattr(material, key)
        if source is not None:
            material = material.model_copy(update={key: _copy(source, folder, TEXTURE_SUFFIXES)})
    return MeshRecord(
        name=mesh.name,
        folder=place.as_posix(),
        arrays=arrays,
        material=material,
        track_id=mesh.track_id,
        smooth=mesh.smooth,
        subdivision=mesh.subdivision,
    )


def _copy(source: Path, folder: Path, suffixes: tuple[str, ...]) -> Path:
    if source.suffix.lower() not in suffixes:
        raise RenderJobError(f"{source}: an image for this use must end in {' or '.join(suffixes)}")
    try:
        target = Path("textures", _sha256(source)[:32] + source.suffix.lower())
        (folder / "textures").mkdir(exist_ok=True)
        shutil.copyfile(source, folder / target)
    except OSError as error:
        raise RenderJobError(f"{source}: the image cannot be copied ({error.strerror})") from error
    return target


def _write_camera(job: RenderJob, folder: Path) -> None:
    arrays = {"K": job.camera.K, "T_world_camera": job.camera.T_world_camera}
    if job.camera_neighbours is not None:
        arrays["neighbour_K"] = job.camera_neighbours.K
        arrays["neighbour_T_world_camera"] = job.camera_neighbours.T_world_camera
    if job.focus_distance is not None:
        arrays["focus_distance"] = job.focus_distance
    with (folder / "camera.npz").open("wb") as file:
        np.savez(file, **{name: np.asarray(value, np.float64) for name, value in arrays.items()})


def _put_in_place(fresh: Path, folder: Path) -> None:
    if not folder.exists():
        fresh.replace(folder)
        return
    present = folder / JOB_FILE
    if present.is_file() and present.read_bytes() == (fresh / JOB_FILE).read_bytes():
        return
    old = folder.with_name(f".{folder.name}.old-{os.getpid()}")
    folder.replace(old)
    fresh.replace(folder)
    shutil.rmtree(old, ignore_errors=True)


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _verify(folder: Path, files: dict[str, str]) -> None:
    for name, expected in files.items():
        path = _inside(folder, name)
        try:
            actual = _sha256(path)
        except OSError as error:
            raise RenderJobError(f"{name} cannot be read ({error.strerror}); save the job again") from error
        if actual != expected:
            raise RenderJobError(
                f"{name} is damaged: its sha256 is not the one in job.json; save the job again"
            )


def _inside(folder: Path, name: str) -> Path:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        raise RenderJobError(f"job.json names the file {name!r}, which lies outside the job folder")
    return folder / path


def read_mesh(folder: Path, record: MeshRecord) -> Mesh:
    """Read a mesh that :func:`write_mesh` wrote.

    Raises:
        RenderJobError: an array is missing or damaged, or a path leads out of the folder.
    """
    arrays = {name: _load_array(folder, f"{record.folder}/{name}.npy") for name in record.arrays}
    if not {"vertices", "faces"} <= set(arrays):
        raise RenderJobError(
            f"mesh {record.name!r}: job.json lists no vertices or no faces; save the job again"
        )
    return Mesh(
        name=record.name,
        vertices=arrays["vertices"],
        faces=arrays["faces"],
        material=with_folder(record.material, folder),
        uv=arrays.get("uv"),
        placements=arrays.get("placements"),
        track_id=record.track_id,
        smooth=record.smooth,
        subdivision=record.subdivision,
    )


def _load_array(folder: Path, name: str) -> NDArray[Any]:
    path = _inside(folder, name)
    try:
        array: NDArray[Any] = np.load(path, allow_pickle=False)
    except (OSError, ValueError) as error:
        raise RenderJobError(f"{name} is no plain NumPy array; save the job again") from error
    return array


def _load_camera(folder: Path, record: JobRecord) -> tuple[CameraPath, CameraPath | None]:
    try:
        with np.load(folder / "camera.npz", allow_pickle=False) as file:
            arrays = dict(file)
    except (OSError, ValueError) as error:
        raise RenderJobError("camera.npz cannot be read; save the job again") from error
    if not {"K", "T_world_camera"} <= set(arrays):
        raise RenderJobError("camera.npz lacks K or T_world_camera; save the job again")

    def path(prefix: str) -> CameraPath:
        try:
            return CameraPath(
                K=arrays[prefix + "K"],
                T_world_camera=arrays[prefix + "T_world_camera"],
                fps=record.fps,
                width=record.width,
                height=record.height,
            )
        except (KeyError, PlanError) as error:
            raise RenderJobError(f"camera.npz: {error}; save the job again") from error

    camera = path("")
    if camera.num_frames != record.num_frames:
        raise RenderJobError(f"camera.npz holds {camera.num_frames} frames, job.json {record.num_frames}")
    return camera, path("neighbour_") if "neighbour_K" in arrays else None


def _load_focus(folder: Path) -> NDArray[np.float64]:
    with np.load(folder / "camera.npz", allow_pickle=False) as file:
        if "focus_distance" not in file:
            raise RenderJobError("camera.npz lacks focus_distance; save the job again")
        return np.asarray(file["focus_distance"], np.float64)


def with_folder(value: Value, folder: Path) -> Value:
    """The value with its relative file names made absolute."""
    files: dict[str, Path] = {}
    for key in ("base_color_texture", "normal_texture", "hdri"):
        path = getattr(value, key, None)
        if isinstance(path, Path):
            files[key] = _inside(folder, path.as_posix())
    return value.model_copy(update=files)
