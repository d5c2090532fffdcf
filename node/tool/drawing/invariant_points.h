// The recognition tree's invariants contact by contact: what each contact alone says, beside the
// value that all of them give together.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "core/recognition/recognition.h"

namespace palpate {

/// What one contact says, with one standard deviation: its own estimate's, and for a cubic the
/// frame's that all of them give.
struct InvariantPoint {
  int patch = 0;  ///< number of the patch among those of the contacts
  double x = 0.0;
  double x_sigma = 0.0;
  double y = 0.0;
  double y_sigma = 0.0;
};

/// y = intercept + slope x, as all contacts say it.
struct PooledLine {
  std::string label;
  double intercept = 0.0;
  double slope = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of both

  double at(double x) const { return intercept + slope * x; }
  double sigma_at(double x) const;
};

struct InvariantPanel {
  std::string title;
  std::string test;  ///< what the tree says of the class: "p = 0.4"
  std::string x_label;
  std::string y_label;
  bool x_is_contact = true;  ///< x counts contacts from 1
  std::size_t contacts = 0;
  std::vector<InvariantPoint> points;
  std::vector<PooledLine> lines;
};

/// A panel for every invariant of every class that the tree asked about, in the order asked. Conics
/// share one, on which each is a straight line: Ip = Ic2 - Ic1 |kappa|^(-2/3). The invariants of
/// the cubics need the canonical frame, which is that of the class laid through all contacts.
std::vector<InvariantPanel> invariant_panels(const Recognition& answer);

}  // namespace palpate
