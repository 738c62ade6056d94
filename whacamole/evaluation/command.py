"""What ``whacamole evaluate`` does: options in, tables and files out, an exit code."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from whacamole.errors import EvaluationError
from whacamole.evaluation.evaluate import Bodies, evaluate
from whacamole.evaluation.protocol import Protocol, protocol_named
from whacamole.evaluation.report.document import as_document, as_json, tables_of
from whacamole.evaluation.report.html import as_html
from whacamole.evaluation.report.plots import write_plots
from whacamole.evaluation.report.table import WRITERS
from whacamole.evaluation.result import Result
from whacamole.evaluation.scores import SequenceScore
from whacamole.evaluation.truth.source import open_truth

if TYPE_CHECKING:
    from rich.progress import Progress

Print = Callable[[str], None]

SCORED, INCOMPLETE = 0, 1
"""Exit codes: everything was scored; something was not."""


@dataclass(frozen=True)
class Request:
    """The options of the command, as typed."""

    data: Path | None
    pred: tuple[str, ...]
    split: str
    protocol: str
    choices: tuple[str, ...]
    pred_format: str
    body_model: tuple[Path, ...]
    vertices: str
    vertex_map: Path | None
    joint_regressor: Path | None
    saved: tuple[Path, ...]
    tables: str
    style: str
    json_file: Path | None
    html: Path | None
    plots: Path | None
    save: Path | None
    jobs: int
    limit: int | None
    show_protocol: bool
    quiet: bool


def run(request: Request, *, out: Print, err: Print) -> int:
    """Do what the options say and return the exit code.

    Raises:
        EvaluationError: an option is wrong or nothing can be scored.
    """
    protocol = chosen_protocol(request)
    if request.show_protocol:
        out(describe(protocol))
        return SCORED
    if request.style not in WRITERS:
        raise EvaluationError(f"--style {request.style}: only {', '.join(WRITERS)}")
    result = _result(request, protocol, err)
    if request.save is not None:
        result.save(request.save)
    if request.html is not None:
        _write(request.html, as_html(result))
    if request.plots is not None:
        write_plots(result, request.plots)
    to_screen = request.json_file is not None and str(request.json_file) == "-"
    if request.json_file is not None:
        text = json.dumps(as_json(result), indent=1, allow_nan=False)
        _write(request.json_file, text + "\n") if not to_screen else out(text)
    if not request.quiet and not to_screen:
        out(as_document(result, request.style, request.tables))
        _notes(result, err)
    else:
        tables_of(result, request.tables)  # a wrong --tables is an error also when nothing is printed
    return SCORED if result.complete else INCOMPLETE


def chosen_protocol(request: Request) -> Protocol:
    """The named protocol with the choices that were set.

    Raises:
        EvaluationError: an unknown name, choice or value.
    """
    protocol = protocol_named(request.protocol)
    given = {}
    for text in request.choices:
        key, equals, value = text.partition("=")
        if not equals:
            raise EvaluationError(f"--set {text}: expected CHOICE=VALUE, such as segment_frames=200")
        given[key.strip()] = value.strip()
    return protocol.with_choices(given) if given else protocol


def describe(protocol: Protocol) -> str:
    """The choices of a protocol, one a line."""
    rows = protocol.choices()
    name, value = (max(len(row[i]) for row in rows) for i in (0, 1))
    return "\n".join(f"{key:<{name}}  {given:<{value}}  {about}" for key, given, about in rows)


def _result(request: Request, protocol: Protocol, err: Print) -> Result:
    results = [Result.load(path) for path in request.saved]
    if request.data is not None:
        if not request.pred:
            raise EvaluationError("no predictions: add --pred FOLDER")
        bodies = Bodies(
            request.body_model, _vertices(request.vertices), request.vertex_map, request.joint_regressor
        )

        source = open_truth(request.data)
        folders = _named(request.pred)
        bar = _bar(quiet=request.quiet)
        sequences = len(source.ids(request.split)[: request.limit])
        task = bar.add_task("scoring", total=sequences * len(folders))

        def progress(method: str, sequence_id: str, outcome: SequenceScore | str) -> None:
            bar.update(task, advance=1, description=f"{sequence_id} · {method}")
            if isinstance(outcome, str):
                err(f"{method} · {sequence_id}: {outcome}")

        with bar:
            scored = evaluate(
                source, folders, protocol, split=request.split, format=request.pred_format, bodies=bodies,
                jobs=request.jobs, limit=request.limit, progress=progress,
            )  # fmt: skip
        results.insert(0, scored)
    if not results:
        raise EvaluationError("nothing to score: give --data and --pred, or --with a saved result")
    first, *others = results
    for other in others:
        first = first.joined(other)
    return first


def _bar(*, quiet: bool) -> "Progress":
    """Progress on a terminal; nothing where errors go to a file."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    return Progress(*columns, console=console, disable=quiet or not console.is_terminal, transient=True)


def _named(given: tuple[str, ...]) -> dict[str, Path]:
    """Folders of predictions by method; a folder's own name stands for a missing one."""
    folders: dict[str, Path] = {}
    for text in given:
        name, equals, folder = text.partition("=")
        path = Path(folder if equals else text)
        key = name if equals else path.resolve().name
        if key in folders:
            raise EvaluationError(f"--pred {text}: a second method named {key}; write NAME=FOLDER")
        folders[key] = path
    return folders


def _vertices(text: str) -> bool | int:
    if text in ("all", "none"):
        return text == "all"
    if text.isdigit() and int(text) > 0:
        return int(text)
    raise EvaluationError(f"--vertices {text}: expected all, none or a number of vertices")


def _notes(result: Result, err: Print) -> None:
    """Each note once, with the number of sequences it is about."""
    for method in result.methods:
        counted: dict[str, int] = {}
        for score in method.sequences.values():
            for note in score.notes:
                counted[note] = counted.get(note, 0) + 1
        for note, count in counted.items():
            err(f"note: {method.name}: {note} ({count} of {len(method.sequences)} sequences)")


def _write(path: Path, text: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise EvaluationError(
            f"{path}: {error.strerror or error}; choose a place that can be written"
        ) from error
