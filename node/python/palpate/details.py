"""Optional data of points: measured normals and covariances."""
from __future__ import annotations

import numpy as np

_NONE = np.empty(0)


def details(normals, normal_sigma, covariances, scale: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Converts them to the arrays that the core takes: (normals, normal_sigma, covariances in m^2), empty if None.
    `scale`: metres per unit. float64 arrays are not copied (covariances only if `scale` is not 1). Raises ValueError if
    only one of normals and normal_sigma is given."""
    if normals is None and normal_sigma is None and covariances is None:
        return _NONE, _NONE, _NONE
    if (normals is None) != (normal_sigma is None):
        raise ValueError("normals and normal_sigma belong together")
    squares = _NONE if covariances is None else np.asarray(covariances, dtype=np.float64)
    return (_NONE if normals is None else np.asarray(normals, dtype=np.float64),
            _NONE if normal_sigma is None else np.atleast_1d(np.asarray(normal_sigma, dtype=np.float64)),
            squares if scale == 1.0 else scale * scale * squares)
