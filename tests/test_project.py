"""What the project promises about itself: its files, its surface, its import rules, its command line."""

import ast
import importlib
import importlib.metadata
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
import typer
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import whacamole
from whacamole.cli import app

ROOT = Path(__file__).parents[1]
PYPROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())
MARKDOWN = sorted(path for folder in (".", "docs", "examples") for path in (ROOT / folder).glob("*.md"))
PACKAGES = ("camera_rigs", "render_jobs", "whacamole")

# --- Files -----------------------------------------------------------------------------------------------


def _links(path: Path) -> list[str]:
    """Targets of the links and pictures of a Markdown file, code left out."""
    prose = re.sub(r"```.*?```|`[^`\n]*`", "", path.read_text(), flags=re.DOTALL)
    return re.findall(r"\]\(([^)\s]+)\)", prose) + re.findall(r'src="([^"]+)"', prose)


def _anchors(path: Path) -> set[str]:
    """The anchors that GitHub gives the headings of a Markdown file."""
    headings = re.findall(r"^#+ (.+)$", path.read_text(), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("path", MARKDOWN, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_relative_links_lead_somewhere(path: Path) -> None:
    for link in _links(path):
        if re.match(r"[a-z]+:", link):
            continue
        target, _, anchor = link.partition("#")
        file = (path.parent / target) if target else path
        assert file.exists(), f"{link} does not exist"
        assert not anchor or anchor in _anchors(file), f"{link}: no such heading"


def test_the_code_names_documents_that_exist() -> None:
    for folder in (*PACKAGES, "tools", "benchmarks", "examples"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for name in re.findall(r"docs/[\w/-]+\.md", path.read_text()):
                assert (ROOT / name).exists(), f"{path.relative_to(ROOT)} names {name}"


def test_the_licence_is_the_one_that_is_declared() -> None:
    assert PYPROJECT["project"]["license"] == "GPL-3.0-or-later"
    text = (ROOT / "LICENSE").read_text()
    assert "GNU GENERAL PUBLIC LICENSE" in text
    assert "Version 3, 29 June 2007" in text


def test_the_version_is_one() -> None:
    assert PYPROJECT["project"]["version"] == whacamole.__version__
    released = re.findall(r"^## \[(\d[^\]]*)\]", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)
    assert not released or released[0] == whacamole.__version__


def _requirements() -> Iterator[Requirement]:
    project = PYPROJECT["project"]
    for lines in (project["dependencies"], *project["optional-dependencies"].values()):
        yield from map(Requirement, lines)


def _constraints() -> dict[str, str]:
    lines = (ROOT / "constraints.txt").read_text().splitlines()
    pins = [line for line in lines if not line.startswith("#")]
    for line in pins:
        assert re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.]+", line), f"{line!r} is not a plain name==version"
    return {canonicalize_name(line.split("==")[0]): line.split("==")[1] for line in pins}


def test_every_requirement_has_a_tested_version() -> None:
    constraints = _constraints()
    for requirement in _requirements():
        version = constraints.get(canonicalize_name(requirement.name))
        assert version, f"{requirement.name} has no line in constraints.txt"
        assert requirement.specifier.contains(version), f"{requirement} excludes {version}"


def test_what_the_requirements_bring_has_a_tested_version_too() -> None:
    """Follows the installed packages from the requirements down, for this platform."""
    constraints = _constraints()
    waiting = [(canonicalize_name(r.name), frozenset(r.extras)) for r in _requirements()]
    seen = set(waiting)
    while waiting:
        name, extras = waiting.pop()
        try:
            lines = importlib.metadata.requires(name) or []
        except importlib.metadata.PackageNotFoundError:
            continue
        # The CUDA build of torch brings a family of packages that the CPU build, which is tested, has not.
        assert name in constraints or name.startswith(("nvidia-", "cuda-", "triton")), f"{name} is untested"
        for requirement in map(Requirement, lines):
            environments = [{"extra": extra} for extra in ("", *extras)]
            needed = not requirement.marker or any(map(requirement.marker.evaluate, environments))
            found = (canonicalize_name(requirement.name), frozenset(requirement.extras))
            if needed and found not in seen:
                seen.add(found)
                waiting.append(found)


def _imported(folder: Path) -> dict[str, Path]:
    """Top-level modules that the code of a folder imports, at the top or later, with a file that does so."""
    found: dict[str, Path] = {}
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                found |= {alias.name.split(".")[0]: path for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
                found[node.module.split(".")[0]] = path
    return found


@pytest.mark.parametrize("folder", [*PACKAGES, "tests", "tools", "benchmarks", "examples"])
def test_what_is_imported_is_required(folder: str) -> None:
    declared = {canonicalize_name(requirement.name) for requirement in _requirements()}
    beside = {path.stem for path in (ROOT / folder).rglob("*.py")}
    tools = {"open_people", "hard_poses", "people_audit", "seen"}  # of tools/assets
    ours = {*PACKAGES, "tests", "tools", "benchmarks", *tools, *beside}
    inside_blender = {"bmesh", "gpu", "mathutils"}
    distributions = importlib.metadata.packages_distributions()
    for name, path in _imported(ROOT / folder).items():
        if name in sys.stdlib_module_names or name in ours or name in inside_blender:
            continue
        owners = {canonicalize_name(owner) for owner in distributions.get(name, [name])}
        assert owners & declared, (
            f"{path.relative_to(ROOT)} imports {name}, which pyproject.toml does not name"
        )


def test_the_extras_that_messages_name_exist() -> None:
    extras = set(PYPROJECT["project"]["optional-dependencies"])
    for path in (*MARKDOWN, *(path for folder in PACKAGES for path in (ROOT / folder).rglob("*.py"))):
        for named in re.findall(r"whacamole\[([\w,-]+)\]", path.read_text()):
            assert set(named.split(",")) <= extras, f"{path.relative_to(ROOT)} names whacamole[{named}]"


# --- Surface and imports ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", PACKAGES)
def test_what_a_package_exports_exists_and_is_documented(name: str) -> None:
    package = importlib.import_module(name)
    assert package.__doc__
    exported = getattr(package, "__all__", [])
    assert len(set(exported)) == len(exported)
    for entry in exported:
        value = getattr(package, entry)
        if callable(value):
            assert value.__doc__, f"{name}.{entry} has no docstring"


def test_the_packages_are_typed_for_those_who_use_them() -> None:
    for name in PACKAGES:
        assert (ROOT / name / "py.typed").exists()


def test_imports_point_one_way() -> None:
    command = [sys.executable, "-c", "from importlinter.cli import lint_imports_command as main; main()"]
    result = subprocess.run(
        [*command, "--no-cache"], cwd=ROOT, capture_output=True, text=True, timeout=300, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.parametrize(
    ("statement", "unwanted"),
    [
        ("import camera_rigs", {"bpy", "pydantic", "torch", "trimesh", "PIL", "render_jobs", "whacamole"}),
        ("import render_jobs", {"bpy", "pyrender", "torch", "whacamole"}),
        ("import whacamole", {"numpy", "bpy", "pyrender", "torch", "typer"}),
        ("import whacamole.cli", {"numpy", "scipy", "bpy", "pyrender", "torch", "PIL", "av"}),
    ],
)
def test_an_import_costs_what_it_must(statement: str, unwanted: set[str]) -> None:
    code = f"import sys; {statement}; print(*sys.modules)"
    listing = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert unwanted.isdisjoint(listing.split())


# --- Command line ----------------------------------------------------------------------------------------


def _commands() -> Iterator[tuple[str, click.Command]]:
    """Every command with its full name, groups opened."""
    waiting = [("whacamole", typer.main.get_command(app))]
    while waiting:
        name, command = waiting.pop()
        yield name, command
        children = getattr(command, "commands", {})
        waiting += [(f"{name} {child}", children[child]) for child in children]


def test_every_command_and_option_has_help() -> None:
    for name, command in _commands():
        assert command.help, f"{name} has no help"
        for parameter in command.params:
            assert getattr(parameter, "help", None), f"{name}: {parameter.name} has no help"


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("whacamole re", {"render", "recipe"}),
        ("whacamole view --s", {"--save"}),
        ("whacamole baseline r", {"run"}),
    ],
)
def test_the_shell_completes_commands_and_options(typed: str, offered: set[str]) -> None:
    script = Path(sys.executable).with_name("whacamole")
    words = {"COMP_WORDS": typed, "COMP_CWORD": str(typed.count(" "))}
    environment = {**os.environ, "_WHACAMOLE_COMPLETE": "complete_bash", **words}
    found = subprocess.run([script], env=environment, capture_output=True, text=True, check=False).stdout
    assert set(found.split()) == offered


def _typed_commands() -> Iterator[tuple[str, str]]:
    """Lines of the documentation that start with `whacamole`, with the file they stand in."""
    for path in MARKDOWN:
        text = path.read_text()
        blocks = "\n".join(re.findall(r"```(?:console|sh|bash)\n(.*?)```", text, flags=re.DOTALL))
        spans = "\n".join(re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.DOTALL)))
        for line in f"{blocks}\n{spans}".splitlines():
            if re.match(r"(\$ )?whacamole [a-z]", line):
                yield path.name, line.removeprefix("$ ").split(" #")[0].strip()


def test_the_documentation_types_commands_that_exist() -> None:
    commands = dict(_commands())
    for file, line in _typed_commands():
        words = line.split()
        name = max((n for n in commands if words[: n.count(" ") + 1] == n.split()), key=len)
        assert name != "whacamole", f"{file}: {line}: no such command"
        options = {o for p in commands[name].params for o in (*p.opts, *p.secondary_opts)}
        used = {word.split("=")[0] for word in words if word.startswith("--")} - {"--help"}
        assert used <= options, f"{file}: {line}: no option {', '.join(sorted(used - options))}"


def test_the_documentation_names_targets_that_exist() -> None:
    tasks = set(re.search(r"^TASKS := (.+)$", (ROOT / "Makefile").read_text(), re.MULTILINE)[1].split())  # type: ignore[index]
    for path in MARKDOWN:
        named = re.findall(r"(?:^|`|[A-Z]\w*=\S+ )make (\w+)", path.read_text(), flags=re.MULTILINE)
        assert set(named) <= tasks, path.name
    help_text = subprocess.run(
        ["sh", "tools/setup/task.sh", "help"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    assert all(f"make {task} " in help_text for task in tasks)
