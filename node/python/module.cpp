// palpate._core: the recognizer for numpy arrays. The public interface is palpate/__init__.py.
#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "node/python/array_check.h"
#include "node/python/known_class.h"
#include "node/python/names.h"
#include "node/python/point_details.h"
#include "node/python/pose_tuple.h"
#include "node/python/sendable.h"

namespace py = pybind11;

namespace {

using palpate::Array;
using palpate::class_called;
using palpate::PointDetails;
using palpate::pose_of;

const char* name_of(palpate::RecognitionStatus status) {
  switch (status) {
    case palpate::RecognitionStatus::Collecting:
      return "collecting";
    case palpate::RecognitionStatus::Ambiguous:
      return "ambiguous";
    case palpate::RecognitionStatus::Recognized:
      break;
  }
  return "recognized";
}

py::dict hypothesis_of(const palpate::Hypothesis& hypothesis) {
  py::dict result;
  result["curve_class"] = std::string(palpate::name_of(hypothesis.shape.curve_class));
  result["probability"] = hypothesis.probability;
  result["params"] = hypothesis.shape.values;
  result["pose"] = pose_of(hypothesis.world_T_curve);
  result["chi2"] = hypothesis.chi2;
  result["dof"] = hypothesis.dof;
  result["at_limit"] = hypothesis.at_limit;
  return result;
}

py::dict contact_of(const palpate::LocalizedContact& contact) {
  const palpate::LocalEstimate& estimate = contact.estimate;
  py::dict result;
  result["probe"] = contact.probe;
  result["patch"] = contact.patch;
  result["t"] = contact.t;
  result["position_m"] = Eigen::Vector2d(estimate.position);
  result["tangent_rad"] = estimate.tangent_angle;
  result["kappa_per_m"] = estimate.kappa;
  result["kappa_s_per_m2"] = estimate.kappa_s;
  result["covariance"] = Eigen::MatrixXd(estimate.covariance);
  return result;
}

/// An answer. Its parts are converted to Python when they are read.
struct Answer {
  palpate::Recognition recognition;
  double compute_s = 0.0;

