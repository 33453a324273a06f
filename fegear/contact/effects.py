"""Effects that change loaded pairs: names of fields of `fegear.contact.pair_spec.PairSpec` and of keys of a case."""

from __future__ import annotations

#: How teeth give way and touch: effects of teeth without modifications and errors.
AT_REST = ("corner_contact", "neighbour_coupling", "hertz")
#: Modifications and errors of flanks, by which these leave gaps.
GAPS = ("relief", "spacing_errors", "misalignment")
#: All that change a pair with its width, and of these what plane teeth have.
WIDE_EFFECTS = (*AT_REST, *GAPS)
PLANE_EFFECTS = (*AT_REST, "relief", "spacing_errors")
