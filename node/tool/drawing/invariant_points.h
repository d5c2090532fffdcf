// The recognition tree's invariants contact by contact: the estimate of each contact alone, and the
// value of all contacts together.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "core/recognition/recognition.h"

namespace palpate {

/// The estimate of one contact with its standard deviation, from the contact's own covariance and,
/// for a cubic, that of the common frame.
struct InvariantPoint {
  int patch = 0;  ///< number of the patch among those of the contacts
  double x = 0.0;
  double x_sigma = 0.0;
  double y = 0.0;
  double y_sigma = 0.0;
};

/// The line y = intercept + slope x that all contacts together give.
struct PooledLine {
  std::string label;
  double intercept = 0.0;
  double slope = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of (intercept, slope)

  double at(double x) const { return intercept + slope * x; }
  double sigma_at(double x) const;
};

struct InvariantPanel {
  std::string title;
  std::string test;  ///< the tree's result for the class, e.g. "p = 0.4"
  std::string x_label;
  std::string y_label;
  bool x_is_contact = true;  ///< x is the number of the contact, from 1
  std::size_t contacts = 0;
  std::vector<InvariantPoint> points;
  std::vector<PooledLine> lines;
};

/// One panel for each invariant of every class that the tree tested, in the order tested. The
/// conics share one panel, in which each of them is a straight line: Ip = Ic2 - Ic1 |kappa|^(-2/3).
/// The invariants of the cubics need the canonical frame; it comes from a fit of the class to all
/// contacts.
std::vector<InvariantPanel> invariant_panels(const Recognition& answer);

}  // namespace palpate
