"""Tooth contact analysis of helical pairs, aligned and misaligned."""

from fegear.geometry.helical_gear import HelicalGear
from fegear.helical.contact import PairContact, ToothContact, pair_contact, tooth_contact
from fegear.helical.pair import HelicalPair, Misalignment

__all__ = [
    "HelicalGear", "HelicalPair", "Misalignment", "PairContact", "ToothContact", "pair_contact", "tooth_contact",
]  # fmt: skip