  py::list hypotheses() const {
    py::list result;
    for (const auto& hypothesis : recognition.hypotheses) result.append(hypothesis_of(hypothesis));
    return result;
  }
  py::list contacts() const {
    py::list result;
    for (const auto& contact : recognition.contacts) result.append(contact_of(contact));
    return result;
  }
};

template <typename Get>
void add_property(py::class_<Answer>& type, const char* name, Get get) {
  type.def_property_readonly(name, [get](const Answer& answer) { return get(answer.recognition); });
}

/// Adds the time of its scope to a sum: the C++ time of a call, without the conversion from and to
/// Python.
class ComputeTime {
 public:
  explicit ComputeTime(double& sum_s) : sum_s_(sum_s) {}
  ~ComputeTime() {
    sum_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  ComputeTime(const ComputeTime&) = delete;
  ComputeTime& operator=(const ComputeTime&) = delete;

 private:
  double& sum_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

class Recognizer {
 public:
  Recognizer(double sigma_m, const std::vector<std::string>& classes, double form_deviation_m,
             std::optional<bool> unqualified_probe, std::size_t most_patches,
             std::size_t most_samples_per_patch, const std::string& touched_from, double patience)
      : recognizer_(options_of(sigma_m, classes, form_deviation_m, unqualified_probe, most_patches,
                               most_samples_per_patch, touched_from, patience)) {}

  /// `points`: n x 2, in metres. `sigma_m`: length n, 1 or 0. The others as in PointDetails.
  /// Returns how many points were accepted, and how many only repeat the place of the one before.
  py::tuple add(const Array& points, const Array& sigma_m, std::uint32_t probe, std::uint32_t patch,
                double tip_radius_m, const std::string& side, const Array& normals,
                const Array& normal_sigmas, const Array& covariances_m2) {
    const std::size_t count = palpate::count_of_points(points);
    const auto sigmas = static_cast<std::size_t>(sigma_m.size());
    palpate::check_sigmas(sigma_m, count);
    const palpate::PatchContext context{probe, patch, tip_radius_m, palpate::side_called(side)};
    const double* xy = points.data();
    const double* sigma = sigma_m.data();
    // If any point of a patch is invalid, none of the patch is added.
    std::size_t not_finite = 0;
    for (std::size_t i = 0; i < count; ++i) {
      not_finite += std::isfinite(xy[2 * i]) && std::isfinite(xy[2 * i + 1]) ? 0 : 1;
    }
    if (not_finite > 0) {
      throw std::invalid_argument("points: " + std::to_string(not_finite) + " are not finite");
    }
    if (!(std::isfinite(tip_radius_m) && tip_radius_m >= 0.0)) {
      throw std::invalid_argument("tip_radius: must be finite and not below 0");
    }
    const PointDetails details(normals, normal_sigmas, covariances_m2, count);
    palpate::AddResult added;
    {
      const py::gil_scoped_release release;
      const std::lock_guard lock(mutex_);
      const ComputeTime time(compute_s_);
      samples_.resize(count);
      for (std::size_t i = 0; i < count; ++i) {
        samples_[i].position_m = palpate::Vec2(xy[2 * i], xy[2 * i + 1]);
        samples_[i].sigma_m = sigmas == 0 ? 0.0 : sigma[sigmas == 1 ? 0 : i];
      }
      details_.resize(details.say_anything() ? count : 0);
      for (std::size_t i = 0; i < details_.size(); ++i) {
        details_[i] = details.of(i);
        if (details_[i].covariance_m2.x() > 0.0) {
          samples_[i].sigma_m = palpate::mean_sigma_m(details_[i].covariance_m2);
        }
      }
      added = recognizer_.add(context, samples_, details_);
      check_.add(context, samples_, details_);
    }
    return py::make_tuple(added.accepted, added.repeated);
  }

  Answer recognize() {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    Answer answer;
    {
      const ComputeTime time(compute_s_);
      answer.recognition = recognizer_.recognize();
    }
    answer.compute_s = std::exchange(compute_s_, 0.0);
    return answer;
  }

  std::vector<std::string> warnings() {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    return check_.warnings();
  }

  std::optional<std::string> approaches() {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    return check_.approaches();
  }

  void reset() {
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    recognizer_.reset();
    check_ = {};
  }

 private:
  static palpate::RecognizerOptions options_of(
      double sigma_m, const std::vector<std::string>& classes, double form_deviation_m,
      std::optional<bool> unqualified_probe, std::size_t most_patches,
      std::size_t most_samples_per_patch, const std::string& touched_from, double patience) {
    for (const auto& [name, value] :
         {std::pair("sigma", sigma_m), std::pair("form_deviation", form_deviation_m)}) {
      if (!(std::isfinite(value) && value >= 0.0)) {
        throw std::invalid_argument(std::string(name) + ": must be finite and not below 0");
      }
    }
    palpate::RecognizerOptions options;
    options.sigma_m = sigma_m;
    options.form_deviation_m = form_deviation_m;
    options.unqualified_probe = unqualified_probe;
    options.touched_from = palpate::place_called(touched_from);
    options.patience = patience;
    options.memory.most_patches = most_patches;
    options.memory.most_lone_touches = std::max(options.memory.most_lone_touches, most_patches);
    options.memory.most_samples_per_patch = most_samples_per_patch;
    if (!classes.empty()) options.classes = 0;
    for (const std::string& name : classes) {
      options.classes |= 1U << static_cast<unsigned>(class_called(name));
    }
    return options;
  }

  // Locked only after the interpreter has been released: threads that share this object would
  // otherwise be in the recognizer at the same time.
  std::mutex mutex_;
  palpate::Recognizer recognizer_;
  palpate::ArrayCheck check_;
  std::vector<palpate::ContactSample> samples_;
  std::vector<palpate::SampleDetail> details_;
  double compute_s_ = 0.0;  // since the last answer
};

}  // namespace

PYBIND11_MODULE(_core, module) {
  py::class_<Recognizer>(module, "Recognizer")
      .def(py::init<double, const std::vector<std::string>&, double, std::optional<bool>,
                    std::size_t, std::size_t, const std::string&, double>())
      .def("add", &Recognizer::add)
      .def("recognize", &Recognizer::recognize)
      .def("warnings", &Recognizer::warnings)
      .def("approaches", &Recognizer::approaches)
      .def("reset", &Recognizer::reset);
  py::class_<Answer> answer(module, "Answer");
  add_property(answer, "status", [](const auto& r) { return name_of(r.status); });
  add_property(answer, "doubt", [](const auto& r) { return palpate::name_of(r.doubt); });
  add_property(answer, "curve_class",
               [](const auto& r) { return palpate::name_of(r.shape.curve_class); });
  add_property(answer, "has_shape", [](const auto& r) {
    return r.shape.curve_class != palpate::CurveClass::Unclassified &&
           !(!r.hypotheses.empty() && r.hypotheses.front().at_limit);
  });
  add_property(answer, "params", [](const auto& r) -> Eigen::Vector3d { return r.shape.values; });
  add_property(answer, "pose", [](const auto& r) { return pose_of(r.world_T_curve); });
  add_property(answer, "covariance", [](const auto& r) -> Eigen::MatrixXd { return r.covariance; });
  add_property(answer, "noise_covariance",
               [](const auto& r) -> Eigen::MatrixXd { return palpate::noise_covariance(r); });
  add_property(answer, "unqualified_probe", [](const auto& r) { return r.unqualified_probe; });
  add_property(answer, "sample_count", [](const auto& r) { return r.sample_count; });
  add_property(answer, "outlier_count", [](const auto& r) { return r.outlier_count; });
  add_property(answer, "dwelling_count", [](const auto& r) { return r.dwelling_count; });
  add_property(answer, "forgotten_count", [](const auto& r) { return r.forgotten_count; });
  add_property(answer, "simplified_count", [](const auto& r) { return r.simplified_count; });
  add_property(answer, "sigma_m", [](const auto& r) { return r.sigma_m; });
  add_property(answer, "noise_correlation_m", [](const auto& r) { return r.noise_correlation_m; });
  answer.def_readonly("compute_s", &Answer::compute_s)
      .def_property_readonly("hypotheses", &Answer::hypotheses)
      .def_property_readonly("contacts", &Answer::contacts);
  palpate::add_known_class(module);
  module.def("patience_with_files", [] { return palpate::kPatienceWithFiles; });
  module.def("check_sendable_lengths", &palpate::check_sendable_lengths);
  module.def("check_sendable_points", &palpate::check_sendable_points);
  module.def("curve_classes", &palpate::curve_classes);
  module.def("degrees_of_freedom", [](const std::string& name) {
    return palpate::degrees_of_freedom(class_called(name));
  });
  module.def("parameter_letters", [](const std::string& name) {
    return std::string(palpate::parameter_letters(class_called(name)));
  });
}
