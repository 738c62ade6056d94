"""``whacamole evaluate``: predictions against ground truth."""

from pathlib import Path
from typing import Annotated

import typer

__all__ = ["evaluate"]


def evaluate(
    data: Annotated[
        Path | None,
        typer.Option(help="A dataset, or a folder of EMDB, 3DPW, RICH or EgoBody.", show_default=False),
    ] = None,
    pred: Annotated[
        list[str] | None,
        typer.Option(
            help="Folder of predictions, or NAME=FOLDER; repeat to compare methods.", show_default=False
        ),
    ] = None,
    split: Annotated[str, typer.Option(help="Split of the data, or all.")] = "test",
    protocol: Annotated[str, typer.Option(help="whac, wham, tram, gvhmr, emdb or bedlam2.")] = "whac",
    choice: Annotated[
        list[str] | None,
        typer.Option(
            "--set", help="Change one choice of the protocol: segment_frames=200.", show_default=False
        ),
    ] = None,
    pred_format: Annotated[
        str, typer.Option(help="native, wham, tram, gvhmr, slahmr, prompthmr, tum, or auto to tell.")
    ] = "auto",
    body_model: Annotated[
        list[Path] | None,
        typer.Option(
            help="SMPL, SMPL-H or SMPL-X file, or a folder of them; may be repeated.", show_default=False
        ),
    ] = None,
    vertices: Annotated[
        str, typer.Option(help="all; none; or a number: PVE estimated on so many vertices of SMPL-X.")
    ] = "all",
    vertex_map: Annotated[
        Path | None, typer.Option(help="Sparse matrix from SMPL-X to SMPL vertices.", show_default=False)
    ] = None,
    joint_regressor: Annotated[
        Path | None, typer.Option(help="J_regressor_h36m.npy, for --set joints=h36m14.", show_default=False)
    ] = None,
    saved: Annotated[
        list[Path] | None,
        typer.Option(
            "--with", help="Saved result to set beside (or, without --data, to print).", show_default=False
        ),
    ] = None,
    tables: Annotated[str, typer.Option(help="headline, paper or all.")] = "headline",
    style: Annotated[str, typer.Option(help="text, markdown, latex or csv.")] = "text",
    json_file: Annotated[
        Path | None,
        typer.Option("--json", help="Write all numbers as JSON; - prints them.", show_default=False),
    ] = None,
    html: Annotated[
        Path | None, typer.Option(help="Write one offline HTML report.", show_default=False)
    ] = None,
    plots: Annotated[
        Path | None, typer.Option(help="Write SVG plots into this folder.", show_default=False)
    ] = None,
    save: Annotated[
        Path | None, typer.Option(help="Save the whole result, for --with.", show_default=False)
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Sequences scored at the same time.")] = 1,
    limit: Annotated[int | None, typer.Option(min=1, help="Score only the first so many sequences.")] = None,
    show_protocol: Annotated[
        bool, typer.Option("--show-protocol", help="Print the protocol's choices and stop.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Score predictions: the paper's tables, every public protocol, what was left out and why.

    A prediction that is missing or broken is named on one line, the rest is scored, and the exit code is 1.
    """
    from whacamole.evaluation.command import Request, run

    request = Request(
        data=data, pred=tuple(pred or ()), split=split, protocol=protocol, choices=tuple(choice or ()),
        pred_format=pred_format, body_model=tuple(body_model or ()), vertices=vertices, vertex_map=vertex_map,
        joint_regressor=joint_regressor, saved=tuple(saved or ()), tables=tables, style=style,
        json_file=json_file, html=html, plots=plots, save=save, jobs=jobs, limit=limit,
        show_protocol=show_protocol, quiet=quiet,
    )  # fmt: skip
    raise typer.Exit(run(request, out=typer.echo, err=lambda line: typer.echo(line, err=True)))
