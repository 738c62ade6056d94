"""``whacamole render``: motions in, a labelled dataset out."""

from pathlib import Path
from typing import Annotated, Any

import typer

from whacamole.cli.options import OwnBodyModel

__all__ = ["render"]


def render(
    motions: Annotated[
        Path | None,
        typer.Option(
            help="Folder (searched through) or file of motion capture.", show_default="embedded motions"
        ),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder of the dataset.")] = Path("dataset"),
    shots: Annotated[
        str | None,
        typer.Option(
            help="Camera moves to choose from, such as arc,tracking.",
            show_default="auto: the director's choice",
        ),
    ] = None,
    shots_per_motion: Annotated[
        int | None, typer.Option(help="Sequences made of each motion.", show_default="1")
    ] = None,
    people: Annotated[
        str | None,
        typer.Option(help="People in a scene of single motions: 3, or 1-6.", show_default="1"),
    ] = None,
    stages: Annotated[
        str | None,
        typer.Option(
            help="Places to choose from: names such as plaza,park, and files or a folder of your own.",
            show_default="all that are built in",
        ),
    ] = None,
    hdris: Annotated[
        Path | None,
        typer.Option(
            help="Folder of .exr and .hdr maps to light stages under a sky.", show_default="built-in skies"
        ),
    ] = None,
    frames: Annotated[
        int | None,
        typer.Option(help="Frames a sequence at most; 0: the whole motion.", show_default="240"),
    ] = None,
    size: Annotated[str | None, typer.Option(help="WIDTHxHEIGHT in pixels.", show_default="640x360")] = None,
    fps: Annotated[float | None, typer.Option(help="Frames a second.", show_default="30")] = None,
    focal_mm: Annotated[
        str | None,
        typer.Option(
            help="Lens, as focal length on 36 mm film along the longer side: 35, or 24,50.",
            show_default="24,50",
        ),
    ] = None,
    quality: Annotated[
        str | None, typer.Option(help="draft, standard or high.", show_default="standard")
    ] = None,
    engine: Annotated[
        str | None, typer.Option(help="auto, cycles, raster or eevee.", show_default="auto")
    ] = None,
    motion_blur: Annotated[
        str | None,
        typer.Option(
            help="Share of the frame time that the shutter is open: 0.5, or 0.2,0.5.", show_default="0"
        ),
    ] = None,
    f_number: Annotated[
        str | None,
        typer.Option(help="Depth of field: the lens's f-number, 2.8 or 2,5.6.", show_default="none"),
    ] = None,
    exposure: Annotated[
        str | None,
        typer.Option(help="Stops over the stage's own exposure: 0.5, or -0.5,0.5.", show_default="0"),
    ] = None,
    noise: Annotated[
        str | None,
        typer.Option(help="Sensor noise at middle grey in 8-bit levels: 4, or 0,6.", show_default="0"),
    ] = None,
    passes: Annotated[
        str | None,
        typer.Option(
            help="What to render: rgb,mask,depth and, as wanted, normal,flow.", show_default="rgb,mask,depth"
        ),
    ] = None,
    image_format: Annotated[
        str | None, typer.Option(help="jpg, png or mp4, of the colour frames.", show_default="jpg")
    ] = None,
    body_model: OwnBodyModel = None,
    textures: Annotated[
        Path | None,
        typer.Option(
            help="Folder of pictures for the body model's UV map, worn in place of clothes.",
            show_default="clothes of ours",
        ),
    ] = None,
    contact_regions: Annotated[
        Path | None,
        typer.Option(
            help="JSON or .npz of the body model's vertices by region, to name contacts by.",
            show_default="21 parts",
        ),
    ] = None,
    self_contact: Annotated[
        bool | None,
        typer.Option("--self-contact", help="Label people who touch themselves, too.", show_default="off"),
    ] = None,
    seed: Annotated[int | None, typer.Option(help="The one seed of all choices.", show_default="0")] = None,
    limit: Annotated[
        int | None, typer.Option(help="Make at most so many sequences.", show_default="no limit")
    ] = None,
    allow_breaches: Annotated[
        bool | None,
        typer.Option("--allow-breaches", help="Render cameras that break a rule, too.", show_default="off"),
    ] = None,
    recipe: Annotated[
        Path | None, typer.Option(help="YAML file of these options; what is typed here goes over it.")
    ] = None,
    jobs: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Sequences made at the same time; with --cluster slurm, most jobs.",
            show_default="what suits the machine",
        ),
    ] = None,
    threads: Annotated[
        int, typer.Option(min=0, help="Processor threads of each sequence; 0: an even share.")
    ] = 0,
    device: Annotated[
        str,
        typer.Option(
            help="Where to render: auto (a GPU where Blender finds one), cpu, gpu, or one as cuda:0."
        ),
    ] = "auto",
    cluster: Annotated[
        str | None,
        typer.Option(
            help="Dask scheduler that does the work, as tcp://host:8786; or slurm.",
            show_default="this machine",
        ),
    ] = None,
    cluster_config: Annotated[
        Path | None, typer.Option(help="YAML file on the jobs of --cluster slurm (docs/scale.md).")
    ] = None,
    shard: Annotated[
        str | None,
        typer.Option(help="Make one part of the work, as 2/8; for job arrays.", show_default="all of it"),
    ] = None,
    attempts: Annotated[int, typer.Option(min=1, help="How often a sequence is tried.")] = 3,
    silence: Annotated[
        float, typer.Option(min=1, help="Seconds a frame may take before its process counts as hung.")
    ] = 1800,
    time_limit: Annotated[
        float | None,
        typer.Option(min=1, help="Seconds an attempt at a sequence may take.", show_default="no limit"),
    ] = None,
    memory_limit: Annotated[
        float | None,
        typer.Option(
            min=0.1, help="GB a process may hold before it is ended.", show_default="90 % of the machine's"
        ),
    ] = None,
    disk_check: Annotated[
        bool, typer.Option("--disk-check/--no-disk-check", help="Refuse what the disk cannot hold.")
    ] = True,
    profile: Annotated[
        bool, typer.Option("--profile", help="End with a table of where the time went.")
    ] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="List what would be made and stop.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Make a dataset: people from motion capture, filmed by a moving camera, with exact labels.

    Stopped at any moment and started again with the same options, it goes on where it was.
    """
    from render_jobs.devices import parse_device
    from whacamole.dataset.layout import DatasetLayout
    from whacamole.production.means import Limits, Means, Shard
    from whacamole.production.opening import EngineSearch
    from whacamole.recipe import load_recipe

    parse_device(device)  # a mistyped name is told before anything begins
    given = {
        "motions": motions, "shots": shots, "shots_per_motion": shots_per_motion, "frames": frames,
        "people": people, "stages": stages, "hdris": hdris,
        "motion_blur": motion_blur, "f_number": f_number, "exposure": exposure, "noise": noise,
        "size": size, "fps": fps, "focal_mm": focal_mm, "quality": quality, "engine": engine,
        "passes": passes,
        "image_format": image_format, "body_model": body_model, "textures": textures,
        "contact_regions": contact_regions, "self_contact": self_contact, "seed": seed, "limit": limit,
        "allow_breaches": allow_breaches,
    }  # fmt: skip
    overrides: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    asked = load_recipe(recipe, overrides)
    # begun before the rest of the package is loaded, which takes about as long
    search = None if dry_run else EngineSearch(asked, DatasetLayout(out.resolve()))
    from whacamole.production.run import produce

    means = Means(
        jobs=jobs,
        cluster=cluster,
        cluster_config=cluster_config,
        shard=Shard.parse(shard) if shard else None,
        attempts=attempts,
        limits=Limits(
            threads=threads,
            device=device,
            silence_s=silence,
            time_s=time_limit,
            memory_mb=memory_limit * 1000 if memory_limit else None,
        ),
        check_disk=disk_check,
    )
    try:
        result = produce(asked, out, means, dry_run=dry_run, quiet=quiet or json_output, search=search)
    except KeyboardInterrupt:  # told here, as typer ends the program without a word
        typer.echo("stopped; finished sequences are kept, the same command goes on", err=True)
        raise typer.Exit(130) from None
    result.report(quiet=quiet, as_json=json_output, profile=profile)
    raise typer.Exit(0 if result.complete else 1)
