"""Tooth contact analysis of helical pairs, aligned and misaligned."""

from fegear.helical.as_cut import as_cut
from fegear.helical.contact import MeshCycle, ToothContact, mesh_cycle, tooth_contact
from fegear.helical.pair import HelicalPair, Misalignment
from fegear.helical.pair_contact import PairContact, pair_contact

__all__ = [
    "HelicalPair", "MeshCycle", "Misalignment", "PairContact", "ToothContact", "as_cut", "mesh_cycle", "pair_contact",
    "tooth_contact",
]  # fmt: skip
