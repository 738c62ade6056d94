import xml.etree.ElementTree as ET

import numpy as np

from whacamole.baseline.charts import Line, chart


def test_a_chart_is_a_picture_whose_lines_break_where_data_do() -> None:
    points = np.array([[0.0, 0.0], [1.0, 2.0], [np.nan, np.nan], [2.0, 1.0], [3.0, 1.5]])
    text = chart(
        [Line("a < b", points), Line("other", points[:2], dashed=True)], "T & U", "x", "y", equal=True
    )
    root = ET.fromstring(text)
    assert root.tag.endswith("svg")
    assert "a &lt; b" in text
    [path] = [p for p in root.iter() if p.get("d", "").count("M") == 2]
    assert path.get("d", "").count("L") == 2


def test_a_map_has_one_unit_on_both_axes() -> None:
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    root = ET.fromstring(chart([Line("square", square)], "", "", "", equal=True))
    [path] = [p.get("d", "") for p in root.iter() if p.get("d", "").count("L") == 3]
    numbers = np.array([[float(v) for v in step.split()] for step in path[1:].split("L")])
    sides = np.abs(np.diff(numbers, axis=0)).max(axis=1)
    np.testing.assert_allclose(sides, sides[0], atol=0.2)


def test_a_chart_of_nothing_is_still_one() -> None:
    ET.fromstring(chart([], "nothing", "x", "y"))
