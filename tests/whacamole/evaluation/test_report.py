"""Tables in five forms, plots, and the one HTML file."""

import csv
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from whacamole.evaluation import Bodies, EvaluationError, Result, evaluate
from whacamole.evaluation.report.document import as_document, as_json, tables_of
from whacamole.evaluation.report.html import as_html
from whacamole.evaluation.report.plots import plane_of, sequence_plots, write_plots
from whacamole.evaluation.report.svg import Line, chart, ticks
from whacamole.evaluation.report.table import Column, Table, as_csv, as_dict, as_latex, as_markdown, as_text
from whacamole.evaluation.report.tables import coverage, headline, paper_tables

NAN = float("nan")
TABLE = Table(
    "A title",
    (Column("ERR", "mm", 1, "lower"), Column("F1", "", 2, "higher"), Column("AS", "", 1, "one"), Column("N")),
    (
        ("first_one", (12.34, 0.5, 1.3, 3.0)),
        ("second", (12.31, 0.75, 0.8, NAN)),
        ("third", (20.0, NAN, 2.0, 1.0)),
    ),
    notes=("a note",),
)


@pytest.fixture(scope="module")
def result(scenes, dataset, make, tmp_path_factory) -> Result:
    root = tmp_path_factory.mktemp("pred")
    folders = {}
    for name, noise in (("good", 0.01), ("bad <&> worse", 0.04)):
        made = {s.id: make["prediction"](s, noise=noise) for s in scenes}
        if noise > 0.02:
            del made["made-2"]
        folders[name] = make["predictions"](root / str(noise), made)
    return evaluate(dataset, folders, "whac", bodies=Bodies(vertices=200))


def test_the_best_is_told_by_what_is_printed():
    assert TABLE.best() == {(0, 0), (1, 0), (1, 1), (1, 2)}
    assert replace(TABLE, compare=False).best() == set()
    assert Table("", TABLE.columns, TABLE.rows[:1]).best() == set()


def test_text_is_in_line():
    lines = as_text(TABLE).splitlines()
    assert lines[0] == "A title"
    assert lines[3].split() == ["first_one", "12.3*", "0.50", "1.3", "3.0"]
    assert lines[4].split() == ["second", "12.3*", "0.75*", "0.8*", "–"]
    assert lines[-1] == "a note"
    assert {len(line) for line in lines[3:6]} == {len(lines[2])}


def test_markdown_has_as_many_cells_in_every_row():
    rows = [line for line in as_markdown(TABLE).splitlines() if line.startswith("|")]
    assert {row.count("|") for row in rows} == {6}
    assert "| second | **12.3** | **0.75** | **0.8** | – |" in rows


def test_latex_is_escaped_and_whole():
    text = as_latex(TABLE)
    assert r"first\_one & \textbf{12.3} & 0.50 & 1.3 & 3.0 \\" in text
    assert text.count(r"\\") == 4
    assert r"ERR [mm] $\downarrow$" in text
    body = text.split("% A title")[0]
    assert not re.search(r"(?<!\\)[_%#]", body)
    assert all(ord(character) < 128 for character in body)


def test_csv_is_read_back_in_full_precision():
    rows = list(csv.reader(as_csv(TABLE).splitlines()))
    assert rows[0] == ["method", "ERR [mm]", "F1", "AS", "N"]
    assert float(rows[1][1]) == 12.34
    assert rows[2][4] == ""


def test_json_has_null_for_no_value():
    assert json.loads(json.dumps(as_dict(TABLE), allow_nan=False))["rows"][1]["values"][3] is None


def test_the_headline_is_the_papers_table(result):
    table = headline(result)
    assert [c.label for c in table.columns] == [
        "PA-MPJPE", "W-MPJPE 100", "WA-MPJPE 100", "H-ATE", "H-AS", "C-ATE", "C-AS"
    ]  # fmt: skip
    assert [name for name, _ in table.rows] == ["good", "bad <&> worse"]
    assert any("good was given true boxes" in note for note in table.notes)
    titles = [t.title for t in paper_tables(result)]
    assert titles == [
        "World-frame evaluation", "Camera-frame evaluation", "Ablation of the trajectory",
        "Ablation of the focal length",
    ]  # fmt: skip


def test_coverage_tells_what_is_missing(result):
    rows = dict(coverage(result).rows)
    assert rows["good"][:5] == (3, 3, 6, 6, 100.0)
    assert rows["bad <&> worse"][:4] == (2, 3, 4, 4)


@pytest.mark.parametrize("style", ["text", "markdown", "latex", "csv"])
@pytest.mark.parametrize("detail", ["headline", "paper", "all"])
def test_documents_of_every_style_and_detail(result, style, detail):
    text = as_document(result, style, detail)
    assert "nan" not in text.lower().replace("nan [", "").replace("frames %,nan", "").replace(
        "nan  ", ""
    ).replace("| nan |", "").replace("& nan &", "").replace(",nan,", "")
    assert "PA-MPJPE" in text


