"""What keeps the flanks of a pinion and a rack apart: the reliefs of both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.relief import UNMODIFIED, Relief

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.plane.meshing import Contacts
    from fegear.geometry.rack_and_pinion import RackAndPinion
    from fegear.geometry.rack_relief import RackRelief


@dataclass(frozen=True)
class RackFlanks:
    """Profile modifications of all teeth of a pinion and of a rack.

    Parameters
    ----------
    pinion : Relief
        Over the roll angle.
    rack : RackRelief or None
        Over the height.
    """

    pinion: Relief = UNMODIFIED
    rack: RackRelief | None = None

    def separation(self, contacts: Contacts) -> Array:
        """Distance of the flanks of each pair without load, shape (n, P) [m]; infinite out of reach."""
        total = contacts.gap
        if self.pinion != UNMODIFIED:
            total = total + self.pinion.removal(contacts.roll_driver)
        if self.rack is not None:
            total = total + self.rack.removal(contacts.radius_driven)
        return np.where(contacts.present, total, np.inf)

    def breaks(self, pair: RackAndPinion) -> Array:
        """Places on the path of contact where a relief that removes something has a kink [m]."""
        radius, kinks = pair.pinion.base_radius, np.array(self.pinion.kinks)
        found = radius * kinks - float(pair.roll_length(0.0))
        if not self.pinion.removal(np.linspace(0.0, float(pair.roll_length(pair.x_end)) / radius, 101)).any():
            found = np.empty(0)
        if self.rack is not None and self.rack.amount:
            found = np.append(found, pair.x_of_height(self.rack.start))
        return np.asarray(found[(found >= pair.x_start) & (found <= pair.x_end)])
