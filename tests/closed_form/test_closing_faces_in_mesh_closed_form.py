"""Crack faces that close while tooth pairs share the load: all sets tried, laws, and whole gears without any table."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.contact_law import LINEAR, ContactLaw
from fegear.contact.plane import closing_faces
from fegear.contact.plane.closing_faces import ClosingFaces, share_with_faces
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.load_sharing import share_load
from fegear.contact.plane.odd_compliance import odd_compliance
from fegear.contact.plane.over_revolution import over_revolution
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress_history import superposed_stress
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

LOAD = 2500.0
TOOTH = Tooth(25, BasicRack())
GEAR = Gear(TOOTH, 2e-3, TOOTH.root_radius * 1e-3, 20e-3, Material(206e9))
PAIR = GearPair(GEAR, GEAR)
PLAIN = solve_gear(GEAR, settings_at(-4), reach=2)


def drawn(rng, pairs, nodes, positions):
    """Compliances of pairs and of faces that belong to one body, loads and separations."""
    every = []
    for _ in range(positions):
        factor = rng.normal(size=(pairs + nodes, pairs + nodes))
        every.append(factor @ factor.T + 0.05 * np.eye(pairs + nodes))
    whole = np.stack(every, axis=-1)
    # one face compliance for all positions, the rest so that each whole stays positive definite
    face = whole[pairs:, pairs:, 0]
    opening = whole[pairs:, :pairs]
    own = whole[:pairs, :pairs].copy()
    for p in range(positions):
        more = opening[:, :, p].T @ np.linalg.solve(face, opening[:, :, p])
        own[:, :, p] += more
    return own, ClosingFaces(opening, face, {"driver": slice(0, nodes)}), rng.uniform(0.0, 2.0, (pairs, positions))


def by_trying(c, opening, face, e, total):
    """The only answer among all sets of loaded pairs and pressed nodes."""
    n, count = c.shape[0], face.shape[0]
    whole = np.block([[c, opening.T], [opening, face]])
    for on in itertools.product([False, True], repeat=n + count):
        at = np.flatnonzero(on)
        if not any(on[:n]):
            continue
        ones, gaps = (at < n).astype(float), np.where(at < n, np.append(e, np.zeros(count))[at], 0.0)
        system = np.block([[whole[np.ix_(at, at)], -ones[:, None]], [ones[None], np.zeros((1, 1))]])
        answer = np.linalg.solve(system, np.append(-gaps, total))
        force, zeta = np.zeros(n + count), answer[-1]
        force[at] = answer[:-1]
        gap = whole @ force + np.append(e - zeta, np.zeros(count))
        if (force >= -1e-10).all() and (gap >= -1e-10).all():
            return force[:n], zeta
    raise AssertionError("no set")


@pytest.mark.parametrize("whole_steps", [8, 0])
def test_every_set_of_pairs_and_nodes_tried(monkeypatch, whole_steps):
    """Random bodies; with whole steps first, and with every step shortened."""
    monkeypatch.setattr(closing_faces, "_WHOLE_STEPS", whole_steps)
    rng = np.random.default_rng(51)
    for pairs, nodes in ((1, 3), (2, 4), (3, 5)):
        c, faces, e = drawn(rng, pairs, nodes, 6)
        for total in (0.3, 3.0):
            found = share_with_faces(c, faces, e, [total], LINEAR)
            for p in range(6):
                loads, zeta = by_trying(c[:, :, p], faces.opening[:, :, p], faces.compliance, e[:, p], total)
                assert found.loads[:, p, 0] == pytest.approx(loads, abs=1e-8)
                assert found.transmission_error[p, 0] == pytest.approx(zeta, rel=1e-8)


def test_never_closing_is_open_and_always_closing_is_shut():
    """Faces that every load opens change no digit; those that every load shuts are a support."""
    rng = np.random.default_rng(7)
    c, faces, e = drawn(rng, 3, 4, 5)
    law = ContactLaw(np.full((3, 5), 1e-2), 1.0)
    opened = replace(faces, opening=np.abs(faces.opening))
    one, other = (share_with_faces(c, opened, e, [1.0, 4.0], law), share_load(c, e, [1.0, 4.0], law))
    assert np.array_equal(one.loads, other.loads)
    assert np.array_equal(one.transmission_error, other.transmission_error)
    # faces that are of a diagonal compliance and opened negatively by all pairs are shut together
    shut = ClosingFaces(-np.abs(faces.opening), np.diag(np.diagonal(faces.compliance)), faces.of)
    less = np.einsum("kip,k,kjp->ijp", shut.opening, 1.0 / np.diagonal(shut.compliance), shut.opening)
    one, other = (share_with_faces(c + less, shut, e, [1.0, 4.0], law), share_load(c, e, [1.0, 4.0], law))
    assert one.loads == pytest.approx(other.loads, rel=1e-9, abs=1e-12)
    assert one.transmission_error == pytest.approx(other.transmission_error, rel=1e-12)


def cracked(share, *, back, closing, number=0):
    crack = straight_crack(
        TOOTH, mouth_at_tangent(TOOTH, math.radians(30.0)), math.radians(70.0), share=share, back=back
    )
    return solve_cracked_gear(PLAIN, {number: replace(crack, closing=closing)})


def engagement(one):
    return Engagement(PairCompliance(PAIR, odd_compliance(one), finite_element_compliance(PLAIN)), corner_contact=False)


@pytest.mark.parametrize(("share", "back"), [(0.6, True), (0.6, False)])
def test_a_revolution_with_the_whole_gears(share, back):
    """Both complementarities hold with influence functions that were not tabulated; root stress adds up."""
    known = cracked(share, back=back, closing=True)
    e = engagement(known)
    grid = e.grid(np.linspace(PAIR.x_start, PAIR.x_start + PAIR.base_pitch, 9)[:-1] + 1e-5)
    source, face = e.compliance.driver, PAIR.face_width
    seen = []
    for cycle in range(-2, 3):
        state = e.solve(grid, [LOAD], cycle)
        loads, contacts = state.loads[:, :, 0] / face, grid.contacts
        teeth = [e.compliance.tooth("driver", int(j), cycle) for j in contacts.number]
        opening = np.zeros((known.faces_compliance.shape[0], grid.x.size))
        for row, i in enumerate(teeth):
            if source.moves_faces(i):
                opening += known.openings(known.from_middle(i), contacts.radius_driver[row]) * loads[row]
        faces = state.grid.matrices.faces
        pressed = faces.forces(state.loads)[:, :, 0] / face
        gap, size = opening + known.faces_compliance @ pressed, np.abs(opening).max()
        assert (pressed >= 0.0).all()
        assert gap.min() > -2e-5 * size
        assert np.abs(gap * pressed).max() < 2e-5 * size * max(pressed.max(), 1e-300)
        # deflections of loaded pairs are one transmission error
        free = state.grid.matrices
        u = np.einsum("ijp,jp->ip", free.compliance, state.loads[:, :, 0])
        own = free.compliance[np.arange(len(teeth)), np.arange(len(teeth))]
        u += (free.law.secant(own, state.loads[:, :, 0]) - own) * state.loads[:, :, 0]
        u += np.einsum("kip,kp->ip", faces.opening, pressed * face)
        zeta = state.transmission_error[:, 0]
        on = loads > 0.0
        assert np.abs(np.where(on, u - zeta, 0.0)).max() < 1e-9 * zeta.max()
        assert np.where(~on & contacts.present, u - zeta, 0.0).min() > -1e-9 * zeta.max()
        seen.append((pressed > 0.0).mean())
        # root stress of the cracked tooth and of the next one, added by hand
        along = list(superposed_stress(e, state, "driver"))
        for row, i in enumerate(teeth):
            if known.from_middle(i) not in (0, 1):
                continue
            total = known.stress_by_faces(i, "tension") @ pressed
            for other, j in enumerate(teeth):
                if known.from_middle(j) in known.known and on[other].any() and abs(i - j) <= 2:
                    radius = np.clip(contacts.radius_driver[other], *known.ends(known.from_middle(j)))
                    total += known.fillet_stress(i, j, "tension", radius, free=True) * loads[other]
            assert np.abs(along[row][:, 0].T - total).max() < 1e-6 * np.abs(total).max()
    assert max(seen) > 0.5
    assert (seen[2] > 0.0) == back


def test_a_revolution_between_no_crack_and_open_faces():
    """A crack that its load shuts is a little softer than none, far from the free one; with every pair of teeth."""
    opened, shut = (
        over_revolution(engagement(cracked(0.4, back=True, closing=one)), LOAD, 24) for one in (False, True)
    )
    assert opened.stiffness_loss > 0.25
    assert 0.003 < shut.stiffness_loss < 0.03
    assert shut.largest_residual < 0.05 * opened.largest_residual
    # local stiffness is the slope of the transmission error over the load, with the faces that close
    e = engagement(cracked(0.4, back=True, closing=True))
    grid, step = e.grid(np.linspace(PAIR.x_start, PAIR.x_start + PAIR.base_pitch, 6)[1:-1]), 1e-3
    low, here, high = (e.solve(grid, [LOAD * (1.0 + side * step)]) for side in (-1.0, 0.0, 1.0))
    slope = 2.0 * step * LOAD / (high.transmission_error - low.transmission_error)
    assert here.local_stiffness == pytest.approx(slope, rel=1e-5)
