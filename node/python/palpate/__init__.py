"""Recognises and locates curved parts by touch.

    import palpate
    result = palpate.fit([patch_a, patch_b], sigma=0.02, unit="mm")
    print(result)                     # ellipse (recognized), a = 25.0012 +- 0.0021 mm, ...
    result.params["a"], result.pose, result.covariance, result.residuals(points)

Points are arrays of shape (n, 2), in the unit that `unit` names. Results are in the same unit, angles in radians. A
patch is one unbroken touch; its points are in their order along the part.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Iterable, Sequence

import numpy as np

from . import _core, models
from .details import details
from .result import Result, units

if TYPE_CHECKING:
    from .bus import Planner, Probe

__version__ = "@PROJECT_VERSION@"
__all__ = ["Planner", "Probe", "Recognizer", "Result", "fit", "models"]

_NONE = np.empty(0)
_MOST_DRAWN = 1 << 16  # points kept for Result.plot and sample; beyond it every second one is dropped


class Recognizer:
    """Recognises one object while it is touched: add points as they come, and call recognize() at any time.

    sigma: standard deviation of points that are added without one; None = estimated from the data.
    unit: "m", "mm", "cm", "um", "nm" or "in"; of all lengths that go in and come out.
    classes: names of the classes to consider, e.g. "ellipse"; empty = all.
    form_deviation: standard deviation of the part's surface from its ideal curve; 0 = exactly of its class.
    most_patches: patches kept (not counting patches of one point); beyond it the oldest is forgotten.
    most_samples_per_patch: points kept of a patch; beyond it neighbours are merged.
    unqualified_probe: see fit().
    """

    def __init__(self, sigma: float | None = None, unit: str = "m", classes: Iterable[str] = (),
                 form_deviation: float = 0.0, most_patches: int = 64, most_samples_per_patch: int = 1024,
                 unqualified_probe: bool = False) -> None:
        self._unit = unit
        self._scale = units(unit)
        self._core = _core.Recognizer(self._scale * (sigma or 0.0), list(classes), self._scale * form_deviation,
                                      unqualified_probe, most_patches, most_samples_per_patch)
        self._points: list[np.ndarray] = []
        self._drawn = 0
        self._tip_radius = 0.0
        self.dropped = 0
        """Number of points not used because they repeat the place of the point before exactly."""

    def add(self, points, patch: int = 0, probe: int = 0, sigma=None, tip_radius: float = 0.0,
            material_side: str = "unspecified", normals=None, normal_sigma=None, covariances=None) -> int:
        """Appends points (n, 2) of one patch, in their order along the part. Returns how many were accepted. Raises
        ValueError if a point is not finite or another argument is invalid; then no point is added.

        patch, probe: numbers of the patch and of the probe. A new patch number begins a new patch.
        sigma: standard deviation of a point, one number or one per point; None = that of the constructor.
        tip_radius: radius of a round tip whose centres the points are; 0 = points of the surface.
        material_side: "left", "right" or "unspecified", seen along the direction of travel.
        normals: (n, 2), unit normals of the surface, out of the material; (0, 0) where none was measured.
        normal_sigma: standard deviation of their directions in radians, one number or one per normal.
        covariances: of the positions, in place of sigma; (2, 2) or (n, 2, 2), in the square of the unit.
        A search over the classes uses normals and covariances only in part; Result.simplified_count says for how many
        points."""
        points = np.asarray(points, dtype=np.float64)
        in_metres = points if self._scale == 1.0 else self._scale * points
        sigmas = _NONE if sigma is None else self._scale * np.atleast_1d(np.asarray(sigma, dtype=np.float64))
        accepted, repeated = self._core.add(in_metres, sigmas, probe, patch, self._scale * tip_radius, material_side,
                                            *details(normals, normal_sigma, covariances, self._scale))
        self.dropped += repeated
        self._tip_radius = max(self._tip_radius, tip_radius)
        self._points.append(points.copy())
        self._drawn += len(points)
        if self._drawn > _MOST_DRAWN:
            self._points = [np.concatenate(self._points)[::2]]
            self._drawn = len(self._points[0])
        return accepted

    def recognize(self) -> Result:
        """Returns the answer for all points so far."""
        touched = np.concatenate(self._points) if self._points else np.empty((0, 2))
        return Result(self._core.recognize(), self._unit, touched, self._tip_radius)

    def reset(self) -> None:
        """Forgets all points: a new object begins."""
        self._core.reset()
        self._points.clear()
        self._drawn = 0
        self.dropped = 0


def fit(points, sigma=None, unit: str = "m", tip_radius: float = 0.0, material_side: str = "unspecified",
        classes: Iterable[str] = (), form_deviation: float = 0.0, touches: bool = False,
        most_samples_per_patch: int = 1024, normals=None, normal_sigma: float | None = None,
        unqualified_probe: bool = False) -> Result:
    """Recognises one object and returns the Result. Raises ValueError if an argument is invalid.

    points: an array (n, 2) of one patch, or a list of such arrays.
    sigma: standard deviation of a point, one number or (for one patch) one per point; None = estimated.
    unit, classes, most_samples_per_patch: see Recognizer.
    tip_radius: radius of a round tip whose centres the points are; 0 = points of the surface.
    material_side: "left", "right" or "unspecified", seen along the direction of travel.
    touches: every point is a touch of its own; their order does not matter.
    form_deviation: standard deviation of the part's surface from its ideal curve, e.g. half of a +- tolerance.
    unqualified_probe: set it if nobody has measured the probe's lobes, tip radius and drift. Uncertainties and class
    probabilities then include such deviations, in any size that the residuals permit.
    normals: measured normals of the surface, in arrays like the points; see Recognizer.add.
    normal_sigma: standard deviation of their directions in radians.
    """
    patches = _patches(points, touches)
    of_patches: Sequence = [None] * len(patches) if normals is None else _patches(normals, touches)
    if touches and np.size(sigma) > 1:
        raise ValueError("sigma: one number for touches")
    if len(patches) == 0:
        raise ValueError("points: there are none")
    if len(of_patches) != len(patches):
        raise ValueError("normals: not as many as points")
    # The whole list is known, so no patch needs to be forgotten.
    recognizer = Recognizer(None, unit, classes, form_deviation, max(64, len(patches)), most_samples_per_patch,
                            unqualified_probe)
    for number, patch in enumerate(patches):
        recognizer.add(patch, number, 0, sigma, tip_radius, material_side, of_patches[number], normal_sigma)
    return recognizer.recognize()


def _patches(points, touches: bool) -> Sequence:
    patches: Sequence = [points] if getattr(points, "ndim", 0) == 2 or _is_one_patch(points) else points
    if touches:
        return [row[np.newaxis, :] for patch in patches for row in np.asarray(patch, dtype=np.float64)]
    return patches


def _is_one_patch(points) -> bool:
    first = points[0] if len(points) else ()
    return np.ndim(first) == 1


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


def __getattr__(name: str):
    """Imports Probe and Planner on first use: they need pyzmq and protobuf, recognition does not."""
    if name in ("Probe", "Planner"):
        from . import bus
        return getattr(bus, name)
    raise AttributeError(f"module 'palpate' has no attribute {name!r}")
