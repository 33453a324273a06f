"""The case that a page's design computes, and what the page is sent of it."""

from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import parse_document
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.window import designs
from fegear.window.designs import design_asked, designed
from fegear.window.job_queue import Asked

TEXT = """
results = ["load-sharing", "transmission-error"]
[pair.I]
driver = "a"
driven = "b"
[design]
grind = ["linear"]
"""


def asked(text=TEXT):
    found = Asked(*(None,) * len(Asked._fields))
    return found._replace(text=text, name="case")


@pytest.mark.parametrize("how", ["exact", "ground"])
def test_a_design_asks_the_case_for_its_relief_alone(how):
    found = parse_document(design_asked(asked(), "I", how).text, "case")
    assert found["results"] == ["relief"]
    assert found["design"]["pair"] == "I"
    assert found["design"]["grind"] == ([] if how == "exact" else ["linear"])
    assert found["pair"] == {"I": {"driver": "a", "driven": "b"}}


def test_what_cannot_be_designed_is_refused():
    with pytest.raises(InputError, match=r"pair\.I\.driven = \"a\": is also the driver"):
        design_asked(asked(TEXT.replace('"b"', '"a"')), "I", "exact")
    none = TEXT.replace('["linear"]', "[]")
    with pytest.raises(InputError, match=r"design\.grind = \[\]: contains no grindable shape"):
        design_asked(asked(none), "I", "ground")
    assert "grind" in design_asked(asked(none), "I", "exact").text


def test_the_page_is_sent_the_figures_of_the_design_and_no_others(monkeypatch):
    panel = Panel(Axis("x"), Axis("y"), (Curve([0.0, 1.0], [1.0, 2.0], "one"),))
    figures = [
        Figure("relief_I", "Relief", "c", (panel,)), Figure("relief_II", "O", "c", (panel,)), "drawn",
        Figure("relief_candidates_I", "Candidates", "d", (panel,)),
    ]  # fmt: skip
    monkeypatch.setattr(designs, "relief_for_case", lambda results, pair, how: (pair, how))
    monkeypatch.setattr(designs, "what_it_leaves", lambda results, how: f"left by {how}")
    scene = SimpleNamespace(case=SimpleNamespace(pair={}, gauge={}, encoders={}))
    found = designed(SimpleNamespace(figures=figures, scene=scene), "I", "ground")
    assert (found["pair"], found["reliefs"], found["told"]) == ("I", ("I", "ground"), "left by ground")
    assert [one["key"] for one in found["figures"]] == ["designed-relief_I", "designed-relief_candidates_I"]
    assert [(one["heading"], one["caption"]) for one in found["figures"]] == [("Relief", "c"), ("Candidates", "d")]
    assert all(one["data"] for one in found["figures"])
