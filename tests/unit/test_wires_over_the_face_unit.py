"""What is asked of loaded flanks over the face, on solutions made up: by hand, station by station."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact import tooth_loss
from fegear.contact.fourier import panels
from fegear.contact.wide import both_flanks
from fegear.design.robustness import deviated_flanks
from fegear.design.robustness.deviated_flanks import FlankBench, deviated_gaps, flank_outcomes
from fegear.dynamics.planetary import flank_law
from fegear.dynamics.planetary.flank_law import FlankSprings
from fegear.geometry.pair import MEMBERS
from fegear.results.planetary import planet_vibration

PITCH = 8.0


class Lines:
    """Two roll positions: one with two lines of two stations each, one with a single line; the last station is none."""

    roll = np.array([1.0, 2.0])
    x = np.array([[1.0, 1.0, -7.0, -7.0], [2.0, 2.0, 0.0, 0.0]])
    pair = np.array([[0, 0, -1, -1], [0, 0, 0, 0]])
    present = np.array([[True, True, True, True], [True, True, False, False]])

    def at(self, p):
        return [slice(0, 2), slice(2, 4)] if p == 0 else [slice(0, 2)]

    def mean(self, values):
        return 0.25 * values[0] + 0.75 * values[1]


def test_the_loss_over_the_face_is_force_friction_and_sliding_of_every_station(monkeypatch):
    force = np.array([[3.0, 5.0, 2.0, 4.0], [6.0, 8.0, 9.0, 9.0]])
    per_length = 10.0 * force
    helix = 0.3
    pair = SimpleNamespace(
        base_pitch=PITCH, driver=SimpleNamespace(base_helix_angle=helix, base_radius=0.5), name="pair"
    )
    found = SimpleNamespace(
        pair=pair, lines=Lines(), load=np.array([1.0, 14.0]),
        contact=SimpleNamespace(force=np.stack([0.0 * force, force], axis=-1)),
        line_load=np.stack([0.0 * force, per_length], axis=-1),
    )  # fmt: skip
    asked = []

    def law(at, load):
        asked.append(load)
        return 0.01 + 1e-3 * load

    monkeypatch.setattr(tooth_loss, "flank_speeds", lambda pair, x, speed: SimpleNamespace(sliding=-speed * x))
    monkeypatch.setattr(tooth_loss, "computed", lambda pair, mean: ("H_V of", mean))
    loss = tooth_loss.loss_over_face(found, 1, 20.0, law)
    here = np.where(Lines.present, force, 0.0)
    np.testing.assert_array_equal(asked[0], np.where(Lines.present, per_length, 0.0))
    mu = 0.01 + 1e-3 * asked[0]
    power = mu * here * 20.0 * np.abs(Lines.x) / math.cos(helix)
    # Lines in the order of their place: that of the pair behind comes first.
    assert loss.x.tolist() == [1.0 - PITCH, 1.0, 2.0]
    assert loss.load.tolist() == [6.0, 8.0, 14.0]
    lines = [(0, slice(2, 4)), (0, slice(0, 2)), (1, slice(0, 2))]
    assert loss.power == pytest.approx([power[at].sum() for at in lines])
    assert loss.coefficient == pytest.approx([(mu * here)[at].sum() / here[at].sum() for at in lines])
    assert loss.loss == pytest.approx(0.25 * power[0].sum() + 0.75 * power[1].sum())
    assert loss.transmitted == pytest.approx(14.0 * 20.0 * 0.5)
    mean = (0.25 * (here * np.abs(Lines.x))[0].sum() + 0.75 * (here * np.abs(Lines.x))[1].sum()) / 14.0
    assert loss.loss_factor == ("H_V of", pytest.approx(mean))
    none = tooth_loss.loss_over_face(SimpleNamespace(**vars(found) | {
        "contact": SimpleNamespace(force=np.stack([force, 0.0 * force], axis=-1))}), 1, 20.0, law)  # fmt: skip
    assert none.coefficient.tolist() == [0.0, 0.0, 0.0]
    assert none.power.tolist() == [0.0, 0.0, 0.0]


def test_a_fillet_is_followed_at_one_height_under_the_nominal_load(monkeypatch):
    """Beside a contact line, where stress is no root stress, the last known one below it stands."""
    force = np.arange(12.0).reshape(2, 3, 2)
    asked = []

    class Rooted:
        x = np.array([0.1, 0.2])

        def along_fillets(self, side, forces, z):
            asked.append((side, forces, z))
            stress = np.arange(6.0).reshape(3, 1, 2) + (100.0 if side == "tension" else 0.0)
            stress[2, 0, 1] = np.nan
            return stress

    def rooted_lines(pair, member, lines, solution, coupling):
        asked.append((pair, member, lines, coupling))
        return Rooted()

    monkeypatch.setattr(both_flanks, "rooted_lines", rooted_lines)
    fillets = {side: SimpleNamespace(arc=np.arange(3.0), length=length) for side, length in
               (("tension", 2.5), ("compression", 2.4))}  # fmt: skip
    found = SimpleNamespace(lines="lines", contact=SimpleNamespace(force=force))
    teeth = SimpleNamespace(found=found, pair="pair", coupling=True, at=1)
    trace = both_flanks.fillet_trace_at(teeth, "driven", SimpleNamespace(fillets=fillets), 3e-3)
    assert asked[0] == ("pair", "driven", "lines", True)
    for side, forces, z in asked[1:]:
        assert side in fillets
        np.testing.assert_array_equal(forces, force[:, :, 1])
        assert z == [3e-3]
    assert trace.x is Rooted.x
    assert trace.stress["tension"].tolist() == [[100.0, 102.0, 104.0], [101.0, 103.0, 103.0]]
    assert trace.stress["compression"].tolist() == [[0.0, 2.0, 4.0], [1.0, 3.0, 3.0]]
    assert trace.length == 2.4


@pytest.fixture
def springs(monkeypatch):
    """Six positions in two pieces of a base pitch of 8; of two pairs one lets go within the second piece."""
    points = SimpleNamespace(x=np.arange(6.0) + 0.5, breaks=np.array([0.0, 3.0]), period=8.0)
    loads = np.array([10.0, 100.0, 300.0])
    bears = np.ones((2, 6, 3))
    bears[1, 4:, 1:] = 0.0
    bears[1, :, 0] = [1, 0, 1, 0, 1, 0]  # of a small force, which does not tell
    te = np.stack([points.x * load for load in loads], axis=1)
    solved = SimpleNamespace(
        pair_load=bears * loads, transmission_error=te,
        contact=SimpleNamespace(stiffness=np.stack([np.arange(6.0), np.zeros(6)], axis=1)),
    )  # fmt: skip
    error = SimpleNamespace(transmission_error=np.stack([np.zeros(6), 1e-3 * np.arange(6.0)], axis=1))
    gaps = SimpleNamespace(driver_spacing=np.zeros(0), driven_spacing=np.zeros(0))
    found = SimpleNamespace(lines=SimpleNamespace(roll=points.x))
    teeth = SimpleNamespace(gaps=gaps, estimated=True, at=1, error=error, found=found)
    monkeypatch.setattr(flank_law, "forces", lambda load, planets: (loads, 1))
    monkeypatch.setattr(flank_law, "every_second", lambda _: np.array([0, 2, 4]))

    class Made(FlankSprings):
        _points = points

    Made.solved = solved
    return Made(teeth, 100.0, 3), points, te


def test_a_law_is_straight_where_flanks_let_go_under_a_force_that_tells(springs):
    made, points, _ = springs
    assert made._straight.tolist() == [False, False, True]
    assert (made.breaks * points.period).tolist() == [0.0, 3.0, 3.5, 4.5, 5.5]


def test_between_roll_positions_a_law_is_a_curve_or_straight(springs, monkeypatch):
    made, *_ = springs
    monkeypatch.setattr(flank_law, "curve_through", lambda points, values, x: 1000.0 + x)
    asked = {}

    def law(force, approach, stiffness, off):
        asked.update(force=force, approach=approach, stiffness=stiffness, off=off)
        return "springs"

    monkeypatch.setattr(flank_law, "springs", law)
    assert made.at(np.array([1.0 / 8.0, 5.0 / 8.0, 9.0 / 8.0, -3.0 / 8.0])) == "springs"
    x = np.array([1.0, 5.0, 1.0, 5.0])
    wanted = np.stack([np.where(x > 3.0, x * load, 1000.0 + x) for load in (10.0, 100.0, 300.0)], axis=1)
    assert asked["approach"] == pytest.approx(wanted)
    assert asked["stiffness"] == pytest.approx([1001.0, 4.5, 1001.0, 4.5])
    assert asked["force"].tolist() == [10.0, 100.0, 300.0]
    assert asked["off"].shape == (2, 4)


def test_a_law_errs_as_its_solutions_and_as_half_of_the_roll_positions(springs):
    made, points, _ = springs
    x = np.array([1.5, 2.5, 5.5])
    mean = points.x**2
    by_solution, by_half = made._off(x, mean)
    assert by_solution == pytest.approx([1e-3, 2e-3, 5e-3])
    # Half of them: straight between 0.5, 2.5, 4.5 and on to 8.5; a third of the difference.
    last = 4.5**2 + (0.5**2 - 4.5**2) * 1.0 / 4.0
    assert by_half == pytest.approx([(0.5 * (0.25 + 6.25) - 2.25) / 3.0, 0.0, (last - 5.5**2) / 3.0])
    made.teeth.estimated = False
    assert made._off(x, mean).shape == (0, 3)
    made.teeth.gaps.driven_spacing = np.ones(3)
    with pytest.raises(InputError, match="are not supported in a planetary set"):
        FlankSprings(made.teeth, 1.0, 3)


def test_what_comes_of_deviated_flanks_is_read_off_their_solution(monkeypatch):
    points = panels(0.0, 8.0, [3.0])
    te = 5.0 + 2.0 * np.cos(2.0 * np.pi * points.x / points.period + 0.4)
    force = np.arange(2.0 * te.size).reshape(te.size, 2, 1)
    asked = []

    class Loaded:
        def __init__(self, pair, known, contact, load, seconds):
            asked.append((pair, known, contact.force, load.tolist()))
            self.transmission_error = te[:, None]
            self.face_load_factor, self.largest_pressure = np.array([1.3]), np.array([9e8])
            self.largest_line_load = np.array([4e5])

    def solve(known, gap, load):
        assert (known, gap, load.tolist()) == (bench.known, "gap", [77.0])
        return SimpleNamespace(force=force)

    monkeypatch.setattr(deviated_flanks, "solve_contact", solve)
    monkeypatch.setattr(deviated_flanks, "LoadedFlanks", Loaded)
    roots = tuple(SimpleNamespace(largest=lambda f, k=k: k * f.sum()) for k in (1.0, 2.0))
    known = SimpleNamespace(lines="lines")
    bench = FlankBench("pair", known, None, points, 77.0, roots)
    gaps = SimpleNamespace(at=lambda pair, lines: "gap" if (pair, lines) == ("pair", "lines") else None)
    swing, mean, *amplitudes, face, first, second, pressure, line = flank_outcomes(bench, gaps)
    assert swing == pytest.approx(np.ptp(te))
    assert mean == pytest.approx(5.0, rel=1e-6)
    assert amplitudes == pytest.approx([2.0] + [0.0] * (len(amplitudes) - 1), abs=1e-5)
    assert (face, first, second, pressure, line) == (1.3, force.sum(), 2.0 * force.sum(), 9e8, 4e5)
    assert len(asked) == 1


def test_between_solved_centre_distances_outcomes_are_straight(monkeypatch):
    monkeypatch.setattr(deviated_flanks, "flank_outcomes", lambda bench, gaps: np.array(bench))
    made = deviated_flanks.FlankBenches
    benches = made((1.0, 10.0), (3.0, 20.0), (0.0, 50.0), 2e-5)
    assert benches.outcomes(None, 0.0).tolist() == [1.0, 10.0]
    assert benches.outcomes(None, -1e-5) == pytest.approx([2.0, 15.0])
    assert benches.outcomes(None, 1e-5) == pytest.approx([0.5, 30.0])
    assert made((1.0, 10.0)).outcomes(None, 1e-5).tolist() == [1.0, 10.0]


def test_a_mesh_s_errors_are_shares_of_its_amplitudes_and_one_where_none_is_shown():
    share = planet_vibration._shares(np.array([1.0, 3.0, 1.0, 5.0]), np.array([4.0, 2.0, 0.0, 10.0]), 6)
    assert share.tolist() == [0.25, 1.0, 0.0, 0.5, 1.0, 1.0]
    assert planet_vibration._shares(np.ones(4), np.full(4, 2.0), 2).tolist() == [0.5, 0.5]


def test_deviations_of_a_draw_stand_on_each_gear_s_own_flank():
    """Profiles are evaluated between the roll angles of the path, lines over the face of the gear itself."""
    ends = {"driver": (0.3, 0.1), "driven": (0.2, 0.6)}
    pair = SimpleNamespace(
        x_start=-1.0, x_end=1.0, roll_angle=lambda x, member: ends[member][int(x > 0)],
        gear=lambda member: SimpleNamespace(teeth=3 if member == "driver" else 5,
                                            face_width=0.02 if member == "driver" else 0.03),
    )  # fmt: skip
    gaps = deviated_flanks.FlankGaps()
    bench = SimpleNamespace(pair=pair, gaps=gaps)

    class Drawn:
        profile_slope, profile_form = np.array([[1e-6, 2e-6]]), np.array([[3e-6, 4e-6]])
        waves, phase, helix_slope = np.array([[2.0, 3.0]]), np.array([[0.1, 0.2]]), np.array([[5e-6, 6e-6]])

        def spacing(self, row, i, teeth):
            return np.full(teeth, float(i + row))

    found = deviated_gaps(bench, Drawn(), 0)
    for i, (member, relief, flank) in enumerate(
        zip(MEMBERS, (found.driver_relief, found.driven_relief), (found.driver_flank, found.driven_flank), strict=True)
    ):
        off, lead = relief.parts[-1], flank[-1]
        assert [off.start, off.end] == sorted(ends[member])
        assert [off.slope, off.form, off.waves, off.phase] == pytest.approx(
            [(i + 1) * 1e-6, (i + 3) * 1e-6, i + 2.0, 0.1 * (i + 1)]
        )
        assert [lead.amount, lead.face_width] == pytest.approx([(i + 5) * 1e-6, (0.02, 0.03)[i]])
    assert found.driver_spacing.tolist() == [0.0] * 3
    assert found.driven_spacing.tolist() == [1.0] * 5
