"""One offline HTML file of a scene: the viewer, every frame, a time bar, and a caption."""

from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any

from whacamole.dataset import Sequence
from whacamole.errors import DatasetError
from whacamole.labels.shading import track_colour
from whacamole.viewing.prediction import Prediction
from whacamole.viewing.scene3d import GROUND_TOUCH, PERSON_TOUCH, PREDICTED, TRUE_CAMERA, Rgb, Scene3D

__all__ = ["caption", "save_html"]

_STYLE = """
#about{position:fixed;left:12px;bottom:56px;z-index:9;max-width:21rem;font:13px/1.45 system-ui,sans-serif;
color:#222;background:#ffffffd9;border-radius:6px;padding:.5rem .8rem;box-shadow:0 1px 5px #0003}
#about summary{cursor:pointer;font-weight:600}
#about p{margin:.25rem 0 0!important}
"""


def save_html(scene: Scene3D, path: Path, on_frame: Callable[[int], None]) -> int:
    """Write every frame of a scene into one file that opens from disk; return its size in bytes.

    Args:
        on_frame: told after each frame.

    Raises:
        DatasetError: the file cannot be written.
    """
    sequence = scene.sequence
    recorder: Any = scene.server.get_scene_serializer()
    for frame in range(len(sequence)):
        scene.show(frame)
        recorder.insert_sleep(1.0 / float(sequence.facts["fps"]))
        on_frame(frame)
    page = str(recorder.as_html())
    about = f"<style>{_STYLE}</style>{_box(sequence, scene.prediction)}</body>"
    head, _, tail = page.rpartition("</body>")
    page = head + about + tail
    title = f"<title>{escape(sequence.id)}</title>"
    page = page.replace("</head>", f"{title}</head>", 1) if "<title>" not in page else _titled(page, title)
    beside = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        beside.write_text(page, encoding="utf-8")
        beside.replace(path)
    except OSError as error:
        raise DatasetError(f"{path}: {error.strerror or error}; choose a place that can be written") from None
    return path.stat().st_size


def _titled(page: str, title: str) -> str:
    head, _, rest = page.partition("<title>")
    return head + title + rest.partition("</title>")[2]


def _box(sequence: Sequence, prediction: Prediction | None) -> str:
    keys = "<p>Space: play, pause. Drag: turn. Right drag: move. Wheel: zoom.</p>"
    name = f"<summary>{escape(sequence.id)}</summary>"
    return f"<details id=about open>{name}{caption(sequence, prediction)}{keys}</details>"


def caption(sequence: Sequence, prediction: Prediction | None) -> str:
    """What the scene shows, as HTML paragraphs."""
    entries: list[tuple[Rgb | None, str]] = [(None, ", ".join(map(str, sequence.facts.get("shots", ()))))]
    for track_id in map(int, sequence.people["track_id"]):
        entries.append((track_colour(track_id), f"person {track_id}"))
    entries += [
        (GROUND_TOUCH, "touches the ground"),
        (PERSON_TOUCH, "touches a person"),
        (TRUE_CAMERA, "camera, with the frame it films"),
    ]
    if prediction is not None:
        entries.append((PREDICTED, f"predicted{f' by {prediction.method}' if prediction.method else ''}"))
        entries += [(None, note) for note in prediction.notes]
    return "".join(
        f"<p style='margin:.25rem 0 0;font-size:13px'>{_dot(colour)}{escape(text)}</p>"
        for colour, text in entries
    )


def _dot(colour: Rgb | None) -> str:
    if colour is None:
        return ""
    round_ = "display:inline-block;width:.7em;height:.7em;border-radius:50%;margin-right:.45em"
    return f"<i style='{round_};background:rgb{colour}'></i>"
