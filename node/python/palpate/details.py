"""Optional data of points: measured normals and covariances."""
from __future__ import annotations

import numpy as np

_NONE = np.empty(0)


def numbers(values, what: str = "points") -> np.ndarray:
    """Returns them as float64, without a copy if they are. Raises ValueError for masked and complex values: numpy would
    convert them without their mask and without their imaginary part."""
    if np.ma.is_masked(values):
        raise ValueError(f"{what}: some are masked; leave them out")
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise ValueError(f"{what}: complex numbers")
    return array.astype(np.float64, copy=False)


def details(normals, normal_sigma, covariances, scale: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Converts them to the arrays that the core takes: (normals, normal_sigma, covariances in m^2), empty if None.
    `scale`: metres per unit. float64 arrays are not copied (covariances only if `scale` is not 1). Raises ValueError if
    only one of normals and normal_sigma is given."""
    if normals is None and normal_sigma is None and covariances is None:
        return _NONE, _NONE, _NONE
    if (normals is None) != (normal_sigma is None):
        raise ValueError("normals and normal_sigma belong together")
    squares = _NONE if covariances is None else numbers(covariances, "covariances")
    return (_NONE if normals is None else numbers(normals, "normals"),
            _NONE if normal_sigma is None else np.atleast_1d(numbers(normal_sigma, "normal_sigma")),
            squares if scale == 1.0 else scale * scale * squares)
