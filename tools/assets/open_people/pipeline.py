"""The build from end to end."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from open_people import provenance, wardrobe
from open_people.base_mesh import BODY_VERTICES, BaseMesh, read_base_mesh
from open_people.body_file import BodyData, schema_arrays, topology_digest
from open_people.correctives import fit_correctives
from open_people.expressions import expression_directions
from open_people.fine_rig import FineRig
from open_people.landmarks import Face, face_landmarks, face_outline
from open_people.named_vertices import model_order, named_vertices
from open_people.proxies import read_proxy, tpose_offsets
from open_people.regressor import fit_joint_regressor
from open_people.rig import Rig, read_rig
from open_people.shape_space import ShapeSpace, draw_samples, fit_shape_space, shape_statistics
from open_people.skeleton import INDEX, joint_weights
from open_people.sources import Sources
from open_people.targets import MacroShape, TargetLibrary
from open_people.tpose import to_tpose
from whacamole.body.lean import pack
from whacamole.body.schema import BodyArrays, read_full, write_npz

SEED: Final = 0

NEUTRAL: Final = MacroShape(height=0.535, weight=0.58, muscle=0.52, proportions=0.6)
"""The adult on whom clothes are bound and correctives fitted: close to the mean of the shape space."""


def build(sources: Sources, work: Path, out: Path, samples: int) -> Iterator[str]:
    """Runs the build and says what it did, step by step."""
    mesh = read_base_mesh(sources.mpfb2)
    rig = read_rig(sources.mpfb2, mesh)
    targets = TargetLibrary(sources.mpfb2 / "targets", mesh.num_vertices)
    face_units = TargetLibrary(sources.face_units, mesh.num_vertices)
    yield f"read base mesh ({mesh.num_vertices} vertices) and rig ({len(rig.names)} bones)"

    data, fine = make_body(sources, mesh, rig, targets, face_units, samples)
    arrays = schema_arrays(data)
    write_npz(work / "open_body_full.npz", arrays)
    write_npz(out / "body" / "open_body.npz", pack(read_full(arrays, "the new body")))
    yield f"body: {len(data.order)} vertices"

    pieces = wardrobe.cut_pieces(sources, mesh, fine)
    yield write_wardrobe(sources, data, fine, pieces, out / "wardrobe")
    write_provenance(sources, pieces, out)
    size = sum(path.stat().st_size for name in ("body", "wardrobe") for path in _files(out / name))
    yield f"body and wardrobe: {size / 1e6:.2f} MB"


def write_wardrobe(
    sources: Sources, data: BodyData, fine: FineRig, pieces: list[wardrobe.Piece], folder: Path
) -> str:
    """Writes geometry, textures and catalogue, and returns a line about them."""
    support = wardrobe.support_vertices(pieces)
    write_npz(folder / "support.npz", pack(support_arrays(data, support)))
    write_npz(folder / "items.npz", wardrobe.item_arrays(pieces, support, fine, data.order))
    store = wardrobe.TextureStore()
    catalogue = {
        "items": wardrobe.item_entries(pieces, store),
        "skins": wardrobe.skin_entries(sources, data.mesh, store),
        "shape": data.statistics,
        "topology": topology_digest(schema_arrays(data)["quads"]),
    }
    wardrobe.write_textures(store, folder / "textures")
    text = json.dumps(catalogue, indent=1, sort_keys=True) + "\n"
    (folder / "catalogue.json").write_text(text, encoding="utf-8")
    return f"wardrobe: {len(pieces)} items on {len(support)} support vertices, {len(store.files)} textures"


def write_provenance(sources: Sources, pieces: list[wardrobe.Piece], out: Path) -> None:
    """Writes where everything comes from, and the licence, beside the files."""
    licence = (sources.mpfb2 / "LICENSE.md").read_text(encoding="utf-8")
    texts = {
        "body": provenance.body_text(out / "body"),
        "wardrobe": provenance.wardrobe_text(sources, pieces, out / "wardrobe"),
    }
    for name, text in texts.items():
        (out / name / "PROVENANCE.md").write_text(text, encoding="utf-8")
        (out / name / "LICENSE-CC0-1.0.txt").write_text(licence, encoding="utf-8")


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in folder.rglob("*") if path.is_file())


def make_body(
    sources: Sources,
    mesh: BaseMesh,
    rig: Rig,
    targets: TargetLibrary,
    face_units: TargetLibrary,
    samples: int,
) -> tuple[BodyData, FineRig]:
    """The body over all base vertices, and the neutral adult on both rigs."""
    adults = draw_samples(mesh, rig, targets, samples, SEED)
    space = fit_shape_space(mesh, adults)
    weights = joint_weights(rig)
    regressor = fit_joint_regressor(mesh, weights, adults, space)
    modelled = targets.morph(mesh.vertices, NEUTRAL)
    tpose = to_tpose(rig, modelled)
    fine = FineRig(rig, modelled, tpose, regressor @ tpose.vertices[mesh.model_vertices])
    face = _face(sources, mesh, fine, space)
    data = BodyData(
        mesh=mesh,
        space=space,
        expressions=expression_directions(face_units),
        correctives=fit_correctives(fine, face_units, mesh.mirror, SEED),
        weights=weights,
        regressor=regressor,
        order=model_order(mesh, named_vertices(mesh, rig, space.mean)),
        landmarks=face_landmarks(face),
        outline=face_outline(face),
        statistics=shape_statistics(adults, space),
    )
    return data, fine


def _face(sources: Sources, mesh: BaseMesh, fine: FineRig, space: ShapeSpace) -> Face:
    """The mean face, with an eyebrow item put on to tell where the brows are."""
    brow = read_proxy(sources.proxies / "eyebrows", "eyebrow001")
    offsets = tpose_offsets(brow, fine.rig, fine.modelled, fine.tpose)
    weights = fine.joint_weights[:BODY_VERTICES].toarray()
    jaw, head = INDEX["jaw"], [INDEX[name] for name in ("head", "jaw", "left_eye", "right_eye")]
    return Face(
        mesh=mesh,
        vertices=space.mean,
        masks=sources.mpfb2 / "textures",
        lower=weights[:, jaw] > 0.5,
        head=weights[:, head].sum(axis=1) > 0.8,
        brow=np.einsum("nk,nkc->nc", brow.weights, space.mean[brow.refs]) + offsets,
    )


def support_arrays(data: BodyData, support: NDArray[np.int64]) -> BodyArrays:
    """The vertices that clothes and hair hang on, in the form of a body model, so that they pose as the
    body does.

    They have no joints of their own (the regressor is empty) and no faces to draw; one dummy face keeps
    the form.
    """
    correctives = data.correctives[support]
    correctives = np.where(np.abs(correctives) < 1e-4, 0, correctives).reshape(3 * len(support), -1)
    return BodyArrays(
        v_template=data.space.mean[support].astype(np.float32),
        faces=np.zeros((1, 3), np.int32),
        shapedirs=np.ascontiguousarray(data.space.directions[:, support].transpose(1, 2, 0), np.float32),
        expression_dirs=np.ascontiguousarray(data.expressions[:, support].transpose(1, 2, 0), np.float32),
        posedirs=sparse.csr_array(correctives.astype(np.float32)),
        joint_regressor=sparse.csr_array((55, len(support)), dtype=np.float32),
        weights=data.weights[support].toarray().astype(np.float32),
        uv=np.zeros((1, 2), np.float32),
        uv_faces=np.zeros((1, 3), np.int32),
    )
