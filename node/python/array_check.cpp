#include "node/python/array_check.h"

// Before any header of Eigen: GCC else warns of what pybind11 does with its matrices.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "node/check/approach_check.h"
#include "node/check/group_check.h"
#include "node/python/patch_arrays.h"

namespace palpate {

namespace py = pybind11;

namespace {

/// Judges the patches of one object. Keeps the newest samples, as many as a judgement needs. Calls
/// from several threads wait for each other.
class ArrayCheck {
 public:
  /// As Recognizer::add of the module.
  void add(const Array& points, const Array& sigma_m, std::uint32_t probe, std::uint32_t patch,
           double tip_radius_m, const std::string& side, const Array& normals,
           const Array& normal_sigmas, const Array& covariances_m2) {
    const PatchArrays arrays(points, sigma_m, probe, patch, tip_radius_m, side, normals,
                             normal_sigmas, covariances_m2);
    if (arrays.size() == 0) return;
    const py::gil_scoped_release release;
    const std::lock_guard lock(mutex_);
    PatchContext context = arrays.context();
    context.probe = index_of(context.probe);
    const bool continues = !group_.runs.empty() &&
                           group_.runs.back().context.probe == context.probe &&
                           group_.runs.back().context.patch == context.patch;
    if (!continues) group_.runs.push_back({context, {}, {}});
    ContactRun& run = group_.runs.back();
    arrays.copy_to(samples_, details_);
    if (!details_.empty() || !run.details.empty()) {
      run.details.resize(run.samples.size());
      details_.resize(samples_.size());
      run.details.insert(run.details.end(), details_.begin(), details_.end());
    }
    run.samples.insert(run.samples.end(), samples_.begin(), samples_.end());
    count_ += samples_.size();
    if (count_ > kMostKept) forget_oldest();
  }

  /// What makes an answer wrong or worth less, whatever the recognizer makes of the samples.
  std::vector<std::string> warnings() {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> sentences;
    if (group_.runs.empty()) return sentences;
    for (Finding& finding : check_group(group_, 0.0, CheckedSource::Arrays)) {
      if (!finding.spoils_answer) continue;
      finding.probe = finding.probe.empty() || group_.probes.size() == 1 ? std::string()
                                                                         : "probe " + finding.probe;
      sentences.push_back(sentence_of(finding));
    }
    return sentences;
  }

  /// Which ends may be approaches or retracts. They may be the part's own, so palpate fit says it
  /// only where it recognised no class.
  std::optional<std::string> approaches() {
    const std::lock_guard lock(mutex_);
    const auto finding = judge_approaches(group_, true, {}, CheckedSource::Arrays);
    return finding ? std::optional(sentence_of(*finding)) : std::nullopt;
  }

 private:
  static constexpr std::size_t kMostKept = 1 << 16;  ///< samples, but for those of the last run

  /// Half of them at a time, so that a long stream of touches costs no more than a short one.
  void forget_oldest() {
    auto kept = group_.runs.begin();
    for (; count_ > kMostKept / 2 && kept + 1 != group_.runs.end(); ++kept) {
      count_ -= kept->samples.size();
    }
    group_.runs.erase(group_.runs.begin(), kept);
  }

  /// Of a probe's number in the group.
  std::uint32_t index_of(std::uint32_t probe) {
    const std::string name = std::to_string(probe);
    const auto known = std::find(group_.probes.begin(), group_.probes.end(), name);
    const auto index = static_cast<std::uint32_t>(known - group_.probes.begin());
    if (known == group_.probes.end()) group_.probes.push_back(name);
    return index;
  }

  // Locked only after the interpreter has been released, as in the Recognizer.
  std::mutex mutex_;
  ContactGroup group_;
  std::size_t count_ = 0;
  std::vector<ContactSample> samples_;
  std::vector<SampleDetail> details_;
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
