"""The body model: any SMPL-X-schema file, or the body embedded in the package, posed in NumPy."""

import hashlib
import io
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np
import numpy.typing as npt

from whacamole.body.geometry import mesh_volume
from whacamole.body.joints import JOINT_INDEX, JOINT_NAMES, NUM_BETAS, PARENTS
from whacamole.body.lean import LEAN_KEY, unpack
from whacamole.body.params import BodyParams
from whacamole.body.schema import BodyArrays, NpzReader, full_arrays, read_full, write_npz
from whacamole.body.skinning import BLOCK, Skin, forward_kinematics, rotations, skin_block
from whacamole.errors import BodyModelError

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
Int32Array = npt.NDArray[np.int32]

EMBEDDED_NAME = "whacamole-open-body"
_EMBEDDED_FILE = ("assets", "body", "open_body.npz")


@dataclass(frozen=True, eq=False)
class Posed:
    """A body over T frames.

    Attributes:
        vertices: (T, V, 3) float32 [m], in the frame of the parameters.
        joints: (T, 55, 3) float64 [m].
    """

    vertices: Float32Array
    joints: FloatArray


class BodyModel:
    """One SMPL-X model, ready to pose. Its arrays are not to be written to.

    Attributes:
        name: the file's stem, or ``whacamole-open-body``.
        sha256: of the model file, the one in the package for the embedded body.
        source_sha256: for a file written by :meth:`export_full`, the ``sha256`` of the model it stands for.
        gender: "neutral", "male" or "female".
    """

    parents: npt.NDArray[np.int64] = np.array(PARENTS, dtype=np.int64)
    joint_names: tuple[str, ...] = JOINT_NAMES
    parents.setflags(write=False)

    def __init__(self, arrays: BodyArrays, *, name: str, sha256: str, gender: str = "neutral") -> None:
        self.arrays = arrays
        self.name = name
        self.sha256 = sha256
        self.gender = gender
        self.source_sha256 = str(arrays.extras.get("source_sha256", ""))
        self._skin = Skin.build(arrays.expression_dirs, arrays.posedirs, arrays.weights)
        self._shape_dirs = arrays.shapedirs.reshape(-1, NUM_BETAS)
        # Joints are linear in the coefficients, so the regressor meets the 10 000 vertices once, here.
        regress = arrays.joint_regressor.astype(np.float64)
        self._joint_template = regress @ arrays.v_template
        both = np.concatenate([arrays.shapedirs, arrays.expression_dirs], axis=2, dtype=np.float64)
        self._joint_dirs = (regress @ both.reshape(len(both), -1)).reshape(len(PARENTS), 3, -1)

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read a model file: full SMPL-X schema (``SMPLX_NEUTRAL.npz`` …) or lean.

        Raises:
            BodyModelError: the file cannot be used; one line with what is wrong and what to do.
        """
        path = Path(path)
        if path.is_dir():
            inside = sorted(p.name for p in path.glob("*.npz"))
            hint = f"name one of {', '.join(inside)}" if inside else "name an SMPL-X .npz file"
            raise BodyModelError(f"{path}: a folder; {hint}")
        try:
            with path.open("rb") as stream:
                sha256 = hashlib.file_digest(stream, "sha256").hexdigest()
                stream.seek(0)
                arrays = _read(stream, str(path))
        except OSError as error:
            raise BodyModelError(
                f"{path}: {error.strerror or error}; check the path of the body model"
            ) from error
        return cls(arrays, name=path.stem, sha256=sha256, gender=_gender(path.stem, arrays.extras))

    @classmethod
    def embedded(cls) -> "BodyModel":
        """The CC0 body inside the package (see docs/body.md); read once and shared."""
        return _embedded()

    @property
    def v_template(self) -> Float32Array:
        """(V, 3) [m], T-pose, y up, facing +z."""
        return self.arrays.v_template

    @property
    def faces(self) -> Int32Array:
        """(F, 3)."""
        return self.arrays.faces

    @property
    def quads(self) -> Int32Array | None:
        """(Q, 4), the surface before it was cut into triangles, where the file has it."""
        return self.arrays.quads

    @property
    def uv(self) -> Float32Array:
        """(VT, 2)."""
        return self.arrays.uv

    @property
    def uv_faces(self) -> Int32Array:
        """(F, 3) into ``uv``."""
        return self.arrays.uv_faces

    @property
    def uv_quads(self) -> Int32Array | None:
        """(Q, 4) into ``uv``, where the file has it."""
        return self.arrays.uv_quads

    @property
    def weights(self) -> Float32Array:
        """(V, 55) skinning weights."""
        return self.arrays.weights

    @property
    def extras(self) -> Mapping[str, npt.NDArray[Any]]:
        """The file's other plain arrays by key, landmarks and hand means among them."""
        return self.arrays.extras

    @property
    def num_vertices(self) -> int:
        """V."""
        return len(self.arrays.v_template)

    def matches(self, sha256: str) -> bool:
        """Whether labels naming ``sha256`` are about this model: the file, or what it was exported from."""
        return sha256 in {self.sha256, self.source_sha256} - {""}

    def rest_vertices(self, betas: npt.ArrayLike) -> Float32Array:
        """Vertices (V, 3) [m] of a shape (10,) at rest, expression zero."""
        return self._shaped(_coefficients(betas)[None]).reshape(-1, 3)

    def rest_joints(self, betas: npt.ArrayLike, expression: npt.ArrayLike | None = None) -> FloatArray:
        """Joints at rest [m]: (55, 3) for betas (10,); (T, 55, 3) for betas (T, 10) or expression (T, 10)."""
        rest: FloatArray = self._joint_template + _mix(
            self._joint_dirs[..., :NUM_BETAS], _coefficients(betas)
        )
        if expression is not None:
            rest = rest + _mix(self._joint_dirs[..., NUM_BETAS:], _coefficients(expression))
        return rest

    def pose(self, params: BodyParams) -> Posed:
        """Vertices and joints of every frame.

        A frame comes out the same to the bit whatever the frames beside it, so ``pose(p.slice(a, b))``
        equals the part a:b of ``pose(p)``: take slices to bound the memory of a long motion.
        """
        T = params.num_frames
        vertices = np.empty((T, self.num_vertices, 3), dtype=np.float32)
        joints = np.empty((T, len(PARENTS), 3))
        rest = np.broadcast_to(self.rest_joints(params.betas, params.expression), joints.shape)
        full = params.full_pose()
        fixed = self._shaped(params.betas[None]) if params.betas.ndim == 1 else None
        for start in range(0, T, BLOCK):
            part = slice(start, min(start + BLOCK, T))
            shaped = self._shaped(params.betas[part]) if fixed is None else fixed
            local = rotations(full[part])
            block, placed = skin_block(self._skin, shaped, params.expression[part], local, rest[part])
            block += params.transl[part].T.astype(np.float32)
            vertices[part] = block.transpose(2, 0, 1)
            joints[part] = placed + params.transl[part, None]
        return Posed(vertices, joints)

    def pose_joints(self, params: BodyParams) -> FloatArray:
        """The joints alone (T, 55, 3) [m], the same numbers as :meth:`pose` at a fraction of its cost."""
        rest = self.rest_joints(params.betas, params.expression)
        placed = forward_kinematics(rotations(params.full_pose()), rest)[1]
        return placed + params.transl[:, None]

    def stature(self, betas: npt.ArrayLike) -> float:
        """Height from the soles to the crown at rest [m]."""
        return float(np.ptp(self.rest_vertices(betas)[:, 1]))

    def leg_length(self, betas: npt.ArrayLike) -> float:
        """Hip to knee to ankle at rest, mean of both legs [m]."""
        rest = self.rest_joints(betas)
        chains = (
            [JOINT_INDEX[f"{side}_{name}"] for name in ("hip", "knee", "ankle")] for side in ("left", "right")
        )
        return float(
            np.mean([np.linalg.norm(np.diff(rest[chain], axis=0), axis=1).sum() for chain in chains])
        )

    def pelvis_height(self, betas: npt.ArrayLike) -> float:
        """Pelvis joint above the soles at rest [m]: what stands a person on the ground."""
        return float(self.rest_joints(betas)[0, 1] - self.rest_vertices(betas)[:, 1].min())

    def volume(self, betas: npt.ArrayLike) -> float:
        """Volume enclosed at rest [m³]; the parts of the mesh are taken as closed."""
        return float(mesh_volume(self.rest_vertices(betas), self.faces))

    def export_full(self, path: Path | str) -> Path:
        """Write the model with all keys of the SMPL-X schema, for the ``smplx`` package and Blender add-ons.

        The file also holds ``source_sha256``, this model's ``sha256``, by which labels made with one are
        known to fit the other. The same model gives the same bytes (with one version of zlib).

        Raises:
            BodyModelError: the file cannot be written.
        """
        path = Path(path)
        arrays = full_arrays(self.arrays) | {
            "joint_names": np.array(self.joint_names),
            "gender": np.array(self.gender),
            "source_sha256": np.array(self.source_sha256 or self.sha256),
        }
        try:
            write_npz(path, arrays)
        except OSError as error:
            raise BodyModelError(
                f"{path}: {error.strerror or error}; choose a place that can be written"
            ) from error
        return path

    def _shaped(self, betas: FloatArray) -> Float32Array:
        """Rest vertices (3V, n) for betas (n, 10), summed in the order of the coefficients."""
        shaped = np.repeat(self.arrays.v_template.reshape(-1, 1), len(betas), axis=1)
        for k, coefficient in enumerate(betas.T.astype(np.float32)):
            shaped += self._shape_dirs[:, k, None] * coefficient
        return shaped


