"""Mark's four-square rig by his determinants (2.45 to 2.59): what general elimination is compared with.

Body 1 meshes with body 2 (mesh I) and with body 3 (mesh II) at ratio one; dampers to ground on each, and one between 2
and 3, which close the square without stiffness. The numerators (2.55, 2.56) are those in print; the determinant (2.57)
is lost in the text that we have and was derived anew from (2.46). With s = i w, a = R^2/C_I and b = R^2/C_II all are
polynomials in s.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Complex
    from fegear.dynamics.train.train import Mesh, Train

#: Relative difference up to which base radii count as equal.
_SAME = 1e-9


@dataclass(frozen=True)
class FourSquare:
    """The constants of the rig.

    Parameters
    ----------
    inertia : tuple of float
        I_1, I_2, I_3 [kg m^2].
    damping : tuple of float
        c_1, c_2, c_3 and c_a [N m s/rad].
    radius : float
        R [m].
    stiffness : tuple of float
        1/C_I, 1/C_II [N/m].
    sense : int
        1 where the transmission error of mesh II enters with a minus beside that of mesh I, as in print; else -1.
    """

    inertia: tuple[float, float, float]
    damping: tuple[float, float, float, float]
    radius: float
    stiffness: tuple[float, float]
    sense: int = 1

    @classmethod
    def of(cls, train: Train) -> FourSquare:
        """The rig that a train is.

        Raises
        ------
        InputError
            If it is another train.
        """
        radius, sense = _radius(train)
        first, second = train.meshes
        shared = {first.a, first.b} & {second.a, second.b}
        (one,) = shared
        names = [one, *(mesh.b if mesh.a == one else mesh.a for mesh in train.meshes)]
        inertia = {body.name: body.inertia for body in train.bodies}
        damping = [0.0, 0.0, 0.0, 0.0]
        for damper in train.dampers:
            ends = {damper.a, damper.b} - {None}
            if len(ends) == 1:
                damping[names.index(damper.a)] += damper.damping
            elif ends == {names[1], names[2]}:
                damping[3] += damper.damping
            elif damper.damping:
                _refuse(f"a damper between {damper.a} and {damper.b}")
        i1, i2, i3 = (inertia[name] for name in names)
        c1, c2, c3, ca = damping
        return cls((i1, i2, i3), (c1, c2, c3, ca), radius, (first.stiffness, second.stiffness), sense)

    @cached_property
    def springs(self) -> tuple[float, float]:
        """The meshes as springs against rotation, a = R^2/C_I and b = R^2/C_II [N m/rad]."""
        k1, k2 = self.stiffness
        return k1 * self.radius**2, k2 * self.radius**2

    def determinant(self, omega: ArrayLike) -> Complex:
        """D [(N m)^3] by (2.57), from its polynomial in s."""
        return _value(self._determinant(*self.springs), omega)

    def determinant_of_elements(self, omega: ArrayLike) -> Complex:
        """D [(N m)^3] by (2.46c), from the elements (2.39)."""
        s = 1j * np.asarray(omega, dtype=float)
        (i1, i2, i3), (c1, c2, c3, ca), (a, b) = self.inertia, self.damping, self.springs
        a11, a22, a33 = s**2 * i1 + s * c1 + a + b, s**2 * i2 + s * (c2 + ca) + a, s**2 * i3 + s * (c3 + ca) + b
        a12, a13, a23 = a, b, -s * ca
        found = a11 * (a22 * a33 - a23**2) - a12 * (a12 * a33 - a13 * a23) + a13 * (a12 * a23 - a13 * a22)
        return np.asarray(found)

    def numerators(self, omega: ArrayLike) -> tuple[Complex, Complex]:
        """N_1,I + N_2,I and N_1,II + N_2,II [N (N m)^2] by (2.55) and (2.56)."""
        (i1, i2, i3), (c1, c2, c3, ca), (k1, k2) = self.inertia, self.damping, self.stiffness
        b, all_c, all_i = self.springs[1], c1 + c2 + c3, i1 + i2 + i3
        own = [
            0.0,
            all_c * b,
            all_i * b + all_c * ca + (c1 + c2) * c3,
            (i1 + i2) * (c3 + ca) + i3 * (c1 + c2 + ca),
            (i1 + i2) * i3,
        ]
        cross = [0.0, 0.0, all_c * ca + c2 * c3, all_i * ca + i2 * c3 + i3 * c2, i2 * i3]
        r = self.radius
        return r * k1 * _value(own, omega), -r * k2 * _value(cross, omega)

    def as_printed(self, omega: ArrayLike) -> tuple[Complex, Complex]:
        """Q_I,I and Q_I,II as (2.58) and (2.59) have them; the first loses its digits where the train turns slowly."""
        d = self.determinant(omega)
        own, cross = self.numerators(omega)
        return self.radius * own / d - 1.0, self.sense * self.radius * cross / d

    def own_by_ratio(self, omega: ArrayLike) -> Complex:
        """Q_I,I as -D(mesh I removed)/D: the same without the difference that cancels."""
        a, b = self.springs
        without, whole = (_value(self._determinant(spring, b)[1:], omega) for spring in (0.0, a))
        return -without / whole

    def _determinant(self, a: float, b: float) -> list[float]:
        """Coefficients of (2.57), from s^0 on."""
        (i1, i2, i3), (c1, c2, c3, ca) = self.inertia, self.damping
        sides = c2 * c3 + ca * (c2 + c3)
        return [
            0.0,
            a * b * (c1 + c2 + c3),
            a * b * (i1 + i2 + i3) + a * ((c1 + c2) * (c3 + ca) + c3 * ca) + b * ((c1 + c3) * (c2 + ca) + c2 * ca),
            a * ((i1 + i2) * (c3 + ca) + i3 * (c1 + c2 + ca))
            + b * ((i1 + i3) * (c2 + ca) + i2 * (c1 + c3 + ca))
            + c1 * sides,
            a * (i1 + i2) * i3 + b * (i1 + i3) * i2 + i1 * sides + i2 * c1 * (c3 + ca) + i3 * c1 * (c2 + ca),
            i1 * i2 * (c3 + ca) + i1 * i3 * (c2 + ca) + i2 * i3 * c1,
            i1 * i2 * i3,
        ]


def _value(coefficients: list[float], omega: ArrayLike) -> Complex:
    """A polynomial in s = i w."""
    s = 1j * np.asarray(omega, dtype=float)
    return np.asarray(np.polynomial.polynomial.polyval(s, np.array(coefficients)))


def _radius(train: Train) -> tuple[float, int]:
    """R of all gears, and how the meshes stand to each other."""
    if len(train.bodies) != 3 or train.size != 3 or train.shafts:
        _refuse(f"{len(train.bodies)} bodies and {len(train.shafts)} shafts")
    if len(train.meshes) != 2:
        _refuse(f"{len(train.meshes)} meshes")
    first, second = train.meshes
    if len({first.a, first.b} & {second.a, second.b}) != 1:
        _refuse("two meshes between the same bodies")
    signs = []
    for mesh in train.meshes:
        signs.append(_sign(mesh, abs(first.radius_a)))
        if mesh.damping:
            _refuse(f"damping in mesh {mesh.name}")
    return abs(first.radius_a), -signs[0] * signs[1]


def _sign(mesh: Mesh, radius: float) -> int:
    """Sign of the approach of a mesh; both of its gears have the base radius R."""
    if any(abs(abs(r) - radius) > _SAME * radius for r in (mesh.radius_a, mesh.radius_b)) or (
        mesh.radius_a * mesh.radius_b < 0.0
    ):
        _refuse(f"mesh {mesh.name} with other base radii")
    return 1 if mesh.radius_a > 0.0 else -1


def _refuse(what: str) -> NoReturn:
    raise InputError(
        "dynamics.determinants", "true",
        "requires Mark's test rig (three bodies, two meshes of ratio 1 and equal base radii sharing a body, no "
        f"shafts, no mesh damping); this train has {what}",
        "remove dynamics.determinants",
    )  # fmt: skip


def relative_difference(one: Complex, other: Complex) -> Array:
    """|one - other| over |other|, entry by entry; 0 where both vanish."""
    size = np.abs(other)
    return np.divide(np.abs(one - other), size, out=np.zeros(size.shape), where=size > 0.0)
