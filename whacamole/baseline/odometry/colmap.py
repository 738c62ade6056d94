"""``colmap``: incremental structure from motion by pycolmap. Slower and better than ``opencv``."""

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from whacamole.baseline.odometry.features import load_cv2, static_world
from whacamole.baseline.odometry.trajectory import Odometry, Scene
from whacamole.errors import BaselineError


@dataclass(frozen=True)
class ColmapOdometry:
    """``colmap``: one pinhole camera, held fixed; of several models that come out, the largest counts."""

    name: str = "colmap"

    def track(self, scene: Scene) -> Odometry:
        """The camera through the footage.

        Raises:
            BaselineError: pycolmap is missing, K changes along the way (a zoom), or nothing came out.
        """
        pycolmap = _pycolmap()
        if np.ptp(scene.K, axis=0).max() > 1e-6:
            raise BaselineError(f"{scene.footage.id}: a zoom, which --vo colmap cannot do; choose opencv")
        with tempfile.TemporaryDirectory(prefix="whacamole-colmap-") as folder:
            return self._in(pycolmap, Path(folder), scene)

    def _in(self, pycolmap: Any, folder: Path, scene: Scene) -> Odometry:
        images, masks = folder / "images", folder / "masks"
        _write(scene, images, masks)
        K = scene.K[0]
        database = folder / "database.db"
        reader = pycolmap.ImageReaderOptions(
            camera_model="PINHOLE",
            camera_params=f"{K[0, 0]},{K[1, 1]},{K[0, 2]},{K[1, 2]}",
            mask_path=str(masks),
        )
        pycolmap.logging.minloglevel = 2
        pycolmap.extract_features(
            database, images, camera_mode=pycolmap.CameraMode.SINGLE, reader_options=reader,
            device=pycolmap.Device.cpu,
        )  # fmt: skip
        pycolmap.match_sequential(database, device=pycolmap.Device.cpu)
        options = pycolmap.IncrementalPipelineOptions(
            ba_refine_focal_length=False, ba_refine_principal_point=False, ba_refine_extra_params=False
        )
        models = pycolmap.incremental_mapping(database, images, folder / "models", options)
        if not models:
            raise BaselineError(
                f"{scene.footage.id}: colmap found no model; too little parallax? try --vo opencv"
            )
        model = max(models.values(), key=lambda found: found.num_reg_images())
        T = scene.footage.num_frames
        poses, valid = np.tile(np.eye(4), (T, 1, 1)), np.zeros(T, dtype=bool)
        for image in model.images.values():
            frame = int(Path(image.name).stem)
            poses[frame, :3] = image.cam_from_world().inverse().matrix()
            valid[frame] = True
        notes = (f"odometry: {len(models)} colmap models, the largest counts",) if len(models) > 1 else ()
        return Odometry.from_poses(poses, valid, scene.mask_truth, notes)


def _write(scene: Scene, images: Path, masks: Path) -> None:
    cv2 = load_cv2()
    images.mkdir()
    masks.mkdir()
    diagonal = float(np.hypot(scene.footage.width, scene.footage.height))
    for frame, image in enumerate(scene.footage.images()):
        Image.fromarray(image).save(images / f"{frame:06d}.png", compress_level=1)
        static = static_world(cv2, scene.masker, frame, image, diagonal)
        Image.fromarray(static).save(masks / f"{frame:06d}.png.png", compress_level=1)


def _pycolmap() -> Any:
    try:
        import pycolmap
    except ImportError as error:
        raise BaselineError(
            f"--vo colmap needs pycolmap ({error}); pip install 'whacamole[colmap]', or choose --vo opencv"
        ) from error
    return pycolmap