@cache
def _embedded() -> BodyModel:
    data = files("whacamole").joinpath(*_EMBEDDED_FILE).read_bytes()
    arrays = _read(io.BytesIO(data), _EMBEDDED_FILE[-1])
    return BodyModel(arrays, name=EMBEDDED_NAME, sha256=hashlib.sha256(data).hexdigest())


def _read(stream: BinaryIO, label: str) -> BodyArrays:
    reader = NpzReader(stream, label)
    if LEAN_KEY not in reader:
        return read_full(reader, label)
    try:
        return unpack(reader, label)
    except (KeyError, ValueError) as error:
        raise BodyModelError(f"{label}: not a whole lean body ({error}); pack it again") from error


def _gender(stem: str, extras: Mapping[str, npt.NDArray[Any]]) -> str:
    """From the file's own key, else from its name, as in ``SMPLX_FEMALE``."""
    stated = str(extras.get("gender", "")) or stem.lower()
    return next((gender for gender in ("female", "male", "neutral") if gender in stated), "neutral")


def _coefficients(values: npt.ArrayLike) -> FloatArray:
    """Shape or expression coefficients as (…, 10)."""
    array = np.asarray(values, dtype=np.float64)
    if array.shape[-1:] != (NUM_BETAS,):
        raise ValueError(f"coefficients: shape {array.shape}, expected (…, {NUM_BETAS})")
    return array


def _mix(dirs: FloatArray, coefficients: FloatArray) -> FloatArray:
    """Directions (55, 3, 10) weighted by (…, 10), added one by one so that the order is fixed."""
    total = np.zeros((*coefficients.shape[:-1], *dirs.shape[:2]))
    for k in range(dirs.shape[-1]):
        total += dirs[..., k] * coefficients[..., k, None, None]
    return total
