#include "node/python/known_class.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/curves/curve.h"
#include "core/recognition/given/given_class.h"
#include "core/recognition/given/given_correlation.h"
#include "node/python/names.h"
#include "node/python/point_details.h"
#include "node/python/pose_tuple.h"

namespace palpate {

namespace py = pybind11;

namespace {

/// A curve at its pose in the world, in metres.
class PlacedCurve {
 public:
  PlacedCurve(const std::string& name, const Eigen::Vector3d& params, double x, double y,
              double theta)
      : world_T_curve_{x, y, theta} {
    const auto curve = make_curve(class_called(name), params);
    if (!curve) throw std::invalid_argument("no " + name + " has these parameters");
    curve_ = *curve;
  }

  double period() const { return domain(curve_).period; }

  Array at(const Array& t) const {
    Array points({t.size(), py::ssize_t{2}});
    double* out = points.mutable_data();
    for (py::ssize_t i = 0; i < t.size(); ++i) {
      const Vec2 point = world_T_curve_ * position(curve_, t.data()[i]);
      out[2 * i] = point.x();
      out[2 * i + 1] = point.y();
    }
    return points;
  }

  /// The curve parameters of the nearest points, and the signed distances to them (positive to the
  /// left of increasing t); NaN for a point that is not finite.
  py::tuple feet(const Array& xy) const {
    const auto count = static_cast<py::ssize_t>(count_of_points(xy));
    Array t(count);
    Array distance(count);
    const double* from = xy.data();
    double* t_out = t.mutable_data();
    double* distance_out = distance.mutable_data();
    {
      const py::gil_scoped_release release;
      for (py::ssize_t i = 0; i < count; ++i) {
        const Vec2 point(from[2 * i], from[2 * i + 1]);
        if (!point.allFinite()) {
          t_out[i] = distance_out[i] = std::numeric_limits<double>::quiet_NaN();
          continue;
        }
        const FootPoint foot = foot_point(curve_, world_T_curve_.to_local(point));
        t_out[i] = foot.t;
        distance_out[i] = foot.distance;
      }
    }
    return py::make_tuple(t, distance);
  }

 private:
  Curve curve_;
  Pose2 world_T_curve_;
};

/// Says of the points which stroke each is of. `strokes`: numbers of points that follow one
/// another, n in all; none if all points are touches.
void number_strokes(const std::vector<std::size_t>& strokes, std::vector<GivenPoint>* points) {
  std::size_t begin = 0;
  for (std::size_t k = 0; k < strokes.size(); ++k) {
    if (strokes[k] > points->size() - begin) {
      throw std::invalid_argument("strokes: more points than there are");
    }
    for (std::size_t i = begin; i < begin + strokes[k]; ++i) (*points)[i].stroke = k + 1;
    begin += strokes[k];
  }
  if (!strokes.empty() && begin < points->size()) {
    throw std::invalid_argument("strokes: fewer points than there are");
  }
}

/// Least squares fit of a given class. `points`: n x 2, in any unit of length. `sigma`: length n, 1
/// or 0. The others as in PointDetails and number_strokes.
py::dict fit_given(const std::string& name, const Array& points, const Array& sigma,
                   const Array& normals, const Array& normal_sigmas, const Array& covariances,
                   const std::vector<std::size_t>& strokes) {
  std::vector<GivenPoint> given(count_of_points(points));
  number_strokes(strokes, &given);
  check_sigmas(sigma, given.size());
  const PointDetails details(normals, normal_sigmas, covariances, given.size());
  const CurveClass curve_class = class_called(name);
  const double* xy = points.data();
  const double* sigmas = sigma.data();
  const auto sigma_count = static_cast<std::size_t>(sigma.size());
  GivenFit fit;
  ResidualCorrelation correlation;
  {
    const py::gil_scoped_release release;
    for (std::size_t i = 0; i < given.size(); ++i) {
      const SampleDetail detail = details.of(i);
      given[i].position_m = Vec2(xy[2 * i], xy[2 * i + 1]);
      given[i].sigma_m = sigma_count == 0 ? 0.0 : sigmas[sigma_count == 1 ? 0 : i];
      given[i].normal = detail.normal;
      given[i].normal_sigma_rad = detail.normal_sigma_rad;
      given[i].covariance_m2 = detail.covariance_m2;
    }
    fit = fit_given_class(curve_class, given);
    correlation = count_correlation(given, &fit);
  }
  py::dict result;
  result["status"] = std::string(name_of(fit.status));
  result["params"] = fit.shape.values;
  result["pose"] = pose_of(fit.world_T_curve);
  result["covariance"] = Eigen::MatrixXd(fit.covariance);
  result["rms"] = fit.rms_m;
  result["peak_to_valley"] = fit.peak_to_valley_m;
  result["sigma"] = fit.sigma_m;
  result["noise_correlation"] = correlation.length;
  result["dof"] = fit.dof;
  result["bounded"] = fit.bounded;
  result["rival"] = py::none();
  if (fit.rival) {
    result["rival"] = py::make_tuple(fit.rival->shape.values, pose_of(fit.rival->world_T_curve));
  }
  return result;
}

}  // namespace

void add_known_class(py::module_& module) {
  py::class_<PlacedCurve>(module, "PlacedCurve")
      .def(py::init<const std::string&, const Eigen::Vector3d&, double, double, double>())
      .def_property_readonly("period", &PlacedCurve::period)
      .def("at", &PlacedCurve::at)
      .def("feet", &PlacedCurve::feet);
  module.def("fit_given", &fit_given);
}

}  // namespace palpate
