"""Probing: every known failure text leads to its remedy, and a try that aborts does no harm."""

from __future__ import annotations

import pytest

from render_jobs import EngineError, RenderJobError
from render_jobs.probe import TRIES, Probe, choose_engine, explain_failure, probe, seek_engine

FAILURES = [
    ("ImportError: libX11.so.6: cannot open shared object file: No such file or directory", "libx11-6"),
    ("ImportError: libxkbcommon.so.0: cannot open shared object file: No such file", "libxkbcommon0"),
    ("ImportError: libSM.so.6: cannot open shared object file: No such file or directory", "libsm6"),
    ("ImportError: ('Unable to load OpenGL library', 'GL: cannot open shared object file', 'GL')", "libgl1"),
    ("ImportError: ('Unable to load EGL library', 'EGL: cannot open shared object file', 'EGL')", "libegl1"),
    ("AttributeError: 'NoneType' object has no attribute 'glGetError'", "libgl1"),
    ("AttributeError: 'NoneType' object has no attribute 'XRenderFindVisualFormat'", "PYGLET_HEADLESS=1"),
    ('ImportError: Library "GLU" not found.', "pyglet>=2"),
    ("OpenGL.error.GLError: GLError(err = 12289, baseOperation = eglInitialize,", "libgl1-mesa-dri"),
    ('pyglet.display.xlib.NoSuchDisplayException: Cannot connect to "None"', "PYOPENGL_PLATFORM=egl"),
    ("OpenGL.error.NullFunctionError: Attempt to call an undefined function glGenVertexArrays", "egl"),
    ("ImportError: cannot import name 'OSMesaCreateContextAttribs' from 'OpenGL.osmesa'", "libosmesa6"),
    ("Couldn't open libEGL.so.1: libEGL.so.1: cannot open shared object file", "libegl1"),
    ("Failed to create headless GPU context: EGL Error (0x3001): EGL_NOT_INITIALIZED", "libgl1-mesa-dri"),
    ("ImportError: numpy.core.multiarray failed to import", "numpy>=1.26,<2"),
    ("AttributeError: `np.infty` was removed in the NumPy 2.0 release", "numpy>=1.26,<2"),
    ("ModuleNotFoundError: No module named 'bpy'", "pip install"),
]


@pytest.mark.parametrize(("text", "remedy"), FAILURES)
def test_each_failure_has_its_remedy(text: str, remedy: str) -> None:
    output = f"Traceback (most recent call last):\n  File x\n{text}\nsomething printed later\n"
    result = explain_failure("cycles", output, -6)
    assert not result.works
    assert result.found == text
    assert remedy in result.remedy
    assert "\n" not in result.found + result.remedy


def test_an_unknown_failure_is_quoted_with_a_way_to_see_more() -> None:
    result = explain_failure("cycles", "first\nKernel panic\n\n", 1)
    assert (result.works, result.found) == (False, "Kernel panic")
    assert "python -m render_jobs.probe cycles" in result.remedy
    assert explain_failure("cycles", "", -6).found == "ended with status -6"


@pytest.mark.blender
@pytest.mark.parametrize("name", sorted(TRIES))
def test_what_can_be_tried_answers_either_way(name: str) -> None:
    result = probe(name)
    assert result.works == (result.remedy == "")
    assert result.found
    if name == "cycles":
        assert result.works, "the other tests of this folder need it"
        assert "Blender" in result.found


def test_a_try_that_gives_no_answer_has_failed() -> None:
    result = probe("cycles", timeout=0.001)
    assert not result.works
    assert "no answer in 0 s" in result.found


def _pretend(monkeypatch: pytest.MonkeyPatch, **works: bool) -> None:
    def answer(name: str, timeout: float = 0.0) -> Probe:
        return Probe(
            name, works[name], "it is" if works[name] else "no driver", "" if works[name] else "buy one"
        )

    monkeypatch.setattr("render_jobs.probe.probe", answer)


def test_the_best_engine_that_works_is_taken_and_a_lesser_one_is_announced(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _pretend(monkeypatch, cycles=True, raster=True)
    assert choose_engine() == ("cycles", "")
    assert choose_engine("raster") == ("raster", "")
    _pretend(monkeypatch, cycles=False, raster=True)
    name, note = choose_engine()
    assert name == "raster"
    assert "cycles cannot run (no driver): buy one" in note
    with pytest.raises(EngineError, match="cycles cannot run"):
        choose_engine("cycles")
    _pretend(monkeypatch, cycles=False, raster=False)
    with pytest.raises(EngineError, match=r"cycles cannot run.*; raster cannot run"):
        choose_engine()
    with pytest.raises(RenderJobError, match="'unreal' is not one of auto, cycles, raster, eevee"):
        choose_engine("unreal")


def test_an_engine_sought_beside_other_work_is_the_one_chosen_with_its_errors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _pretend(monkeypatch, cycles=False, raster=True)
    assert seek_engine().result(timeout=60) == choose_engine()
    _pretend(monkeypatch, cycles=False, raster=False)
    with pytest.raises(EngineError, match=r"cycles cannot run.*; raster cannot run"):
        seek_engine().result(timeout=60)


def test_of_a_traceback_the_message_is_told_and_not_the_code() -> None:
    output = (
        'Traceback (most recent call last):\n  File "context.py", line 90, in __init__\n'
        '    raise OSError("libOSMesa.so.8: cannot open")\n'
        "OSError: libOSMesa.so.8: cannot open shared object file: No such file or directory\n"
    )
    found = explain_failure("raster", output, 1)
    assert found.found.startswith("OSError: libOSMesa.so.8")
    assert "libosmesa6" in found.remedy


def test_eevee_is_never_chosen_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    _pretend(monkeypatch, cycles=False, raster=False, eevee=True)
    with pytest.raises(EngineError, match="raster cannot run"):
        choose_engine()
    assert choose_engine("eevee") == ("eevee", "")
