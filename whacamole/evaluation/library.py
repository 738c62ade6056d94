"""Where the body model of a person is found: the embedded one, or a file the user has."""

import re
from collections.abc import Callable, Iterable
from functools import cached_property
from pathlib import Path

from whacamole.body import BodyModel, BodyModelError
from whacamole.errors import EvaluationError
from whacamole.evaluation.bodies import Body, SmplBody, SmplxBody
from whacamole.evaluation.records import BodyKind, PersonTrack
from whacamole.evaluation.smpl import SmplModel

_KINDS: dict[str, BodyKind] = {"smplx": "smplx", "smplh": "smplh", "smpl": "smpl", "basicmodel": "smpl"}


class BodyLibrary:
    """Finds the body of a person.

    Args:
        files: model files, or folders that are searched for files with SMPL, SMPLH or SMPLX in their names.
        vertices: ``None`` for all, or about how many evenly spread vertices stand for all (a quick estimate
            of PVE; SMPL-X only).

    Raises:
        EvaluationError: a path is not there or its name does not say what it is.
    """

    def __init__(self, files: Iterable[Path] = (), vertices: int | None = None) -> None:
        self._vertices = vertices
        self._files: dict[tuple[BodyKind, str], Path] = {}
        self._bodies: dict[Path | None, Body] = {}
        for given in files:
            self._add(Path(given))

    def body_of(self, person: PersonTrack) -> Body:
        """The body of a person, loaded once.

        A person whose source names a model by its sha256 gets that model; else the one of its kind and
        gender.

        Raises:
            EvaluationError: no file for it was given, or the file cannot be used.
        """
        if person.kind == "smplx" and person.model_sha256:
            if self._embedded.matches(person.model_sha256):
                return self._made(None, lambda: SmplxBody(self._embedded, self._vertices))
            for (kind, _), path in self._files.items():
                if kind == "smplx":
                    body = self._load(path, kind)
                    if isinstance(body, SmplxBody) and body.model.matches(person.model_sha256):
                        return body
            name = f"SMPL-X model {person.model_sha256[:12]}…"
            raise EvaluationError(
                f"{name} is neither the embedded body nor given; add --body-model FILE "
                "(for data of another version: what its `whacamole body --export` writes)"
            )
        found = self._files.get((person.kind, person.gender))
        if found is None:
            wanted = f"{person.kind.upper().replace('X', '-X').replace('H', '-H')} {person.gender}"
            raise EvaluationError(
                f"no {wanted} body model was given; add --body-model with its file or folder"
            )
        return self._load(found, person.kind)

    @cached_property
    def _embedded(self) -> BodyModel:
        return BodyModel.embedded()

    def _add(self, given: Path) -> None:
        if not given.exists():
            raise EvaluationError(f"{given}: not there; check the path of the body model")
        inside = (p for p in given.rglob("*") if p.suffix in (".npz", ".pkl"))
        for path in [given] if given.is_file() else sorted(inside):
            kind = _kind_of(path)
            if kind:
                self._files.setdefault((kind, _gender_of(path)), path)
            elif given.is_file():
                raise EvaluationError(f"{path}: its name says neither SMPL, SMPLH nor SMPLX; rename it")

    def _load(self, path: Path, kind: BodyKind) -> Body:
        if kind != "smplx":
            return self._made(path, lambda: SmplBody(SmplModel.load(path)))
        try:
            return self._made(path, lambda: SmplxBody(BodyModel.load(path), self._vertices))
        except BodyModelError as error:
            raise EvaluationError(str(error)) from error

    def _made(self, key: Path | None, make: Callable[[], Body]) -> Body:
        if key not in self._bodies:
            self._bodies[key] = make()
        return self._bodies[key]


def _kind_of(path: Path) -> BodyKind | None:
    """From the file's name, else its folders': SMPLX_NEUTRAL.npz, smplh/male/model.npz."""
    for text in (path.stem.lower(), *(part.lower() for part in reversed(path.parts[-3:-1]))):
        found = re.match(r"(smplx|smplh|smpl|basicmodel)(?=[_.\-]|$)", text)
        if found:
            return _KINDS[found[1]]
    return None


def _gender_of(path: Path) -> str:
    text = "/".join(part.lower() for part in path.parts[-2:])
    if re.search(r"female|_f_", text):
        return "female"
    return "male" if re.search(r"male|_m_", text) else "neutral"
