"""Points of the canonical forms (proto/palpate/v1/curve.proto), independent of the programs."""
import math


def point_on(curve_class, parameters, pose, t):
    """World coordinates [m] of a place on a curve, as SceneTruth names class, parameters and pose."""
    a, b, c = (parameters.get(letter, 0.0) for letter in "abc")
    name = curve_class.removeprefix("CURVE_CLASS_")
    u, v = {
        "LINE": lambda: (t, 0.0),
        "CIRCLE": lambda: (a * math.cos(t), a * math.sin(t)),
        "ELLIPSE": lambda: (a * math.cos(t), b * math.sin(t)),
        "PARABOLA": lambda: (a * t * t, 2 * a * t),
        "HYPERBOLA": lambda: (a * math.cosh(t), b * math.sinh(t)),
        "CUBICAL_PARABOLA": lambda: (t, a * t**3 + c * t),
        "SEMI_CUBICAL_PARABOLA": lambda: (t * t, a * t**3 + b * t * t),
        "CUBIC_SPLINE": lambda: (t * t, a * t**3 + b * t * t + c * t),
    }[name]()
    theta = pose.get("theta_rad", 0.0)
    return (pose.get("x_m", 0.0) + math.cos(theta) * u - math.sin(theta) * v,
            pose.get("y_m", 0.0) + math.sin(theta) * u + math.cos(theta) * v)
