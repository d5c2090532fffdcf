"""Fits of a known class, with the interface of scikit-image's models: estimate, residuals, predict_xy.

    from skimage.measure import ransac
    Ellipse = palpate.models.model("ellipse")
    ellipse, inliers = ransac(points, Ellipse, Ellipse.min_samples, residual_threshold=0.1)

estimate() minimises the sum of squared orthogonal distances of all points. An array of points is single touches, in any
order: ransac draws its samples so. Points of strokes are passed as a list of patches, as to palpate.fit(), and
lie along the curve in their order. Points may be in any unit of length; results are in the same unit.
"""
from __future__ import annotations

from typing import ClassVar

import numpy as np

from . import _core
from .details import details, numbers
from .patches import is_one_array, patches_of


class CurveModel:
    """A curve of one class. model() makes its subclasses.

    params: the shape parameters, then x, y and theta (radians) of the pose; None until estimate() has succeeded. Where
    estimate() raises, all are as before any fit.
    covariance: of params; empty until then. Noise that neighbours along a stroke share is counted in it, as by palpate fit --class.
    rms: root mean square distance of the points. peak_to_valley: largest less smallest signed distance.
    sigma: standard deviation of a point, stated or estimated.
    noise_correlation: length of arc along which neighbours in strokes err together; 0 = they do not (white noise), as of touches.
    The last four are NaN if there is no curve.
    rival: params of another curve of the class, beyond the covariance, that may be the true one as well (through four points go two
    parabolas); None if the points exclude every other one.
    bounded: False if the shape runs to the end of its class, or out of sight, within three standard deviations: whatever
    covariance says, the points do not bound it.
    min_samples: fewest points that determine a curve of the class."""
    curve_class: ClassVar[str]
    min_samples: ClassVar[int]

    def __init__(self) -> None:
        self._forget()

    def _forget(self) -> None:
        """Sets what a fit has found to what it is before any fit."""
        self.params: np.ndarray | None = None
        self.status = ""
        """Outcome of estimate(): "fitted", or why it has not succeeded."""
        self.covariance = np.empty((0, 0))
        self.rms = self.peak_to_valley = self.sigma = self.noise_correlation = float("nan")
        self.rival: np.ndarray | None = None
        self.bounded = True

    def estimate(self, data, sigma=None, normals=None, normal_sigma=None, covariances=None) -> bool:
        """Fits the curve to points. Returns True if there is a fit, which is then in params: as of scikit-image's models, no more.
        Whether the points exclude every other curve of the class is said by `rival` (None = they do), and whether they
        bound its shape by `bounded`. Look at both before you rely on params and covariance.

        data: an array (n, 2) of touches in any order, or a list of such arrays: each is a patch, one unbroken touch with its points in
        their order along the part. palpate fit --class takes the patches of a file so. Order tells much about cubics: where two arms
        lie as near to each other as the noise, a stroke keeps to one of them up to the cusp or bend where they meet. And neighbours
        may err together, by form of the part or drift of the probe: then so many are worth fewer, and the covariance is larger
        (noise_correlation). Of an array nothing of this is known: its points count as if each had a noise of its own. Patches whose
        points show no order are fitted as touches.
        sigma: standard deviation of a point, one number or one per point; None or 0 = estimated. normals, normal_sigma, covariances: see Recognizer.add.
        Of several patches, normals are in arrays like the points, None in place of an array where a patch has none; all else that is
        told per point is one array for the points of all patches, one patch after the other.
        Normals are used only if the noise of every point is known.
        Raises ValueError if an argument is invalid; the fit before is then forgotten too."""
        self._forget()
        points, normals, lengths = _joined(data, normals)
        fit = _core.fit_given(self.curve_class, points, np.atleast_1d(numbers(0.0 if sigma is None else sigma, "sigma")),
                              *details(normals, normal_sigma, covariances, 1.0), lengths)
        self.status = fit["status"]
        letters = len(_core.parameter_letters(self.curve_class))
        success = self.status == "fitted"
        self.params = np.array([*fit["params"][:letters], *fit["pose"]]) if success else None
        self.covariance = fit["covariance"] if success else np.empty((0, 0))
        self.bounded = fit["bounded"]
        self.rival = np.array([*fit["rival"][0][:letters], *fit["rival"][1]]) if success and fit["rival"] else None
        there_is_one = success or self.status == "not determined"
        self.rms, self.peak_to_valley, self.sigma, self.noise_correlation = (
            fit[name] if there_is_one else float("nan") for name in ("rms", "peak_to_valley", "sigma", "noise_correlation"))
        return success

    def residuals(self, data) -> np.ndarray:
        """Signed distances of points (n, 2) from the nearest places of the curve, positive to the left of increasing t. Of a
        stroke near a cusp these are not all on the arm that it was fitted to: their mean square may be below that of `rms`."""
        return self._curve(self.params).feet(numbers(data))[1]

    def predict_xy(self, t, params=None) -> np.ndarray:
        """Points (n, 2) of the curve at the curve parameters t."""
        return self._curve(self.params if params is None else params).at(np.atleast_1d(numbers(t, "t")))

    def _curve(self, params) -> _core.PlacedCurve:
        if params is None:
            raise ValueError(f"estimate() has found no {self.curve_class}" + (f": {self.status}" if self.status else ""))
        letters = len(_core.parameter_letters(self.curve_class))
        if len(params) != letters + 3:
            raise ValueError(f"params: {len(params)} numbers; {self.curve_class} has {letters + 3}")
        shape = np.zeros(3)
        shape[:len(params) - 3] = params[:-3]
        return _core.PlacedCurve(self.curve_class, shape, *params[-3:])


def _joined(data, normals):
    """Returns all points, their normals, and the number of points of each patch; no numbers if they are touches."""
    patches = patches_of(data)
    if is_one_array(data) or len(patches) == 0:
        return numbers(data), normals, []
    arrays = [numbers(patch) for patch in patches]
    lengths = [len(array) for array in arrays]
    if normals is not None:
        if is_one_array(normals) or len(normals) != len(arrays):
            raise ValueError("normals: not in arrays like the points")
        of_patches = [np.zeros_like(array) if some is None else numbers(some, "normals") for array, some in zip(arrays, normals)]
        if any(some.shape != array.shape for array, some in zip(arrays, of_patches)):
            raise ValueError("normals: not in arrays like the points")
        normals = np.concatenate(of_patches)
    for array in arrays:
        if array.ndim != 2 or array.shape[1] != 2:
            raise ValueError("points must be arrays of shape (n, 2)")
    return np.concatenate(arrays), normals, lengths


def model(curve_class: str) -> type[CurveModel]:
    """Returns the model class of a curve class: "line", "circle", "ellipse", "parabola", "hyperbola",
    "cubical_parabola", "semi_cubical_parabola" or "cubic_spline"."""
    found = _MODELS.get(str(curve_class).lower().replace("-", "_").replace(" ", "_"))
    if found is None:
        raise ValueError(f"{curve_class!r} is no curve class: {', '.join(_MODELS)}")
    return found


def _made(curve_class: str) -> type[CurveModel]:
    members = {"curve_class": curve_class, "min_samples": _core.degrees_of_freedom(curve_class), "__module__": __name__}
    return type(curve_class.title().replace("_", "") + "Model", (CurveModel,), members)


_MODELS = {name: _made(name) for name in _core.curve_classes()}
globals().update({made.__name__: made for made in _MODELS.values()})  # where pickle looks for them
