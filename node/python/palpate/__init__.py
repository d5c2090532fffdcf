"""Recognises and locates curved parts by touch.

    import palpate
    result = palpate.fit([patch_a, patch_b], sigma=0.02, unit="mm")
    print(result)                     # ellipse (recognized), a = 25.0012 +- 0.0021 mm, ...
    result.params["a"], result.pose, result.covariance, result.residuals(points)

Points are arrays of shape (n, 2), in the unit that `unit` names. Results are in the same unit, angles in radians. A
patch is one unbroken touch; its points are in their order along the part.
"""
from __future__ import annotations

import operator
import warnings
from typing import TYPE_CHECKING, Iterable, Sequence

import numpy as np

from . import _core, models
from .details import details, length, numbers
from .patches import patches_of
from .result import Result, units

if TYPE_CHECKING:
    from .bus import Planner, Probe

__version__ = "@PROJECT_VERSION@"
__all__ = ["DataWarning", "Planner", "Probe", "Recognizer", "Result", "fit", "models"]

_NONE = np.empty(0)
_MOST_DRAWN = 1 << 16  # points kept for Result.plot and sample; beyond it every second one is dropped
_MOST_NUMBER = (1 << 32) - 1  # of a patch or probe, as on the wire
_LEAST_SAMPLES = 64  # of a patch, as for palpate-node: means of more neighbours lie off a bend


class DataWarning(UserWarning):
    """What is wrong with the points, where an answer from them may be wrong: fit() and Recognizer.recognize() warn of it in the words of
    `palpate fit`. warnings.filterwarnings("error", category=palpate.DataWarning) makes it an exception, "ignore" in its place drops it."""


class Recognizer:
    """Recognises one object while it is touched: add points as they come, and call recognize() at any time. Calls
    from several threads wait for each other.

    sigma: standard deviation of points that are added without one; None = estimated from the data.
    unit: "m", "mm", "cm", "um", "nm" or "in"; of all lengths that go in and come out.
    classes: names of the classes to consider, e.g. ["circle", "ellipse"], or one name; empty = all.
    form_deviation: standard deviation of the part's surface from its ideal curve; 0 = exactly of its class.
    most_patches: patches kept (not counting patches of one point); beyond it the oldest is forgotten.
    most_samples_per_patch: points kept of a patch, at least 64; beyond it neighbours are merged.
    unqualified_probe, touched_from: see fit().
    patience: how many times the work that is usual in a control loop an answer may take. What needs more is ambiguous, with the doubt
    "work_limit". fit(), which is asked once, has 8.
    """

    def __init__(self, sigma: float | None = None, unit: str = "m", classes: str | Iterable[str] = (),
                 form_deviation: float = 0.0, most_patches: int = 64, most_samples_per_patch: int = 1024,
                 unqualified_probe: bool | None = None, touched_from: str = "unknown", patience: float = 1.0) -> None:
        self._unit = unit
        self._scale = units(unit)
        if unqualified_probe is not None and not isinstance(unqualified_probe, (bool, np.bool_)):
            raise ValueError(f"unqualified_probe: {unqualified_probe!r} is none of True, False and None")
        if not isinstance(classes, Iterable):
            raise ValueError(f"classes: {classes!r}: must be names; () for all")
        self._core = _core.Recognizer(self._scale * (0.0 if sigma is None else length("sigma", sigma, zero_too=False)),
                                      [classes] if isinstance(classes, str) else list(classes),
                                      self._scale * length("form_deviation", form_deviation), unqualified_probe,
                                      _whole("most_patches", most_patches, 1),
                                      _whole("most_samples_per_patch", most_samples_per_patch, _LEAST_SAMPLES),
                                      str(touched_from), _patience(patience))
        self._added = 0
        self._checked = 0  # of those added
        self._points: list[np.ndarray] = []
        self._drawn = 0
        self.dropped = 0
        """Number of points not used because they repeat the place of the point before exactly."""

    def add(self, points, patch: int = 0, probe: int = 0, sigma=None, tip_radius: float = 0.0,
            material_side: str = "unspecified", normals=None, normal_sigma=None, covariances=None) -> int:
        """Appends points (n, 2) of one patch, in their order along the part. Returns how many were accepted. Raises
        ValueError if a point is not finite or another argument is invalid; then no point is added.

        patch, probe: numbers of the patch and of the probe. A new patch number begins a new patch.
        sigma: standard deviation of a point, one number or one per point; None, or 0 of one point among others, = that of the
        constructor.
        tip_radius: radius of a round tip whose centres the points are; 0 = points of the surface.
        material_side: "left", "right" or "unspecified", seen along the direction of travel.
        normals: (n, 2), unit normals of the surface, out of the material; (0, 0) where none was measured.
        normal_sigma: standard deviation of their directions in radians, one number or one per normal.
        covariances: of the positions, in place of sigma; (2, 2) or (n, 2, 2), in the square of the unit.
        A search over the classes uses normals and covariances only in part; Result.simplified_count says for how many
        points."""
        points = numbers(points)
        tip_radius = length("tip_radius", tip_radius)
        if sigma is not None and covariances is not None:
            raise ValueError("sigma, covariances: one of them states the noise")
        if sigma is not None and np.ndim(sigma) == 0:
            sigma = length("sigma", sigma, zero_too=False)
        in_metres = points if self._scale == 1.0 else self._scale * points
        sigmas = _NONE if sigma is None else self._scale * np.atleast_1d(numbers(sigma, "sigma"))
        accepted, repeated = self._core.add(in_metres, sigmas, _whole("probe", probe), _whole("patch", patch),
                                            self._scale * tip_radius, str(material_side),
                                            *details(normals, normal_sigma, covariances, self._scale))
        self._added += accepted
        self.dropped += repeated
        self._points.append(points.copy())
        self._drawn += len(points)
        if self._drawn > _MOST_DRAWN:
            self._points = [np.concatenate(self._points)[::2]]
            self._drawn = len(self._points[0])
        return accepted

    def recognize(self) -> Result:
        """Returns the answer for all points so far. Warns as fit() does, once a quarter more points have come than at the last
        time. Of a long stream the newest points are judged, 32,768 at least."""
        return self._recognize(stacklevel=3)

    def _recognize(self, stacklevel: int) -> Result:
        touched = np.concatenate(self._points) if self._points else np.empty((0, 2))
        result = Result(self._core.recognize(), self._unit, touched)
        if self._added >= 1.25 * self._checked:
            self._checked = self._added
            doubts = self._core.warnings()
            if result.status != "recognized" or result.curve_class == "unclassified":
                doubts += filter(None, [self._core.approaches()])
            for doubt in doubts:
                warnings.warn(doubt, DataWarning, stacklevel)
        return result

    def reset(self) -> None:
        """Forgets all points: a new object begins."""
        self._core.reset()
        self._added = self._checked = 0
        self._points.clear()
        self._drawn = 0
        self.dropped = 0


