#include "node/python/array_check.h"

// Before any header of Eigen: GCC else warns of what pybind11 does with its matrices.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "node/check/approach_check.h"
#include "node/check/group_check.h"
#include "node/python/patch_arrays.h"

namespace palpate {

namespace py = pybind11;

namespace {

/// Judges the patches of one object, which are there at once.
class ArrayCheck {
 public:
  ArrayCheck() { group_.probes.emplace_back(); }

  /// As Recognizer::add of the module.
  void add(const Array& points, const Array& sigma_m, std::uint32_t probe, std::uint32_t patch,
           double tip_radius_m, const std::string& side, const Array& normals,
           const Array& normal_sigmas, const Array& covariances_m2) {
    const PatchArrays arrays(points, sigma_m, probe, patch, tip_radius_m, side, normals,
                             normal_sigmas, covariances_m2);
    if (arrays.size() == 0) return;
    ContactRun& run = group_.runs.emplace_back();
    run.context = arrays.context();
    arrays.copy_to(run.samples, run.details);
  }

  /// What makes an answer wrong or worth less, whatever the recognizer makes of the samples.
  std::vector<std::string> warnings() const {
    std::vector<std::string> sentences;
    if (group_.runs.empty()) return sentences;
    for (const Finding& finding : check_group(group_, 0.0, CheckedSource::Arrays)) {
      if (finding.spoils_answer) sentences.push_back(sentence_of(finding));
    }
    return sentences;
  }

  /// Which ends may be approaches or retracts. They may be the part's own, so palpate fit says it
  /// only where it recognised no class.
  std::optional<std::string> approaches() const {
    const auto finding = judge_approaches(group_, true, {}, CheckedSource::Arrays);
    return finding ? std::optional(sentence_of(*finding)) : std::nullopt;
  }

 private:
  ContactGroup group_;
};

}  // namespace

void add_array_check(py::module_& module) {
  py::class_<ArrayCheck>(module, "ArrayCheck")
      .def(py::init())
      .def("add", &ArrayCheck::add)
      .def("warnings", &ArrayCheck::warnings, py::call_guard<py::gil_scoped_release>())
      .def("approaches", &ArrayCheck::approaches, py::call_guard<py::gil_scoped_release>());
}

}  // namespace palpate
