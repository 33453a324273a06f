"""Compliance between teeth at two radii, what refuses wrong gears and teeth, and figures of a study of few values."""

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

import fegear
from fegear.base.errors import InputError, RangeError
from fegear.engine.figure.items import HeatMap
from fegear.fem.plane.neighbour_table import POSITIONS, neighbour_table
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.table import stiffness_table
from fegear.output.draw_png.items import _sides
from fegear.results.gear.root_stress_varied import ratios_figure, tiles_figure

PINION = fegear.Gear(23, "3 mm", profile_shift=0.3, bore_radius="15 mm", face_width="10 mm", name="pinion")


@pytest.fixture(scope="module")
def known():
    return solve_gear(PINION.geometry, MeshSettings().scaled(1.6), reach=2)


def test_the_table_has_both_radii_and_is_reciprocal(known):
    table = neighbour_table(known)
    shape = (2, POSITIONS, POSITIONS)
    tooth, p, q, c = (getattr(table, key).reshape(shape) for key in ("tooth", "radius_p", "radius_q", "c_neighbour"))
    assert (tooth == np.array([1, 2])[:, None, None]).all()
    radii = q[0, 0]
    assert (p == radii[:, None]).all()
    assert (q == radii).all()
    assert (radii[0], radii[-1]) == pytest.approx(known.gear.involute_radii, rel=1e-12)
    for k in (1, 2):  # solved on their own on the other side
        assert c[k - 1] == pytest.approx(known.neighbour(-k, radii, radii).T, rel=1e-9)
    assert np.abs(c[0] - c[0].T).max() > 0.02 * c[0].max()  # which c_prev and c_next cannot say
    assert np.diagonal(c[0]) == pytest.approx(
        stiffness_table(known.gear, radii, 6e-5, influence=known).c_next, rel=1e-12
    )
    assert (c[1] < c[0]).all()
    assert (table.c_neighbour_error > 0.0).all()
    assert (table.c_neighbour_error < 0.01 * table.c_neighbour).all()


def test_between_its_radii_it_is_interpolated(known):
    table, base = neighbour_table(known), known.gear.base_radius
    radii = np.unique(table.radius_q)
    roll = np.sqrt(radii**2 - base**2)
    first = RegularGridInterpolator((roll, roll), table.c_neighbour[table.tooth == 1].reshape(radii.size, -1))
    p, q = 0.5 * (roll[1:] + roll[:-1]), roll[:-1] + 0.3 * np.diff(roll)
    exact = known.neighbour(1, np.hypot(base, p), np.hypot(base, q))
    own = known.self_compliance([known.gear.pitch_radius], known.reference_half_width)
    assert first(tuple(np.meshgrid(p, q, indexing="ij"))) == pytest.approx(exact, abs=1e-4 * float(own[0]))


def test_wrong_gears_and_teeth_beyond_the_reach_are_refused(known):
    for refused in (lambda: solve_gear(PINION), lambda: stiffness_table(PINION, [0.03], 6e-5)):
        with pytest.raises(
            InputError, match=r"gear = fegear\.Gear: must be .*gear\.geometry, or fegear\.stiffness_table"
        ):
            refused()
    for call in (known.neighbour, known.neighbour_with_error, known.neighbour_error):
        with pytest.raises(RangeError, match=r"k = -3: was not solved: teeth -2 to 2 are known; set reach=3"):
            call(-3, [0.03], [0.03])


def test_a_run_has_it():
    found = fegear.stiffness_table(PINION, positions=5, tolerance=0.1)
    table = found.tables["neighbour_compliance_pinion"]
    assert [column.name for column in table.columns] == [
        "tooth", "radius_p", "radius_q", "c_neighbour", "c_neighbour_error",
    ]  # fmt: skip
    assert table["tooth"].size == POSITIONS**2
    assert table.matlab


def _study(**values):
    """Columns of a study: two formulas, of which the second answers for the first gear only."""
    gears = [(z, x) for z in values["teeth"] for x in values["shift"]]
    rows = [
        (z, x, 0.25, p, name, np.nan if name == "b" and number else 1.0 + 0.01 * number + 0.1 * p)
        for number, (z, x) in enumerate(gears) for name in "ab" for p in values["load"]
    ]  # fmt: skip
    keys = ("teeth", "profile_shift", "rack_tip_radius", "load_position", "formula", "ratio_to_fe")
    return {key: np.array(column) for key, column in zip(keys, zip(*rows, strict=True), strict=True)}


def test_a_study_draws_what_is_varied_only():
    table = _study(teeth=[20, 32, 60], shift=[0.0], load=[0.1, 1.0])
    figure = ratios_figure(table, "")
    assert [panel.x.label.partition(":")[0] for panel in figure.panels] == ["number of teeth", "load position"]
    for panel, values in zip(figure.panels, (3, 2), strict=True):
        places = np.concatenate([np.asarray(item.x) for item in panel.items])
        assert np.unique(places).size == places.size == 12  # none above another one
        assert len(panel.x.ticks) == values
        nearest = np.round(np.asarray(panel.items[0].x)).astype(int)
        assert np.array_equal(nearest, np.repeat([0, 1, 2], 2) if values == 3 else np.tile([0, 1], 3))
    tiles = tiles_figure(table, "")
    assert [view.label for view in tiles.views] == ["a", "b (×: not applicable)"]
    panel = tiles.views[0].panels[0]
    assert (panel.y.label, panel.y.categories) == ("number of teeth", ("60", "32", "20"))
    assert 2.3 * panel.height > 0.078 * len(panel.y.label)  # inches of a panel, and of its label
    (tile,) = (item for item in panel.items if isinstance(item, HeatMap))
    assert np.asarray(tile.z)[1] == pytest.approx([1.02, 1.11])


def test_one_gear_and_load_is_drawn_over_the_number_of_teeth():
    figure = ratios_figure(_study(teeth=[20], shift=[0.0], load=[0.5]), "")
    assert [panel.x.label for panel in figure.panels] == ["number of teeth"]
    both = tiles_figure(_study(teeth=[20, 32], shift=[-0.2, 0.5], load=[0.5]), "").views[0].panels[0]
    assert both.y.label == "teeth | shift"
    assert both.y.categories[-1] == "20 | -0.2"


def test_a_single_column_of_tiles_has_a_width():
    assert _sides(np.array([1.0])) == pytest.approx([0.5, 1.5])
    assert _sides(np.array([0.0, 1.0, 3.0])) == pytest.approx([-0.5, 0.5, 2.0, 4.0])
