"""Imported before all else in the process from which workers are forked: what makes its imports quick.

Collecting garbage meanwhile finds none and takes a sixth of the time; workers collect once they are forked. To know
whether ``np.cov`` may call BLAS, Numba imports SciPy's linear algebra, an eighth of the time; no kernel calls it, and
what does finds SciPy later.
"""

from __future__ import annotations

import gc
import sys
from typing import Any

gc.disable()

_modules: dict[str, Any] = sys.modules
if "scipy.linalg" not in _modules:
    _modules["scipy.linalg"] = None
    try:
        import numba.np.arraymath  # noqa: F401
    finally:
        del _modules["scipy.linalg"]
