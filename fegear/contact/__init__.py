"""Loaded teeth: compliance sources, load sharing, transmission error, spacing errors, root-stress histories."""

from fegear.contact.closed_form_compliance import closed_form_compliance
from fegear.contact.compliance import GearCompliance
from fegear.contact.engagement import Engagement, Loaded
from fegear.contact.fe_compliance import finite_element_compliance
from fegear.contact.fourier import FourierSeries, effective_error
from fegear.contact.load_sharing import SharedLoad, share_load
from fegear.contact.pair_compliance import PairCompliance
from fegear.contact.pair_history import PairHistory, pair_history
from fegear.contact.roll_grids import RollGrid
from fegear.contact.root_stress_history import RootStressHistory, root_stress_history
from fegear.contact.table_compliance import table_sources
from fegear.contact.transmission_error import (
    TransmissionError,
    pair_stiffness,
    revolution,
    transmission_error,
)

__all__ = [
    "Engagement",
    "FourierSeries",
    "GearCompliance",
    "Loaded",
    "PairCompliance",
    "PairHistory",
    "RollGrid",
    "RootStressHistory",
    "SharedLoad",
    "TransmissionError",
    "closed_form_compliance",
    "effective_error",
    "finite_element_compliance",
    "pair_history",
    "pair_stiffness",
    "revolution",
    "root_stress_history",
    "share_load",
    "table_sources",
    "transmission_error",
]
