"""Output of a Wheatstone bridge as strain: 4 U/U_0 over gauge factor and number of active arms.

A half bridge of two gauges in adjacent arms gives the difference of their strains: 4 U/U_0 over gauge factor and half
of the number of active arms. The relation is linear. Of a quarter bridge the strain is larger by half of gauge factor
times strain: 0.1 % at 1000 um/m.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.printed import figures

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.gauge import MeasuredStrainPart

#: Dimensions that the column of the strain may have, the strain itself first.
COLUMN_OF_STRAIN = ("strain", "bridge_output", "voltage")
#: Keys that describe a bridge.
_OF_BRIDGE = ("gauge_factor", "active_arms", "excitation", "amplification")
_NAMES = {1.0: "quarter bridge", 2.0: "half bridge", 4.0: "full bridge"}


def strain_of_bridge(
    column: Array, part: MeasuredStrainPart, dimension: str, unit: str, key: str
) -> tuple[Array, str]:  # fmt: skip
    """Strain of a column that may be the output of a bridge, and how that was read; empty of a strain.

    Parameters
    ----------
    column : ndarray, shape (N,)
        Strain, output over excitation voltage, or voltage [V].
    part : MeasuredStrainPart
    dimension : str
        One of `COLUMN_OF_STRAIN`.
    unit : str
        As it is written.
    key : str
        Of the table, for messages.

    Raises
    ------
    InputError
        If keys of the bridge are missing, or there are some and no bridge.
    """
    of_two = part.bridge is not None
    if dimension == "strain":
        for name in _OF_BRIDGE:
            if name in part.given and not (of_two and name == "active_arms"):
                raise InputError(
                    f"{key}.{name}", figures(getattr(part, name)), f"has no effect: column {part.strain_column} is a "
                    f"strain ({unit})", 'remove it, or set strain = "mV/V" if it is the output of the bridge',
                )  # fmt: skip
        if of_two and part.active_arms != 1.0:
            return part.active_arms * column, f"strain times its {figures(part.active_arms)} active arms"
        return column, ""
    if part.gauge_factor is None:
        raise InputError(
            f"{key}.gauge_factor", "(not given)", f"is required: column {part.strain_column} is the output of the "
            f"bridge ({unit})", "set gauge_factor = 2.05 (from the package of the gauge) and active_arms = 1 (quarter "
            "bridge), 2 (half bridge) or 4 (full bridge)",
        )  # fmt: skip
    over = 1.0
    if dimension == "voltage":
        if part.excitation is None:
            raise InputError(
                f"{key}.excitation", "(not given)", f"is required: column {part.strain_column} is a voltage ({unit})",
                'set excitation = "5 V", and amplification if the voltage is amplified',
            )  # fmt: skip
        over = part.excitation
    elif part.excitation is not None:
        raise InputError(
            f"{key}.excitation", f"{figures(part.excitation)} V", f"has no effect: column {part.strain_column} is a "
            f"voltage over that of the excitation ({unit})", "remove it",
        )  # fmt: skip
    count = 2.0 if of_two and "active_arms" not in part.given else part.active_arms
    if of_two and count < 2.0:
        raise InputError(
            f"{key}.active_arms", figures(count), "is fewer than the gauges of the bridge", "set 2, or 4 (full bridge)"
        )
    arms = f"{figures(count)} active arm{'' if count == 1.0 else 's'}"
    named = f" ({_NAMES[count]})" if count in _NAMES else ""
    scale = 4.0 / (part.gauge_factor * (0.5 * count if of_two else count) * part.amplification * over)
    return scale * column, f"strain from {unit} with gauge factor {figures(part.gauge_factor)} and {arms}{named}"
