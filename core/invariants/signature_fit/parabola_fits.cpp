#include "core/invariants/signature_fit/parabola_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/curves/pose2.h"
#include "core/invariants/cubical_parabola_invariants.h"
#include "core/invariants/semi_cubical_parabola_invariants.h"

namespace palpate {
namespace {

/// Bounds of the time. Of 15 pairs of points, one whose points are well apart is enough for a
/// start; its quadratic has two roots.
constexpr std::size_t kSeedPoints = 6;
constexpr std::size_t kRefined = 2;

struct Candidate {
  Eigen::Vector3d parameters = Eigen::Vector3d::Zero();
  double orientation = 0.0;
  double misfit = 0.0;
};

/// Squared relative difference of two numbers that should be equal, in [0, 1].
double disagreement(double p, double q) {
  const double size = std::abs(p) + std::abs(q);
  return size > 0.0 ? std::pow((p - q) / size, 2) : 0.0;
}

/// Misfit of y''' and (y'')^2 of y = a x^3 + c x, multiplied by powers of the cosine.
double cubical_misfit(const CanonicalPoint<double>& p, const Eigen::Vector3d& parameters) {
  const double c2 = p.cosine * p.cosine;
  const double third = 6.0 * parameters[0] * c2 * c2 * p.cosine;
  return disagreement(p.jerk, third) +
         disagreement(p.kappa * p.kappa, 2.0 * third * (p.sine - parameters[1] * p.cosine));
}

/// Misfit of (43) and (44) without denominators, with e = (lambda - b) cosine: kappa e = (9/8) a^2
/// cosine^4 and jerk e = -kappa^2.
double semi_cubical_misfit(const CanonicalPoint<double>& p, const Eigen::Vector3d& parameters) {
  const double c2 = p.cosine * p.cosine;
  const double e = p.sine - parameters[1] * p.cosine;
  return disagreement(p.kappa * e, 1.125 * parameters[0] * parameters[0] * c2 * c2) +
         disagreement(p.jerk * e, -p.kappa * p.kappa);
}

struct ParabolaFamily {
  CurveClass curve_class;
  PairSolutions (*solve_pair)(const MeasuredGeometry&, const MeasuredGeometry&);
  double (*misfit)(const CanonicalPoint<double>&, const Eigen::Vector3d&);
  Eigen::Vector3d (*parameters)(const CanonicalPoint<double>&);
};

constexpr ParabolaFamily kCubical = {CurveClass::CubicalParabola, cubical_parabola_pair,
                                     cubical_misfit, [](const CanonicalPoint<double>& p) {
                                       return Eigen::Vector3d(cubical_parabola_a(p),
                                                              cubical_parabola_c(p), 0.0);
                                     }};

constexpr ParabolaFamily kSemiCubical = {
    CurveClass::SemiCubicalParabola, semi_cubical_parabola_pair, semi_cubical_misfit,
    [](const CanonicalPoint<double>& p) {
      return Eigen::Vector3d(std::sqrt(std::abs(semi_cubical_parabola_a_squared(p))),
                             semi_cubical_parabola_b(p), 0.0);
    }};

std::vector<Candidate> candidates_of(const ParabolaFamily& family,
                                     const std::vector<MeasuredGeometry>& points) {
  std::vector<Candidate> candidates;
  const auto offer = [&](const Eigen::Vector3d& parameters, double orientation) {
    Candidate candidate{parameters, orientation, 0.0};
    for (const MeasuredGeometry& point : points) {
      candidate.misfit += family.misfit(
          canonical_point(point.tangent_angle - orientation, point.kappa, point.kappa_s),
          parameters);
    }
    if (parameters.allFinite() && parameters[0] != 0.0 && std::isfinite(candidate.misfit)) {
      candidates.push_back(candidate);
    }
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const PairSolutions pair = family.solve_pair(points[i], points[j]);
      for (int k = 0; k < pair.count; ++k) {
        const PairSolution& solution = pair.solutions[static_cast<std::size_t>(k)];
        offer({solution.parameters[0], solution.parameters[1], 0.0},
              points[i].tangent_angle - solution.angle);
      }
      if (pair.status == InvariantStatus::NoRealRoot) {
        const auto at = canonical_point(pair.nearest_angle, points[i].kappa, points[i].kappa_s);
        const double half_turn = at.kappa * at.jerk > 0.0 ? kPi : 0.0;  // a^2 > 0, see (43)
        offer(family.parameters(at),
              points[i].tangent_angle - pair.nearest_angle -
                  (family.curve_class == CurveClass::SemiCubicalParabola ? half_turn : 0.0));
      }
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& p, const Candidate& q) { return p.misfit < q.misfit; });
  const auto same = [](const Candidate& p, const Candidate& q) {
    return std::abs(std::sin(p.orientation - q.orientation)) < 1e-3;
  };
  candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
  return candidates;
}

SemiSignatureFit fit_family(const ParabolaFamily& family,
                            std::span<const MeasuredGeometry> measured,
                            const SemiSignatureOptions& options) {
  SemiSignatureFit best;
  best.curve_class = family.curve_class;
  if (measured.size() < 2) {
    return best;
  }
  if (!are_finite(measured)) {
    best.status = InvariantStatus::NotFinite;
    return best;
  }
  const double scale = curvature_scale(measured);
  if (!(scale > 0.0)) {
    best.status = InvariantStatus::ZeroCurvature;
    return best;
  }
  // In lengths of 1 / scale the misfits are dimensionless. The parameters are scaled back below.
  std::vector<MeasuredGeometry> points;
  const std::size_t count = std::min(measured.size(), kSeedPoints);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(in_units_of(measured[i * (measured.size() - 1) / (count - 1)], 1.0 / scale));
  }
  const double a_factor =
      family.curve_class == CurveClass::CubicalParabola ? scale * scale : std::sqrt(scale);
  best.status = InvariantStatus::NoRealRoot;
  best.chi2 = std::numeric_limits<double>::infinity();
  const std::vector<Candidate> candidates = candidates_of(family, points);
  for (std::size_t i = 0; i < std::min(candidates.size(), kRefined); ++i) {
    Eigen::Vector3d start = candidates[i].parameters;
    start[0] *= a_factor;
    SemiSignatureFit fit =
        fit_semi_signature(family.curve_class, measured, start, candidates[i].orientation, options);
    keep_better(std::move(fit), best);
  }
  return best;
}

}  // namespace

SemiSignatureFit fit_cubical_parabola(std::span<const MeasuredGeometry> points,
                                      const SemiSignatureOptions& options) {
  return fit_family(kCubical, points, options);
}

SemiSignatureFit fit_semi_cubical_parabola(std::span<const MeasuredGeometry> points,
                                           const SemiSignatureOptions& options) {
  return fit_family(kSemiCubical, points, options);
}

}  // namespace palpate
