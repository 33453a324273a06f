"""What the figures of results must show: points A to E, numbered harmonics, named modes, the design first."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.train.charts import SpeedChart
from fegear.dynamics.train.mesh_force_spectrum import MeshForceSpectrum
from fegear.dynamics.train.modes import Campbell, Modes
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark, Points, Stems
from fegear.engine.figure.panel import Panel
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.output.draw_plotly.layout import plotly_json
from fegear.output.draw_png.sheet import Sheet
from fegear.results.gear.drawing import pair_figure
from fegear.results.gear.drawing_data import Drawing
from fegear.results.gear.path_marks import path_marks, roll_marks
from fegear.results.pair.loaded_teeth import pitch_marks
from fegear.results.train.dynamic_factor import DYNAMIC_FACTOR
from fegear.results.train.dynamic_factor_data import DynamicFactorData
from fegear.results.train.mesh_force_lines import MOST_HARMONICS, SpectrumData
from fegear.results.train.mesh_force_spectrum import MESH_FORCE_SPECTRUM
from fegear.results.train.natural_modes import NATURAL_MODES, ModesData
from fegear.studies.swept import Swept, varying

GEAR = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3.175e-3, 20e-3)
PAIR = GearPair(GEAR, GEAR)
TRAIN = SimpleNamespace(
    names=("I", "II"), speed_ratio=1.0, speed_of="motor", ripple=(), train=SimpleNamespace(bodies=())
)


def figure_of(stage, data, asked, key):
    """One of the figures that a result shows."""
    return next(one for one in stage.present(data, asked).figures if one.name == key)


def drawn_texts(panel: Panel, head: tuple[str, str] = ("", "")) -> tuple[set[str], set[str]]:
    """Texts in the axes and around them on paper."""
    from matplotlib.figure import Figure as Canvas

    made = Canvas()
    Sheet(made, [(panel, "")], 1, head).draw()
    return {text.get_text() for text in made.axes[0].texts}, {text.get_text() for text in made.texts}


def test_points_of_the_path_are_marked_on_every_abscissa_that_follows_it():
    assert [mark.label for mark in path_marks(PAIR)] == list("ABCDE")
    over_pitch = pitch_marks(PAIR, np.array([PAIR.x_start, PAIR.x_start + PAIR.base_pitch]))
    assert [mark.label for mark in over_pitch] == list("ABCD")
    rolls = {mark.label: mark.at for mark in roll_marks(PAIR, "driven")}
    assert rolls["A"] > rolls["C"] > rolls["E"]
    tip = math.degrees(math.sqrt((GEAR.tip_radius / GEAR.base_radius) ** 2 - 1.0))
    assert rolls["A"] == pytest.approx(tip)


def test_the_pair_in_mesh_has_its_letters_in_page_and_on_paper():
    figure = pair_figure("I", Drawing({"a": GEAR}, {"I": PAIR}, {"I": ("a", "a")}, {}, {}))
    spec = plotly_json(figure)
    lettered = [trace["text"] for trace in spec["data"] if trace.get("mode") == "markers+text"]
    assert lettered == [list("ABCDE")]
    assert {one["text"] for one in spec["layout"]["annotations"]} >= set("ABCDE")
    for panel in figure.panels:
        assert drawn_texts(panel)[0] >= set("ABCDE")


def test_paper_says_case_figure_and_load():
    panel = Panel(Axis("x"), Axis("y"), (Curve([0, 1], [0, 1]),))
    figure = Figure("k", "Load of pair I", "c", (panel,), under="1615 N")
    assert figure.heading == "Load of pair I, 1615 N"
    assert drawn_texts(panel, (figure.heading, "nasa"))[1] == {"Load of pair I, 1615 N", "case nasa"}


@pytest.fixture(scope="module")
def spectrum():
    orders = np.arange(1.0, 65.0)
    frequencies = np.stack([4000.0 * orders, 5000.0 * orders])[:, :, None]
    lines = np.stack([100.0 / orders, 1e-6 / orders])
    found = MeshForceSpectrum(
        np.array([1000.0]), orders, np.ones((2, 64), dtype=bool), frequencies,
        0.5 * np.stack([lines, lines])[..., None].astype(complex), np.array([1e3, 1e3]),
    )  # fmt: skip
    asked = SimpleNamespace(name="I", terms=None, part=SimpleNamespace(harmonics=64, one_speed=1000.0))
    return figure_of(MESH_FORCE_SPECTRUM, SpectrumData(TRAIN, 0, found, None, None), asked, "mesh_force_spectrum_I")


def test_spectra_end_where_little_is_left_and_say_so(spectrum):
    (panel,) = spectrum.panels
    first, second = panel.items
    assert first.x.max() <= 5.0 * MOST_HARMONICS
    assert second.x.size == 0  # a hundred million times weaker
    assert first.y.min() >= 1e-3 * first.y.max()
    power = 1.0 / np.arange(1.0, 65.0) ** 2
    left = power[4.0 * np.arange(1.0, 65.0) > 5.0 * MOST_HARMONICS].sum() / power.sum()
    assert f"hold {left:.2g} of the mean square" in spectrum.caption


def test_stems_stand_on_the_axis_and_bear_their_harmonic_in_page_and_on_paper(spectrum):
    (panel,) = spectrum.panels
    low, high = panel.limits
    assert low == panel.foot < panel.items[0].y.min()
    assert high > panel.items[0].y.max()
    spec = plotly_json(spectrum)
    assert spec["layout"]["yaxis"]["range"] == pytest.approx([math.log10(low), math.log10(high)])
    assert spec["data"][0]["text"][:3] == ["1", "2", "3"]
    assert drawn_texts(panel)[0] >= {"1", "2", "3"}


def test_a_campbell_diagram_names_every_mode_and_marks_crossings_and_the_operating_speed():
    speeds = np.linspace(100.0, 1000.0, 10)
    lines = np.array([[3.0 * n * speeds for n in (1, 2, 3)], [4.0 * n * speeds for n in (1, 2, 3)]])
    natural = np.array([900.0, 905.0, 3000.0])
    factors = np.array([[3.0, 6.0, 9.0], [4.0, 8.0, 12.0]])
    critical = natural / factors[:, :, None]
    modes = Modes(np.array([0.0, *natural]), np.zeros((0, 4)), np.full((4, 2), 0.5))
    data = ModesData(TRAIN, modes, Campbell(speeds, natural, lines, critical))
    (panel,) = figure_of(NATURAL_MODES, data, SimpleNamespace(part=SimpleNamespace(speed=500.0)), "campbell").panels
    words = [mark.label for mark in panel.marks if mark.axis == "y" and mark.label]
    assert words == ["modes 1: 900 Hz, 2: 905 Hz", "mode 3: 3000 Hz"]
    assert [mark.label for mark in panel.marks if mark.axis == "x"] == ["operating speed 4774.6 rpm"]
    harmonics = [item for item in panel.items if isinstance(item, Curve)]
    assert len({(item.role, item.dash) for item in harmonics}) == 6
    points = [item for item in panel.items if isinstance(item, Points)]
    assert sum(np.size(item.x) for item in points) == int(((critical >= 100.0) & (critical <= 1000.0)).sum())
    assert "mesh I, harmonic 1, mode 1: 2864.8 rpm" in points[0].notes
    (panel,) = figure_of(NATURAL_MODES, data, SimpleNamespace(part=SimpleNamespace(speed=None)), "campbell").panels
    assert not any(mark.axis == "x" for mark in panel.marks)


def test_values_that_differ_by_round_off_do_not_vary():
    numbers = {
        "level": [88.9, 88.9 * (1.0 + 2e-16), np.nan], "unknown": [np.nan, np.nan, np.nan],
        "zero": [-8e-15, 0.0, 1.6e-14], "free": [88.9, 88.91, 88.9],
    }  # fmt: skip
    swept = [Swept(name, "mm", "", np.array(values), None) for name, values in numbers.items()]
    assert [one.name for one in varying(swept)] == ["free"]


@pytest.mark.parametrize(("teeth", "shift"), [(24, -0.2), (28, 0.1), (32, 0.4), (17, 0.3)])
def test_a_pair_without_backlash_has_none_at_all(teeth, shift):
    gear = Gear(Tooth(teeth, BasicRack(1.0, 1.25, 0.25), shift), 3.175e-3, 10e-3)
    assert GearPair(gear, GEAR).normal_backlash == 0.0


def test_logarithmic_axes_of_few_decades_have_plain_numbers_in_the_page():
    few = Panel(Axis("x", log=True), Axis("y", log=True), (Curve([20.0, 90.0], [1e-3, 1e3]),), (Mark("x", 30.0),))
    spec = plotly_json(Figure("k", "t", "c", (few,)))["layout"]
    assert {"20", "30", "50"} <= set(spec["xaxis"]["ticktext"])
    assert spec["yaxis"]["dtick"] == 1
    small = Panel(Axis("x", log=True), Axis("y"), (Curve([2e-6, 9e-6], [0.0, 1.0]),))
    assert not {"dtick", "ticktext"} & set(plotly_json(Figure("k", "t", "c", (small,)))["layout"]["xaxis"])


def test_an_empty_spectrum_has_no_limits_of_its_own():
    panel = Panel(Axis("x"), Axis("y", log=True), (Stems([], []),))
    assert panel.limits is None


def test_teeth_in_space_are_whole_and_mirror_their_flank():
    from helical_gears import helical_gear

    from fegear.geometry.helicoid import InvoluteHelicoid
    from fegear.results.helical.drawn_tooth_contact import solid_tooth

    gear = helical_gear(20, 5e-3, math.radians(20.0), math.radians(25.0), 40e-3, "right")
    flank = InvoluteHelicoid.of(gear, "tooth")
    radius, z = np.meshgrid(np.linspace(1.001 * gear.form_radius, gear.tip_radius, 5), np.linspace(-0.02, 0.02, 7))
    whole, *ends = solid_tooth(flank.points(flank.tangent_length(radius), z), gear.twist * z)
    assert whole.shape == (3, 7, 10)
    assert [end.shape for end in ends] == [(3, 2, 5)] * 2
    assert np.hypot(whole[0], whole[1]) == pytest.approx(np.concatenate([radius, radius[:, ::-1]], axis=1))
    tips = np.arctan2(whole[1, :, 4:6], whole[0, :, 4:6])
    assert tips[:, 0] - tips[:, 1] == pytest.approx(2.0 * gear.tooth.tip_half_angle)
    assert tips.mean(axis=1) == pytest.approx(gear.twist * z[:, 0], abs=1e-12)


def test_a_dynamic_factor_over_too_few_speeds_says_where_peaks_may_be_missed():
    speeds, factor = np.linspace(100.0, 500.0, 5), np.array([1.0, 1.05, 1.5, 1.52, 1.5])
    none = np.zeros(5)
    whole = np.ones(5, dtype=int)
    chart = SpeedChart(
        speeds, factor, factor, none, none, whole, ("periodic",) * 5, factor, factor, whole, none, factor,
        0 * whole, none, none,
    )  # fmt: skip
    motion = SimpleNamespace(contact_loss=False, direction="up", method="shooting", parametric=True)
    asked = SimpleNamespace(mesh="I", motion=motion)
    figure = figure_of(DYNAMIC_FACTOR, DynamicFactorData(chart, "motor"), asked, "dynamic_factor_I")
    assert "From 1909.86 to 2864.79 rpm the dynamic factor changes by 43 %" in figure.caption
    assert all(item.marked for item in figure.panels[0].items)
    smooth = replace(chart, dynamic_factor=np.full(5, 1.2))
    figure = figure_of(DYNAMIC_FACTOR, DynamicFactorData(smooth, "motor"), asked, "dynamic_factor_I")
    assert "changes by" not in figure.caption
