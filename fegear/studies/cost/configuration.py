"""One way to compute: a formula, a sector with free sides, the whole ring with some settings, or a tolerance."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Literal

from fegear.fem.settings import MeshSettings

Family = Literal[
    "compliance-formula", "stress-formula", "sector", "ring", "tolerance", "table",
    "thin-slices", "thin-slices-alone", "coupled-slices", "coupled-slices-alone", "solid", "solid-alone",
]  # fmt: skip

#: The mean stiffness of the standard as a compliance of each tooth.
ISO_STIFFNESS = "iso6336-stiffness"


@dataclass(frozen=True, slots=True)
class Configuration:
    """One configuration of a cost study.

    Parameters
    ----------
    family : str
        ``compliance-formula``, ``stress-formula``, ``sector`` (teeth with free sides), ``ring`` (the whole gear),
        ``tolerance`` (what a run picks for ``accuracy.tolerance``), ``table`` (the case's own compliances); of a pair
        that is loaded over its face ``thin-slices``, ``coupled-slices`` and ``solid``, with ``-alone`` without
        neighbouring teeth.
    settings : MeshSettings or None
        Of finite elements with given settings.
    factor : float
        Edge lengths over the usual ones.
    teeth : int
        Teeth of a sector.
    formula : str
        Name of a closed form.
    tolerance : float
    """

    family: Family
    settings: MeshSettings | None = None
    factor: float = math.nan
    teeth: int = 0
    formula: str = ""
    tolerance: float = math.nan

    @property
    def label(self) -> str:
        """Short name, unlike that of any other configuration of a study."""
        if self.family == "tolerance":
            return f"tolerance = {self.tolerance:.0e}"
        if self.family == "table":
            return "the case's table"
        if self.settings is None:
            return f"{self.formula}, {'root stress' if self.family == 'stress-formula' else 'compliance'}"
        s = self.settings
        who = f"sector of {self.teeth} teeth" if self.family == "sector" else "whole gear"
        return f"{who}, order {s.order}, edges x {self.factor:.3g}, patch {s.patch_half_width:.4g}"

    def paste(self, pair: str) -> str:
        """The configuration as lines of a case file; empty for what no case can ask for.

        Parameters
        ----------
        pair : str
            Name of the pair whose compliance source it may be; empty for none.
        """
        if self.family == "tolerance":
            return f"accuracy = {{ tolerance = {self.tolerance:g} }}"
        if self.family == "ring" and self.settings is not None:
            usual = asdict(MeshSettings())
            own = {k: v for k, v in asdict(self.settings).items() if v != usual[k]} or {"order": self.settings.order}
            return "accuracy = { " + ", ".join(f"{k} = {v:.6g}" for k, v in own.items()) + " }"
        if self.family == "compliance-formula" and pair and self.formula != ISO_STIFFNESS:
            return f'pair.{pair}.compliance = {{ source = "{self.formula}" }}'
        return ""