def test_all_means_groups_too(result):
    titles = [table.title for table in tables_of(result, "all")]
    for wanted in (
        "By sequence",
        "By camera move",
        "By motion source",
        "By visibility of the person",
        "Contact",
    ):
        assert wanted in titles
    with pytest.raises(EvaluationError, match="headline, paper, all"):
        tables_of(result, "some")
    with pytest.raises(EvaluationError, match="text, markdown, latex, csv"):
        as_document(result, "word")


def test_json_holds_every_number_and_every_failure(result):
    data = json.loads(json.dumps(as_json(result), allow_nan=False))
    good, bad = data["methods"]
    assert good["metrics"]["pa_mpjpe"] == pytest.approx(
        np.mean(np.concatenate([s.values["pa_mpjpe"].ravel() for s in result.methods[0].sequences.values()]))
    )
    assert set(good["sequences"]) == {"made-0", "made-1", "made-2"}
    assert list(bad["failures"]) == ["made-2"]
    assert data["complete"] is False
    assert data["units"]["rte"] == "%"
    assert data["protocol"]["segment_frames"] == 100


class Links(HTMLParser):
    """Whatever a page would fetch."""

    def __init__(self):
        super().__init__()
        self.found, self.open = [], []

    def handle_starttag(self, tag, attrs):
        self.found += [value for key, value in attrs if key in ("src", "href", "srcset", "action")]
        if tag in ("script", "link", "iframe", "img"):
            self.found.append(tag)


def test_the_html_is_one_file_that_fetches_nothing(result):
    page = as_html(result)
    parser = Links()
    parser.feed(page)
    assert parser.found == []
    assert "@import" not in page
    assert "url(" not in page
    assert "bad &lt;&amp;&gt; worse" in page
    assert "<&>" not in page
    for wanted in (
        "Not scored",
        "made-2",
        "Coverage",
        "By camera move",
        "<svg",
        "segment_frames",
        "protocol whac",
    ):
        assert wanted in page


def test_plots_are_valid_svg_on_disk(result, tmp_path):
    written = write_plots(result, tmp_path / "plots")
    assert len(written) == 6
    for path in written:
        root = ElementTree.parse(path).getroot()
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(EvaluationError, match="can be written"):
        write_plots(result, tmp_path / "file" / "plots")


def test_trajectories_show_truth_and_every_method(result):
    plots = sequence_plots(result, "made-0")
    assert plots.keys() == {"trajectories", "error"}
    assert "truth" in plots["trajectories"]
    assert plots["trajectories"].count('<path d="M') >= 3 * 3
    assert "W-MPJPE" in plots["error"]
    assert sequence_plots(result, "unknown") == {}


def test_a_line_breaks_where_there_is_no_value_and_is_where_it_should_be():
    y = np.array([0.0, 1.0, NAN, 1.0, 0.0])
    svg = chart([Line("a", np.arange(5.0), y, "#000000")], "t", "x", "y")
    path = re.search(r'<path d="(M[^"]*)" fill="none"', svg)[1]
    assert path.count("M") == 2
    points = [[float(v) for v in pair.split()] for pair in re.findall(r"[ML]([\d. ]+)", path)]
    assert points[0][1] > points[1][1]
    assert np.ptp([p[1] for p in points]) == pytest.approx((320 - 26 - 40) / 1.08, abs=0.2)


def test_a_map_has_one_scale():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], dtype=float)
    svg = chart([Line("", square[:, 0], square[:, 1], "#000000")], "t", "x", "y", equal=True)
    path = re.search(r'<path d="(M[^"]*)" fill="none"', svg)[1]
    points = np.array([[float(v) for v in pair.split()] for pair in re.findall(r"[ML]([\d. ]+)", path)])
    assert np.ptp(points[:, 0]) == pytest.approx(np.ptp(points[:, 1]), abs=0.11)


def test_nothing_to_draw_is_still_a_chart():
    empty = Line("a", np.full(3, NAN), np.full(3, NAN), "#000000")
    ElementTree.fromstring(chart([empty], "t", "x", "y"))
    ElementTree.fromstring(chart([Line("a", np.ones(3), np.ones(3), "#000000")], "t", "x", "y"))


@pytest.mark.parametrize(("low", "high"), [(0, 1), (-3.7, 12.2), (1e-4, 5e-4), (1000, 1001), (-1e6, 1e6)])
def test_ticks_are_round_few_and_inside(low, high):
    found = ticks(low, high)
    assert 2 <= len(found) <= 7
    assert all(low - 1e-9 <= t <= high + 1e-9 for t in found)
    assert np.allclose(np.diff(found), found[1] - found[0])


def test_the_map_lies_across_up_or_where_the_paths_spread(result):
    score = result.methods[0].sequences["made-0"]
    np.testing.assert_allclose(plane_of(score) @ [0, 0, 1], 0.0, atol=1e-12)
    flat = replace(score, up=(0.0, 0.0, 0.0), paths={k: p * [1, 0, 1] for k, p in score.paths.items()})
    np.testing.assert_allclose(plane_of(flat) @ [0, 1, 0], 0.0, atol=1e-6)


def test_written_files_need_no_network_path(result, tmp_path):
    path = tmp_path / "r.html"
    Path(path).write_text(as_html(result), encoding="utf-8")
    assert path.stat().st_size < 2_000_000
