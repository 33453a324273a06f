"""Figures are drawn as they were looked at and accepted: on paper by matplotlib, in pages by plotly."""

import importlib.util
import json
from dataclasses import replace
from pathlib import Path

from fegear.engine.figure.figure import Figure

_SPEC = importlib.util.spec_from_file_location("drawn_figures", Path(__file__).with_name("drawn_figures.py"))
drawn_figures = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(drawn_figures)


def test_figures_are_drawn_as_they_were_accepted():
    kept = json.loads(drawn_figures.KEPT.read_text("utf-8"))
    assert drawn_figures.differences(kept, drawn_figures.drawn()) == []


def test_a_wider_line_another_word_and_a_lost_item_are_noticed():
    figure = drawn_figures.figures()["curves"]
    (panel,) = figure.panels
    first, *others = panel.items
    before = {"x": drawn_figures.on_paper(figure) | drawn_figures.in_pages(figure)}
    for items in (
        (replace(first, width=1.9), *others), (replace(first, name="other"), *others), (first, *others[:-1]),
        (replace(first, role="blue"), *others), (replace(first, y=[*first.y[:-1], 0.3]), *others),
    ):  # fmt: skip
        changed = Figure("curves", "Curves", "C.", (replace(panel, items=items),))
        after = {"x": drawn_figures.on_paper(changed) | drawn_figures.in_pages(changed)}
        said = drawn_figures.differences(before, after)
        assert any("lines" in one for one in said) or any("legend" in one for one in said)
        assert any("trace" in one or "layout" in one for one in said)
