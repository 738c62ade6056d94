"""The viewer as a page on this machine: choose a sequence, play, step, show and hide."""

import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from typing import Any

from whacamole.errors import DatasetError
from whacamole.viewing.recording import caption
from whacamole.viewing.scene3d import LAYERS, Scene3D

__all__ = ["Viewer", "serving"]

SPEEDS = ("0.25", "0.5", "1", "2")


@contextmanager
def serving(host: str, port: int) -> Iterator[Any]:
    """Run viser's server; 0 takes any free port.

    Raises:
        DatasetError: viser is not installed, or the port is taken.
    """
    try:
        import viser
    except ImportError as error:
        raise DatasetError(
            f"`whacamole view` needs the extra view ({error}): pip install -c constraints.txt -e '.[view]'"
        ) from None
    if port:
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((host, port))
            except OSError as error:
                raise DatasetError(
                    f"{host}:{port}: {error.strerror}; name another with --host and --port"
                ) from None
    with redirect_stdout(StringIO()):  # its banner; the caller says where to look
        server = viser.ViserServer(host=host, port=port, verbose=False)
    try:
        yield server
    finally:
        with redirect_stdout(StringIO()):
            server.stop()


class Viewer:
    """Plays the sequences of a dataset.

    Args:
        server: from :func:`serving`.
        ids: sequences to choose from.
        open_scene: draws a sequence into the emptied scene.
        first: the id to begin with.
    """

    def __init__(
        self, server: Any, ids: tuple[str, ...], open_scene: Callable[[str], Scene3D], first: str
    ) -> None:
        self._server, self._open = server, open_scene
        self._lock = threading.RLock()
        gui = server.gui
        gui.configure_theme(control_layout="collapsible", show_logo=False, show_share_button=False)
        self._choice = gui.add_dropdown("Sequence", ids, initial_value=first)
        self._frame = gui.add_slider("Frame", min=0, max=1, step=1, initial_value=0)
        self._play = gui.add_checkbox("Play", initial_value=True)
        self._backward = gui.add_checkbox("Backward", initial_value=False)
        self._speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        with gui.add_folder("Show"):
            boxes = {name: gui.add_checkbox(name.capitalize(), initial_value=True) for name in LAYERS}
        self._about = gui.add_html("")
        self._scene = self._load(first)
        self._choice.on_update(lambda _: self._change())
        self._frame.on_update(lambda _: self._draw())
        for name, box in boxes.items():
            box.on_update(lambda _, name=name, box=box: self._toggle(name, box.value))
        self._boxes = boxes

    def _load(self, sequence_id: str) -> Scene3D:
        self._server.scene.reset()
        for node in LAYERS.values():
            self._server.scene.add_frame(node, show_axes=False)
        scene = self._open(sequence_id)
        self._frame.max = max(1, len(scene.sequence) - 1)
        self._about.content = f"<div style='padding:0 1em'>{caption(scene.sequence, scene.prediction)}</div>"
        return scene

    def _change(self) -> None:
        with self._lock:
            self._scene = self._load(self._choice.value)
            for name, box in self._boxes.items():
                self._toggle(name, box.value)
            self._frame.value = 0

    def _toggle(self, name: str, shown: bool) -> None:
        self._server.scene.get_handle_by_name(LAYERS[name]).visible = shown

    def _draw(self) -> None:
        with self._lock:
            self._scene.show(min(int(self._frame.value), len(self._scene.sequence) - 1))

    def run(self) -> None:
        """Play until interrupted."""
        while True:
            started = time.monotonic()
            with self._lock:
                count = len(self._scene.sequence)
                wait = 1.0 / float(self._scene.sequence.facts["fps"]) / float(self._speed.value)
                if self._play.value:
                    step = -1 if self._backward.value else 1
                    self._frame.value = (int(self._frame.value) + step) % count
            time.sleep(max(0.004, wait - (time.monotonic() - started)))
