// The paper's recovery experiments with this project's defaults: raw contact points in, no noise
// (table 3) or the joystick's (section 6, table 4).
#pragma once

#include <string_view>
#include <vector>

namespace palpate::paper {

/// Mean and worst relative error of the shape parameters over random noise-free curves, two patches
/// of 111 samples each, noise not told.
struct DefaultRecovery {
  std::string_view name;
  int curves = 0;
  int recognised = 0;  ///< as their class, with certainty
  double mean_percent = 0.0;
  double worst_percent = 0.0;
};
/// With a share of the paper's number of curves.
std::vector<DefaultRecovery> default_table3(double share = 1.0);

}  // namespace palpate::paper
