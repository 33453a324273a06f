"""Parts of pages and pictures, and lines of cracks, by what they stand for."""

from dataclasses import make_dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, HeatMap
from fegear.engine.figure.panel import Panel
from fegear.fem.plane.odd.cracked_sector import crack_line
from fegear.output.draw_plotly.layout import layout
from fegear.output.report import run as report
from fegear.results.shafts.drawn_gearbox import DrawnBody, DrawnGearbox
from fegear.results.shafts.gearbox_scheme import _outline
from fegear.results.train import vibration_revolution


@pytest.mark.parametrize("corners", [2, 3, 4])
def test_a_line_of_a_crack_ends_at_its_tip_with_an_edge_as_long_as_the_rays(corners):
    path = np.array([[0.0, 1.0, 1.5, 1.4], [0.0, 0.0, -0.7, -1.5]])[:, :corners]
    line = crack_line(path, 0.05, 0.02, 0.2)
    steps = np.hypot(*np.diff(np.column_stack([path[:, 0], line])))
    np.testing.assert_array_equal(line[:, -1], path[:, -1])
    assert steps.sum() == pytest.approx(np.hypot(*np.diff(path)).sum(), rel=1e-9)
    assert steps[-1] == pytest.approx(0.02, rel=1e-9)
    assert 0.03 < steps[0] < 0.1
    assert 0.1 < steps.max() <= 0.23
    for corner in path.T[1:]:
        assert np.hypot(*(line - corner[:, None])).min() < 1e-12


def test_a_gearbox_is_as_large_as_its_largest_extent():
    def body(shaft, z, outer):
        z = np.array(z)
        return DrawnBody("shaft", "b", shaft, z, np.array(outer), 0.0 * z, z)

    places = {"one": (0.0, 0.0, 0.1), "two": (0.3, 0.0, 0.0)}
    long = DrawnGearbox(
        places, (body("one", [0.0, 0.1, 1.5], [0.05, 0.2, 0.1]), body("two", [0.0, 0.4], [0.1, 0.1])), {}
    )
    assert long.size == pytest.approx(1.6)
    wide = DrawnGearbox(
        places, (body("one", [0.05, 0.1, 0.2], [0.05, 0.2, 0.1]), body("two", [0.0, 0.4], [0.1, 0.1])), {}
    )
    assert wide.size == pytest.approx(0.3 + 0.2 + 0.1)
    shifted = DrawnGearbox({"one": (0.0, 0.0, 2.0)}, (body("one", [0.0, 0.3, 1.0], [0.05, 0.05, 0.05]),), {})
    assert shifted.size == pytest.approx(1.0)


def test_a_vibration_over_a_revolution_is_that_of_its_mesh(monkeypatch):
    mesh = SimpleNamespace(pair="pair", error=SimpleNamespace(pitches=77))
    train = SimpleNamespace(mesh_index=lambda name: {"second": 1}[name])
    data = SimpleNamespace(train=train, meshes=["first", mesh], phases=[0.1, 0.2])
    monkeypatch.setattr(vibration_revolution, "gear_train", lambda upstream: data)
    state, asked_for = SimpleNamespace(repeats=False), []
    made = make_dataclass("Made", ["given", ("resonance", object, None)])

    def steady_motions(*given):
        asked_for.extend(given[:2])
        return (state,)

    monkeypatch.setattr("fegear.dynamics.motion.moving_train.steady_motions", steady_motions)
    monkeypatch.setattr(
        "fegear.dynamics.motion.motion_over_revolution.motion_over_revolution", lambda *given: made(given)
    )
    monkeypatch.setattr("fegear.dynamics.train.mesh_resonance.mesh_resonance", lambda *given: given)
    monkeypatch.setattr(vibration_revolution, "_doubt", lambda *_given: None)
    motion = SimpleNamespace(speeds=[10.0])
    asked = vibration_revolution.VibrationInputs(motion, "second", ("p", "q"))
    found = vibration_revolution._compute(asked, None, SimpleNamespace(progress=None))
    assert asked_for == [motion, data]
    assert found.given == (state, 1, "pair", 77, 0.2)
    assert found.resonance == (data, 1, 10.0)


def test_a_page_lists_the_works_that_its_results_cite(monkeypatch):
    works = {key: SimpleNamespace(full=f"Work {key}.") for key in ("a", "b", "c")}
    cited = {"one": ["c"], "two": ["a", "c"]}
    monkeypatch.setattr(report, "bibliography", lambda: works)
    monkeypatch.setattr(report, "_citations", lambda results, task: [SimpleNamespace(key=k) for k in cited[task]])
    notes, own = report._references(SimpleNamespace(outcomes=dict.fromkeys(cited)))
    assert "Work a." in repr(notes)
    assert "Work c." in repr(notes)
    assert "Work b." not in repr(notes)
    assert "To cite fegear itself" in repr(own)


@pytest.mark.parametrize("hole", [False, True])
def test_only_maps_with_holes_have_a_grey_ground(hole):
    z = np.array([[1.0, 2.0], [3.0, np.nan if hole else 4.0]])
    items = (Curve([0.0, 1.0], [0.0, 1.0], "a"), HeatMap([0.0, 1.0], [0.0, 1.0], z, "z"))
    figure = Figure("name", "title", "caption", (Panel(Axis("x"), Axis("y"), items),))
    assert ("plot_bgcolor" in layout(figure, [[0, 1]], 2, 1)) == hole


def test_a_body_of_a_scheme_is_one_outline_about_its_moved_axis_and_a_bearing_a_crossed_box_on_either_side():
    bent = SimpleNamespace(at=lambda z: np.column_stack([2.0 * z, 3.0 * z, 0.0 * z]))
    z, outer, inner = np.array([1.0, 2.0]), np.array([5.0, 6.0]), np.array([4.0, 4.0])

    def outlined(kind):
        body = DrawnBody(kind, "b", "s", z, outer, inner, z)
        return _outline(body, 10.0, 100.0, bent, {"s": (np.array([0.0, 1.0]), "")}, 7.0)

    (whole,) = outlined("gear")
    axis = 10.0 + 7.0 * 3.0 * z
    assert whole[0] == pytest.approx([101.0, 102.0, 102.0, 101.0, 101.0])
    assert whole[1] == pytest.approx([*(axis + outer), *(axis - outer)[::-1], (axis + outer)[0]])
    above, across, below, _ = outlined("bearing")  # stands still
    assert above[1].min() == pytest.approx(14.0)
    assert above[1].max() == pytest.approx(15.0)
    assert below[1].min() == pytest.approx(5.0)
    assert below[1].max() == pytest.approx(6.0)
    assert across.tolist() == [[101.0, 102.0], [15.0, 14.0]]
