"""Mass and moments of a gear from polygons: its teeth as a dense outline, its body as a turned section."""

import math

import numpy as np

from fegear.geometry.outline import along


def of_teeth(tooth, chord=1e-8):
    """Area and polar moment of area of triangles from the axis to the chords of all teeth [modules]."""
    area = polar = 0.0
    for piece in tooth.outline.values():
        x, y = along(piece, chord)
        cross = x[:-1] * y[1:] - x[1:] * y[:-1]
        area += 0.5 * cross.sum()
        squares = sum(a[:-1] ** 2 + a[:-1] * a[1:] + a[1:] ** 2 for a in (x, y))
        polar += (cross * squares).sum() / 12.0
    return 2 * tooth.teeth * abs(area), 2 * tooth.teeth * abs(polar)


def turned(section):
    """Volume, and integrals of r^2, z and r^2/2 + z^2 over the volume of a polygon (z, r) turned about the axis."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    u, w = 0.5 * (nodes + 1.0), 0.5 * weights
    found = np.zeros(4)
    corners = np.asarray(section, dtype=float)
    for a, b in zip(corners[:-1] - corners[0], corners[1:] - corners[0], strict=True):
        cross = a[1] * b[0] - a[0] * b[1]  # clockwise outlines are positive
        for s, ws in zip(u, w, strict=True):
            for t, wt in zip(u, w, strict=True):
                z, r = corners[0] + s * ((1.0 - t) * a + t * b)
                found += 2.0 * math.pi * r * cross * s * ws * wt * np.array([1.0, r * r, z, 0.5 * r * r + z * z])
    return found


def of_gear(gear):
    """Mass, inertia about the axis, first moment along it, and inertia across it through the middle of the face."""
    area, polar = of_teeth(gear.tooth)
    circle = gear.bore_radius if gear.body is None else gear.body.rim_radius
    area = abs(area * gear.module**2 - math.pi * circle**2) * gear.face_width
    polar = abs(polar * gear.module**4 - 0.5 * math.pi * circle**4) * gear.face_width
    found = np.array([area, polar, 0.0, 0.5 * polar + area * gear.face_width**2 / 12.0])
    if (body := gear.body) is not None:
        found += turned(body.section(body.rim_radius, gear.bore_radius, gear.face_width))
        if (holes := body.holes) is not None:
            (low, high), around = body.web, 2.0 * math.pi * np.arange(holes.count) / holes.count + 0.3
            one = math.pi * holes.radius**2 * (high - low)
            for x, y in holes.circle_radius * np.stack([np.cos(around), np.sin(around)], axis=1):
                # across the axis on average over all directions, which one or two holes tell apart
                off = 0.5 * (x**2 + y**2)
                far = 0.25 * holes.radius**2 + (high - low) ** 2 / 12.0 + (0.5 * (low + high)) ** 2 + off
                spin = 0.5 * holes.radius**2 + holes.circle_radius**2
                found -= one * np.array([1.0, spin, 0.5 * (low + high), far])
    return gear.material.density * found
