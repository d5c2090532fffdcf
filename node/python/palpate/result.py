"""The answer of a recognition, in the unit of the points."""
from __future__ import annotations

from functools import cached_property
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _core
from .details import numbers

_UNITS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "nm": 1e-9, "in": 0.0254}
# Exponents of length in the units of a, b and c (default 1); core/README.md, "Curves".
_POWERS = {"cubical_parabola": {"a": -2.0, "c": 0.0},
           "semi_cubical_parabola": {"a": -0.5, "b": 0.0},
           "cubic_spline": {"a": -0.5, "b": 0.0, "c": 0.5}}
_KEPT = ("has_shape", "params", "pose", "covariance", "noise_covariance", "hypotheses", "contacts", "noise_correlation_m")


def units(name: str) -> float:
    """Metres per unit. Raises ValueError for an unknown unit."""
    if name not in _UNITS:
        raise ValueError(f"unit: {name!r} is none of {', '.join(_UNITS)}")
    return _UNITS[name]


class Result:
    """The answer for one object. Lengths are in `unit`, angles in radians.

    status: "collecting", "ambiguous" or "recognized". doubt: why it is ambiguous, else "none".
    curve_class: the most probable class, e.g. "ellipse".
    params: shape parameters, {"a": ...}. pose: (x, y, theta). covariance: of [params; x; y; theta]. If there is no
    curve (unclassified, collecting, or a best fit at the limit of the class), params and covariance are empty and the
    pose is NaN.
    probabilities: {class: posterior probability}, the most probable first; empty while collecting.
    contacts: local geometry of the touched places, in metres.
    sigma: standard deviation of a point, stated or estimated.
    sample_count: points that the answer is based on. outlier_count: points set aside as spikes. forgotten_count: points
    forgotten to make room. dwelling_count: points merged because the probe stood still. simplified_count: points whose
    normal or covariance is used only in part.
    unqualified_probe: covariance and probabilities contain what a probe that nobody has measured may hide (see fit()).
    noise_covariance: as covariance, if the probe erred by noise alone.
    compute_s: computing time in seconds since the answer before, without the conversion from and to Python."""

    def __init__(self, core: _core.Answer, unit: str, touched: np.ndarray) -> None:
        self._core, self.unit, self._touched = core, unit, touched
        self._scale = scale = units(unit)
        self.status = core.status
        self.doubt = core.doubt
        self.curve_class = core.curve_class
        # A best fit at the limit of its class has no shape of that class.
        letters = _core.parameter_letters(self.curve_class) if core.has_shape else ""
        powers = _POWERS.get(self.curve_class, {})
        self._factors = [scale ** -powers.get(letter, 1.0) for letter in letters]
        self.params: dict[str, float] = {
            letter: factor * value for letter, factor, value in zip(letters, self._factors, core.params.tolist())}
        x, y, theta = core.pose if core.has_shape else (float("nan"),) * 3
        self.pose = (x / scale, y / scale, theta)
        self.sigma = core.sigma_m / scale
        self.compute_s = core.compute_s
        self.sample_count = core.sample_count
        self.outlier_count = core.outlier_count
        self.dwelling_count = core.dwelling_count
        self.forgotten_count = core.forgotten_count
        self.simplified_count = core.simplified_count
        self.unqualified_probe = core.unqualified_probe

    def __getstate__(self) -> dict[str, Any]:
        """For pickle and copy.deepcopy: values in place of what only this process has."""
        state = {name: value for name, value in vars(self).items() if name != "_curve"}
        return state | {"_core": SimpleNamespace(**{name: getattr(self._core, name) for name in _KEPT})}

    def _in_unit(self, covariance: np.ndarray) -> np.ndarray:
        factors = np.array(self._factors + [1 / self._scale, 1 / self._scale, 1.0])
        return covariance * np.outer(factors, factors) if covariance.shape[0] == len(factors) else np.empty((0, 0))

    @cached_property
    def covariance(self) -> np.ndarray:
        return self._in_unit(self._core.covariance)

    @cached_property
    def noise_covariance(self) -> np.ndarray:
        return self._in_unit(self._core.noise_covariance)

    @cached_property
    def probabilities(self) -> dict[str, float]:
        told = {h["curve_class"]: h["probability"] for h in self._core.hypotheses}
        return told | {name: 0.0 for name in _core.curve_classes() if told and name not in told}

    @cached_property
    def contacts(self) -> list[dict[str, Any]]:
        return self._core.contacts

    @cached_property
    def _curve(self) -> _core.PlacedCurve | None:
        if not self._core.has_shape:
            return None
        return _core.PlacedCurve(self.curve_class, self._core.params, *self._core.pose)

    def _need_curve(self):
        if self._curve is None:
            raise ValueError(f"no curve was found: {self.curve_class}, {self.status} ({self.doubt})")
        return self._curve

    @property
    def std(self) -> dict[str, float]:
        """Standard deviations of the shape parameters and of x, y, theta, by name."""
        names = [*self.params, "x", "y", "theta"]
        return dict(zip(names, np.sqrt(np.diag(self.covariance)))) if self.covariance.size else {}

    def residuals(self, xy) -> np.ndarray:
        """Signed distances of points (n, 2) from the curve, positive to the left of increasing t. Raises ValueError if no
        curve was found, as do the methods below."""
        _, distance = self._need_curve().feet(self._scale * numbers(xy))
        return distance / self._scale

    def nearest(self, xy) -> np.ndarray:
        """Curve parameters t of the nearest points of the curve to the points (n, 2)."""
        return self._need_curve().feet(self._scale * numbers(xy))[0]

    def predict_xy(self, t) -> np.ndarray:
        """Points (n, 2) of the curve at the curve parameters t."""
        return self._need_curve().at(np.atleast_1d(numbers(t, "t"))) / self._scale

    def sample(self, n: int = 200) -> np.ndarray:
        """n points along the curve, (n, 2): all of a closed curve, else the touched arc."""
        curve = self._need_curve()
        if curve.period > 0:
            return self.predict_xy(np.linspace(-curve.period / 2, curve.period / 2, n))
        t = self.nearest(self._touched)
        return self.predict_xy(np.linspace(t.min(), t.max(), n))

    def plot(self, ax=None):
        """Draws points and curve with matplotlib and returns the axes."""
        if ax is None:
            import matplotlib.pyplot as plt
            _, ax = plt.subplots()
        if self._curve is not None:
            ax.plot(*self.sample().T, linewidth=4, alpha=0.4, label=f"{self.curve_class} ({self.status})")
        ax.plot(*self._touched.T, "k.", markersize=2, label="points")
        ax.set_aspect("equal")
        ax.set_xlabel(f"x [{self.unit}]")
        ax.set_ylabel(f"y [{self.unit}]")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        text = f"{self.curve_class} ({self.status}" + (f": {self.doubt})" if self.doubt != "none" else ")")
        std = self.std
        for letter, value in self.params.items():
            text += f", {letter} = {value:.6g}" + (f" +- {std[letter]:.2g}" if letter in std else "")
        if self._curve is not None:
            text += ", pose ({:.6g}, {:.6g}, {:.6g} rad)".format(*self.pose)
        return f"<palpate.Result {text}, unit {self.unit}>"
