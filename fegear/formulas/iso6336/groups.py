"""ISO 6336-5: the groups of materials, by the standard's own letters; parts 1, 2 and 3 choose their factors by them."""

from __future__ import annotations

from typing import Literal

#: St: normalized low carbon steels, wrought or cast. GTS: black malleable cast iron. GGG: nodular cast iron. GG: grey
#: cast iron. V: through-hardened wrought or cast steels. Eh: case-hardened. IF: flame or induction hardened.
#: NT (nitr.): nitriding steels, nitrided. NV (nitr.), NV (nitrocar.): through-hardening or case-hardening steels,
#: nitrided or nitrocarburized (ISO 6336-5:2016, table 1).
Group = Literal[
    "St", "St (cast)", "GTS (perl.)", "GGG (perl.)", "GGG (bai.)", "GGG (ferr.)", "GG", "V", "V (cast)", "Eh", "IF",
    "NT (nitr.)", "NV (nitr.)", "NV (nitrocar.)",
]  # fmt: skip

NORMALIZED: frozenset[Group] = frozenset({"St", "St (cast)"})
THROUGH_HARDENED: frozenset[Group] = frozenset({"V", "V (cast)"})
TOUGH_IRON: frozenset[Group] = frozenset({"GTS (perl.)", "GGG (perl.)", "GGG (bai.)"})
SOFT_IRON: frozenset[Group] = frozenset({"GG", "GGG (ferr.)"})
CASE_HARDENED: frozenset[Group] = frozenset({"Eh", "IF"})
NITRIDED: frozenset[Group] = frozenset({"NT (nitr.)", "NV (nitr.)", "NV (nitrocar.)"})
#: Steels whose flanks are harder than their core.
SURFACE_HARDENED = CASE_HARDENED | NITRIDED
GROUPS: frozenset[Group] = NORMALIZED | THROUGH_HARDENED | TOUGH_IRON | SOFT_IRON | SURFACE_HARDENED
