// The marginal likelihood of a class: its likelihood, averaged over its prior.
#pragma once

#include <optional>
#include <vector>

#include "core/recognition/posterior/touched_curve.h"

namespace palpate {

/// A curve of the class and the share of its posterior that it stands for.
struct PosteriorNode {
  TouchedCurve curve;
  double weight = 1.0;  ///< of all nodes of a mode: 1
};

/// One mode of a class: an optimum and what lies around it.
struct ClassEvidence {
  Touch touch;
  /// log of the marginal likelihood over the likelihood at the optimum: what the prior leaves of
  /// it.
  double log_occam = 0.0;
  /// The same with all of the prior at this shape: what is left is what the place and direction of
  /// the touch cost every curve.
  double log_occam_of_touch = 0.0;
  /// How many coordinates the data determine rather than the prior.
  double determined = 0.0;
  /// log of the prior's density there over that at its centre.
  double log_prior = 0.0;
  /// Slices along the coordinate that the data leave the widest; one node where the model is linear
  /// over all that they leave.
  std::vector<PosteriorNode> nodes;
  int widest = -1;  ///< that coordinate; -1 with one node
};

/// How the coordinate that is left the widest is integrated over.
enum class Integration {
  Laplace,     ///< like the others: a normal law about the optimum
  Quadrature,  ///< by slices where the mass is not that of a normal law
  Valley,      ///< by slices also where only the valley's bend shows, beside how narrow it is
};

/// J^T J and the prior's curvature, that of normal laws as high, in units of the widths; `fixed`
/// (or -1) does not move.
TouchedMatrix hessian_of(const TouchedCurve& curve, int fixed);

/// The mode of likelihood times prior that lies downhill from a curve; nullopt where none comes
/// near the points, and where `start` is no curve of its class in double precision. Arguments as of
/// evidence_of, but `start` need not be an optimum.
std::optional<TouchedCurve> posterior_mode(const CanonicalFit& start, const FitData& data,
                                           double inflation);

/// `fit` is at its optimum on `data`, the reduced points as surface points, and has a point for
/// each. Noise variances count `inflation` times. nullopt where the fit is no curve of its class in
/// canonical coordinates in double precision: a vertex so far away has no share in the prior.
/// O(points) a slice; at most some forty slices.
std::optional<ClassEvidence> evidence_of(const CanonicalFit& fit, const FitData& data,
                                         double inflation, Integration integration);

}  // namespace palpate
