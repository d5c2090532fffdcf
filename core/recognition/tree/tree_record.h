// Records a path through the recognition tree: its tests, all at one significance, and its end.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

class TreeRecord {
 public:
  explicit TreeRecord(double significance) : significance_(significance) {}

  /// Records a chi-square test that each of `classes` must pass. Returns whether it passed.
  bool passes(std::string_view name, double chi2, int dof,
              std::initializer_list<CurveClass> classes) {
    const double p_value = chi_square_survival(chi2, dof);
    const bool passed = p_value >= significance_;
    result.decisions.push_back({name, chi2, threshold_of(dof), passed, p_value});
    for (const CurveClass curve_class : classes) {
      says(curve_class, p_value);
    }
    return passed;
  }

  /// Records the p-value of a test that the class must pass.
  void says(CurveClass curve_class, double p_value) {
    double& least = result.p_values[curve_class];
    least = std::isnan(least) ? p_value : std::min(least, p_value);
  }

  /// Chi-square threshold, cached: the same few degrees of freedom occur again and again.
  double threshold_of(int dof) {
    const auto known =
        std::find_if(thresholds_.begin(), thresholds_.end(),
                     [dof](const std::pair<int, double>& t) { return t.first == dof; });
    return known != thresholds_.end()
               ? known->second
               : thresholds_.emplace_back(dof, chi_square_threshold(significance_, dof)).second;
  }

  void add_invariant(CurveClass curve_class, std::string_view name, double value, double variance) {
    result.invariants.push_back({curve_class, name, value, std::sqrt(variance)});
  }

  /// Records a test that could not be computed: infinite chi-square, no p-value. Returns false.
  bool refused(std::string_view name, int dof) {
    result.decisions.push_back(
        {name, std::numeric_limits<double>::infinity(), threshold_of(dof), false});
    return false;
  }

  /// Records the class where the path ends.
  void reach(CurveClass curve_class, const Eigen::Vector3d& parameters, double chi2, int dof) {
    result.shape = {curve_class, parameters};
    result.chi2 = chi2;
    result.dof = dof;
  }

  TreeResult result;

 private:
  double significance_;
  std::vector<std::pair<int, double>> thresholds_;  ///< by degrees of freedom
};

}  // namespace palpate
