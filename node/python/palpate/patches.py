"""One patch, or a list of them."""
from __future__ import annotations

from typing import Sequence

import numpy as np

from .details import numbers


def patches_of(points, touches: bool = False) -> Sequence:
    """Returns the patches: an array (n, 2) is one, a list holds one array each. `touches`: every point is one."""
    if not hasattr(points, "__len__") or isinstance(points, (str, bytes, dict)):
        raise ValueError(f"points: an array of shape (n, 2) or a list of them, not {type(points).__name__}")
    patches: Sequence = [points] if is_one_array(points) else points
    if touches:
        return [row[np.newaxis, :] for patch in patches for row in numbers(patch)]
    return patches


def is_one_array(points) -> bool:
    """True for an array (n, 2), also as a list of pairs; False for a list of such arrays."""
    return getattr(points, "ndim", 0) == 2 or (len(points) > 0 and np.ndim(points[0]) == 1)