def fit(points, sigma=None, unit: str = "m", tip_radius: float = 0.0, material_side: str = "unspecified",
        classes: str | Iterable[str] = (), form_deviation: float = 0.0, touches: bool = False,
        most_samples_per_patch: int = 1024, normals=None, normal_sigma: float | None = None,
        unqualified_probe: bool | None = None, touched_from: str = "unknown") -> Result:
    """Recognises one object and returns the Result. Raises ValueError if an argument is invalid, TypeError if `touches` is
    neither True nor False. Warns (DataWarning) of points from which the answer may be wrong: several strokes in one patch,
    lost samples, a unit that cannot be, strokes that were saved twice, and, where no class is recognised, ends that may be
    the approach to the part or the retract.

    points: an array (n, 2) of one patch, or a list of such arrays.
    sigma: standard deviation of a point, one number or (for one patch) one per point; None = estimated.
    unit, classes, most_samples_per_patch: see Recognizer.
    tip_radius: radius of a round tip whose centres the points are; 0 = points of the surface.
    material_side: "left", "right" or "unspecified", seen along the direction of travel.
    touches: every point is a touch of its own; their order does not matter.
    form_deviation: standard deviation of the part's surface from its ideal curve, e.g. half of a +- tolerance.
    unqualified_probe: True if nobody has measured the probe's lobes, tip radius and drift. Uncertainties and class
    probabilities then include such deviations, in any size that the residuals permit. False: only if the residuals
    show them. None: True unless the noise of every point or a form deviation is stated.
    touched_from: where round tips touch if neither material_side nor a normal tells it: "outside" (a pin, a boss),
    "inside" (a bore) or "unknown".
    normals: measured normals of the surface, in arrays like the points; see Recognizer.add. None in place of an array
    of a list: that patch has none.
    normal_sigma: standard deviation of their directions in radians, one number or (for one patch) one per normal.
    """
    if not isinstance(touches, (bool, np.bool_)):
        raise TypeError(f"touches: {touches!r} is neither True nor False")
    patches = patches_of(points, touches)
    of_patches: Sequence = [None] * len(patches) if normals is None else patches_of(normals, touches)
    for what, deviation in (("sigma", sigma), ("normal_sigma", normal_sigma)):
        if (touches or len(patches) > 1) and np.size(deviation) > 1:
            raise ValueError(f"{what}: one number for several patches or touches; Recognizer.add takes one per patch or point")
    if len(of_patches) != len(patches):
        raise ValueError("normals: not as many as points")
    # The whole list is known, so no patch needs to be forgotten.
    recognizer = Recognizer(None, unit, classes, form_deviation, max(64, len(patches)), most_samples_per_patch,
                            unqualified_probe, touched_from, _core.patience_with_files())
    accepted = 0
    for number, patch in enumerate(patches):
        its_normals = of_patches[number]
        accepted += recognizer.add(patch, number, 0, sigma, tip_radius, material_side, its_normals,
                                   normal_sigma if normals is None or its_normals is not None else None)
    if accepted == 0:
        raise ValueError("points: there are none")
    _check_sides(tip_radius, material_side, touched_from, touches, normals is not None)
    return recognizer._recognize(stacklevel=3)


def _check_sides(tip_radius: float, material_side: str, touched_from: str, touches: bool, has_normals: bool) -> None:
    """Raises ValueError for a side that would tell nothing. Beside normals the material's side is a check of them."""
    has_side = material_side != "unspecified"
    if touches and has_side:
        raise ValueError("material_side: single touches have no direction of travel; say touched_from, or give normals")
    for what, is_said in (("touched_from", touched_from != "unknown"), ("material_side", has_side and not has_normals)):
        if is_said and tip_radius == 0:
            raise ValueError(f"{what}: tells the side of a round tip, and tip_radius is 0")


def _patience(value: float) -> float:
    patience = length("patience", value)
    if patience < 1:
        raise ValueError(f"patience: {value!r}: must be 1 or more")
    return patience


def _whole(what: str, value: int, least: int = 0) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if not least <= number <= _MOST_NUMBER:
        raise ValueError(f"{what}: {value!r} is no whole number from {least} to {_MOST_NUMBER}")
    return number


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])


def __getattr__(name: str):
    """Imports Probe and Planner on first use: they need pyzmq and protobuf, recognition does not."""
    if name in ("Probe", "Planner"):
        from . import bus
        return getattr(bus, name)
    raise AttributeError(f"module 'palpate' has no attribute {name!r}")
