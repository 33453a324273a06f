"""Names of the arrays that annotations speak of, written once; imported for type checking only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

#: Real numbers.
Array = NDArray[np.float64]
#: Real numbers of single or double precision, for searches that are quicker in single.
Floats = NDArray[np.floating]
#: Numbers of nodes, unknowns, teeth, rows.
Index = NDArray[np.int64]
#: Amplitudes and spectra, with exp(+i w t).
Complex = NDArray[np.complex128]
#: What holds and what does not.
Mask = NDArray[np.bool_]
