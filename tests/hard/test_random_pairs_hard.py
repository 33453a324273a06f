"""Laws of contact on random pairs, reliefs and loads, with tooth compliances in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.base.errors import GeometryError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import CombinedRelief, crowning, root_relief, tip_relief

pytestmark = pytest.mark.last_bit

FACE = 0.02


@st.composite
def pairs(draw):
    alpha = math.radians(draw(st.floats(14.0, 28.0)))
    addendum = draw(st.floats(0.8, 1.3))
    gears = []
    try:
        rack = BasicRack(addendum, addendum + 0.25, 0.15, alpha)
        for _ in range(2):
            z, x = draw(st.integers(12, 150)), draw(st.floats(-0.3, 0.6))
            rounding = draw(st.sampled_from([0.0, 0.0, 0.05]))
            tooth = Tooth(z, rack, x, thickness_allowance=0.02, tip_rounding=rounding)
            gears.append(Gear(tooth, 3e-3, 0.5 * tooth.root_radius * 3e-3, FACE))
        tight = GearPair(*gears).centre_distance
        pair = GearPair(*gears, tight * (1.0 + draw(st.sampled_from([0.0, 1e-4, 2e-3]))))
    except GeometryError:
        assume(False)
    assume(pair.contact_ratio > 1.0)
    return pair


@st.composite
def reliefs(draw, gear):
    """Up to three parts of any kind, from nothing to more than any load closes."""
    parts = []
    amount = st.sampled_from([1e-9, 1e-6, 1e-5, 5e-5, 1e-3])
    span = float(gear.tooth.involute.end - gear.tooth.involute.start) * gear.base_radius
    if draw(st.booleans()):
        parts.append(tip_relief(gear, draw(amount), length=draw(st.floats(0.02, 0.9)) * span))
    if draw(st.booleans()):
        parts.append(
            root_relief(gear, draw(amount), end_radius=gear.form_radius, length=draw(st.floats(0.02, 0.9)) * span)
        )
    if draw(st.booleans()):
        parts.append(crowning(gear, draw(amount), gear.form_radius, gear.involute_tip_radius))
    return CombinedRelief(tuple(parts))


@st.composite
def engagements(draw):
    pair = draw(pairs())
    sources = [closed_form_compliance(g, "weber-banaschek") for g in (pair.driver, pair.driven)]
    compliance = PairCompliance(pair, *sources, False, draw(st.sampled_from(["load-dependent", "linear"])), 2000.0)
    return Engagement(
        compliance, draw(reliefs(pair.driver)), draw(reliefs(pair.driven)), corner_contact=draw(st.booleans())
    )


def positions(e, n=9):
    return e.pair.x_start + e.pair.base_pitch * (np.arange(n) + 0.37) / n


@pytest.mark.examples(25, 1000)
@given(engagements(), st.floats(-3.0, 4.0))
def test_loads_and_gaps_complement_each_other_and_add_up(e, log_line_load):
    load = 10.0**log_line_load * 1e3 * FACE
    got = e.solve(e.grid(positions(e)), [load])
    w, z = got.loads[:, :, 0], got.transmission_error[:, 0]
    assert (w >= 0.0).all()
    assert w.sum(axis=0) == pytest.approx(np.full(z.size, load), rel=1e-13)
    u = np.einsum("jkp,kp->jp", got.grid.matrices.at_load(got.loads)[..., 0], w)
    gap = np.where(got.grid.contacts.present, u + got.separation - z, np.inf)
    scale = np.abs(z) + np.abs(u).max() + np.where(got.grid.contacts.present, got.separation, 0.0).max()
    assert (gap >= -1e-11 * scale).all()
    touching = np.where(w > 1e-9 * load, np.abs(gap), 0.0)
    assert (touching <= 1e-11 * scale).all()


@pytest.mark.examples(25, 1000)
@given(engagements(), st.floats(-2.0, 3.0), st.floats(1.01, 20.0))
def test_more_load_brings_the_gears_closer_at_every_position(e, log_line_load, factor):
    load = 10.0**log_line_load * 1e3 * FACE
    got = e.solve(e.grid(positions(e)), [load, factor * load])
    z = got.transmission_error
    assert (z[:, 1] > z[:, 0]).all()
    assert (got.local_stiffness > 0.0).all()
    # Energy put in is at least the load at the start times the way: the mesh only stiffens as pairs join in.
    assert (np.diff(got.loads, axis=2) >= -1e-9 * factor * load).all()


@pytest.mark.examples(25, 1000)
@given(engagements(), st.floats(-1.0, 3.0))
def test_driver_and_driven_swapped_mirror_everything(e, log_line_load):
    load = 10.0**log_line_load * 1e3 * FACE
    c = e.compliance
    back = Engagement(
        replace(c, pair=e.pair.reversed(), driver=c.driven, driven=c.driver), e.driven_relief, e.driver_relief,
        corner_contact=e.corner_contact,
    )  # fmt: skip
    x = positions(e)
    one, other = e.solve(e.grid(x), [load]), back.solve(back.grid(-x), [load])
    size = np.abs(one.transmission_error).max()
    assert other.transmission_error == pytest.approx(one.transmission_error, rel=1e-8, abs=1e-9 * size)
    assert np.sort(other.loads.max(axis=0)) == pytest.approx(np.sort(one.loads.max(axis=0)), rel=1e-6)


@given(pairs(), st.floats(0.2, 20.0), st.floats(0.0, 3.0))
def test_twice_the_size_at_twice_the_load_deflects_twice(pair, factor, log_line_load):
    """The line load per size is what counts; relief would have to grow along."""
    load = 10.0**log_line_load * 1e3 * FACE

    def engaged(at):
        sources = [closed_form_compliance(g, "weber-banaschek") for g in (at.driver, at.driven)]
        return Engagement(PairCompliance(at, *sources, False))

    def larger(gear):
        return replace(
            gear, module=factor * gear.module, bore_radius=factor * gear.bore_radius, face_width=factor * FACE
        )

    big = GearPair(larger(pair.driver), larger(pair.driven), factor * pair.centre_distance)
    small, large = engaged(pair), engaged(big)
    one = small.solve(small.grid(positions(small)), [load])
    other = large.solve(large.grid(positions(large)), [factor**2 * load])
    assert other.transmission_error == pytest.approx(factor * one.transmission_error, rel=1e-9)
    assert other.loads == pytest.approx(factor**2 * one.loads, rel=1e-7, abs=1e-9 * factor**2 * load)


@pytest.mark.examples(12, 300)
@given(engagements(), st.floats(0.0, 3.0))
def test_the_series_of_a_transmission_error_is_that_of_its_curve(e, log_line_load):
    """Parseval's bound, and the mean between the extremes, whatever kinks reliefs and contact changes leave."""
    load = 10.0**log_line_load * 1e3 * FACE
    te = transmission_error(e, load)
    curve = te.loaded.transmission_error[:, 0]
    assert np.isfinite(te.series.coefficients).all()
    assert curve.min() - 1e-15 <= te.mean <= curve.max() + 1e-15
    weights = te.points.weights / te.points.period
    variance = float(weights @ (curve - te.mean) ** 2)
    harmonics = 0.5 * float((te.series.amplitude**2).sum())
    assert harmonics <= variance * (1.0 + 1e-6) + 1e-30
    assert te.peak_to_peak == pytest.approx(np.ptp(curve), rel=0.2, abs=1e-12)


