"""Arguments as numbers, and the optional data of points: measured normals and covariances."""
from __future__ import annotations

import math

import numpy as np

_NONE = np.empty(0)


def numbers(values, what: str = "points") -> np.ndarray:
    """Returns them as float64, without a copy if they are. Raises ValueError for masked and complex values: numpy would
    convert them without their mask and without their imaginary part; and for what are no numbers."""
    if np.ma.is_masked(values):
        raise ValueError(f"{what}: some are masked; leave them out")
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise ValueError(f"{what}: complex numbers")
    try:
        return array.astype(np.float64, copy=False)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{what}: {error}") from None


def length(what: str, value, zero_too: bool = True) -> float:
    """Returns it as float. Raises ValueError that names it unless it is one finite number, above 0 or, with `zero_too`, 0."""
    if isinstance(value, (int, float)):
        number = float(value)
    else:
        number = math.nan if isinstance(value, (str, bytes)) or np.ndim(value) > 0 else float(numbers(value, what))
    if not (math.isfinite(number) and (number > 0 or zero_too and number == 0)):
        raise ValueError(f"{what}: {value!r}: must be " + ("finite and not below 0" if zero_too else
                                                             "finite and above 0; None if it is not known"))
    return number


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
