"""Curves whose class is known, in the habits of scikit-image: estimate, residuals, predict_xy.

    from skimage.measure import ransac
    Ellipse = palpate.models.model("ellipse")
    ellipse, inliers = ransac(points, Ellipse, Ellipse.min_samples, residual_threshold=0.1)

The least squares of the orthogonal distances of that class to all points, in any order and in any unit of length: what
comes back is in the same unit.
"""
from __future__ import annotations

from typing import ClassVar

import numpy as np

from . import _core
from .details import details


class CurveModel:
    """params: the shape's parameters, then x, y and theta of the pose; None before estimate() has succeeded."""
    curve_class: ClassVar[str]
    min_samples: ClassVar[int]

    def __init__(self) -> None:
        self.params: np.ndarray | None = None
        self.status = ""
        """Why estimate() has not succeeded, where it has not."""
        self.covariance = np.empty((0, 0))
        self.rms = self.peak_to_valley = self.sigma = float("nan")

    def estimate(self, data, sigma: float = 0.0, normals=None, normal_sigma=None, covariances=None) -> bool:
        """Whether the points (n, 2) determine one curve of the class. sigma: of a point, where it is known. The others as
        Recognizer.add has them; normals count where every point's noise is known."""
        fit = _core.fit_given(self.curve_class, np.asarray(data, dtype=np.float64), sigma,
                              *details(normals, normal_sigma, covariances, 1.0))
        self.status = fit["status"]
        letters = len(_core.parameter_letters(self.curve_class))
        success = self.status == "fitted"
        self.params = np.array([*fit["params"][:letters], *fit["pose"]]) if success else None
        self.covariance = fit["covariance"] if success else np.empty((0, 0))
        self.rms, self.peak_to_valley, self.sigma = fit["rms"], fit["peak_to_valley"], fit["sigma"]
        return success

    def residuals(self, data) -> np.ndarray:
        """Signed distances of points, positive to the left of increasing t."""
        return self._curve(self.params).feet(np.asarray(data, dtype=np.float64))[1]

    def predict_xy(self, t, params=None) -> np.ndarray:
        """Points of the curve at its parameters t."""
        return self._curve(self.params if params is None else params).at(np.atleast_1d(np.asarray(t, dtype=np.float64)))

    def _curve(self, params) -> _core.PlacedCurve:
        if params is None:
            raise ValueError(f"estimate() has found no {self.curve_class}" + (f": {self.status}" if self.status else ""))
        shape = np.zeros(3)
        shape[:len(params) - 3] = params[:-3]
        return _core.PlacedCurve(self.curve_class, shape, *params[-3:])


def model(curve_class: str) -> type[CurveModel]:
    """The model of a class: "line", "circle", "ellipse", "parabola", "hyperbola", "cubical_parabola", ..."""
    members = {"curve_class": curve_class, "min_samples": _core.degrees_of_freedom(curve_class)}
    return type(curve_class.title().replace("_", "") + "Model", (CurveModel,), members)
