// How ceres::TinySolver is to minimise residuals that are in units of their standard deviation.
#pragma once

#include <ceres/tiny_solver.h>

namespace palpate {

/// Ends after `iterations`, or where chi-square changes by less than `chi2_tolerance`: the solver
/// compares the ABSOLUTE change of the cost, whatever its comment says. Little damping to begin
/// with: the valleys of short arcs are long, and the solver multiplies the damping fast where a
/// step fails.
template <typename Residuals>
typename ceres::TinySolver<Residuals>::Options least_squares_options(int iterations,
                                                                     double chi2_tolerance) {
  typename ceres::TinySolver<Residuals>::Options options;
  options.max_num_iterations = iterations;
  options.function_tolerance = chi2_tolerance;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-14;
  options.cost_threshold = 0.0;
  options.initial_trust_region_radius = 1e8;
  return options;
}

}  // namespace palpate