@pytest.mark.examples(25, 1000)
@given(engagements(), st.floats(-1.0, 3.0))
def test_extremes_and_mean_of_the_transmission_error_are_those_of_many_positions(e, log_line_load):
    load = 10.0**log_line_load * 1e3 * FACE
    found = transmission_error(e, load)
    x = e.pair.x_start + e.pair.base_pitch * (np.arange(6000) + 0.5) / 6000
    got = e.solve(e.grid(x, again=False), [load])
    te = got.transmission_error[:, 0]
    size, steps = np.ptp(te), np.abs(np.diff(te))
    between = steps[steps < 0.05 * size].max(initial=0.0)  # two positions apart but for jumps
    assert size * (1.0 - 4e-6) - 1e-9 * te.max() <= found.peak_to_peak <= size + 2.0 * between + 1e-9 * te.max()
    assert found.mean == pytest.approx(te.mean(), abs=2e-4 * size + 1e-9 * te.max())
    # Every change of contact among the many positions is one of its break points.
    loaded = got.loads[:, :, 0] > 0.0
    changes = np.flatnonzero((loaded[:, 1:] != loaded[:, :-1]).any(axis=0))
    breaks = np.concatenate([found.points.breaks, e.breaks])
    step = e.pair.base_pitch / 6000
    for low, high in zip(x[changes], x[changes + 1], strict=True):
        assert ((breaks > low - 1e-3 * step) & (breaks < high + 1e-3 * step)).any()
