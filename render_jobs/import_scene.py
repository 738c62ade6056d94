"""``python -m render_jobs.import_scene FILE FOLDER PARENT``: one scene file in a process of its own.

A damaged file may take Blender down; here it takes nothing else with it. The last line of the output is a
JSON object with the ``error``, if there is one.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import traceback
from pathlib import Path

from render_jobs.errors import RenderJobError
from render_jobs.gltf_files import check_gltf
from render_jobs.imported import GLTF_SUFFIXES, ImportedScene
from render_jobs.processes import die_with_parent


def read_scene(file: Path, scratch: Path) -> ImportedScene:
    """Read a file with Blender, or with trimesh where there is no Blender.

    Args:
        file: the scene.
        scratch: where copies of its images go.

    Raises:
        RenderJobError: it cannot be used; the message does not name the file.
    """
    is_gltf = file.suffix.lower() in GLTF_SUFFIXES
    if is_gltf:
        check_gltf(file)
    try:
        importlib.import_module("bpy")
    except ImportError as error:
        if not is_gltf:
            raise RenderJobError(
                f"only Blender reads {file.suffix} files, and it cannot run here ({error}); "
                "export the stage as .glb"
            ) from error
        return importlib.import_module("render_jobs.gltf_scene").read(file, scratch)  # type: ignore[no-any-return]
    return importlib.import_module("render_jobs.blender.import_scene").read(file, scratch)  # type: ignore[no-any-return]


def main(file: str, folder: str, parent: str) -> None:
    """Read the file, write the folder, end the process."""
    die_with_parent(int(parent))
    status = 0
    try:
        read_scene(Path(file), Path(folder) / "images").save(Path(folder))
    except RenderJobError as error:
        status = _say(str(error))
    except Exception as error:  # whatever an importer stumbles over, the user gets one line
        traceback.print_exception(error)
        status = _say(f"cannot be read ({type(error).__name__}: {error}); save it again with Blender")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # taking Blender down at the interpreter's exit can hang


def _say(message: str) -> int:
    sys.stdout.write("\n" + json.dumps({"error": " ".join(message.split())}) + "\n")
    return 1


if __name__ == "__main__":
    main(*sys.argv[1:4])
