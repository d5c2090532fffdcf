#include "core/local/stream/higher_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

// Curvature and its derivative show the size of the higher terms; place and direction do not.
constexpr int kFirstEvidence = 2;
using Terms = Eigen::Matrix<double, kWindowSize, 1>;

/// Grid of the prior: the amplitude A in units of the size of c_2 and c_3, and the fall-off rho. If
/// noise makes up that size, the terms may be much smaller.
constexpr std::array<double, 3> kAmplitudes = {0.0625, 0.25, 1.0};
constexpr std::array<double, 10> kFallOffs = {0.012, 0.021, 0.036, 0.06, 0.1,
                                              0.15,  0.22,  0.3,   0.45, 0.65};
/// Prior odds of the fall-offs. Windows end where their highest terms are noise, so fall-offs
/// slower than 0.3 are an exception: next to bends, about one window in a hundred.
constexpr std::array<double, 10> kPriorOdds = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.01, 0.01};
/// Squared ratio of odd to even terms: anywhere on a curve, and near a place where the curve is its
/// own mirror image. At such a place (the third case) odd terms are 0. Every place of a circle is
/// one: its odd terms vanish and say nothing about its even terms.
constexpr std::array<double, 2> kOdd2 = {1.0, 0.01};

constexpr int kFallOffCount = static_cast<int>(kFallOffs.size());
constexpr int kPairs = static_cast<int>(kAmplitudes.size()) * kFallOffCount;
using Pairs = Eigen::Array<double, kPairs, 1>;

/// A^2, powers of rho and prior odds of each grid point.
struct GridPoints {
  Pairs amplitude2, fall_off2, fall_off4, ninth, odds;
  GridPoints() {
    for (int i = 0; i < kPairs; ++i) {
      const auto fall_off = static_cast<std::size_t>(i % kFallOffCount);
      amplitude2[i] = std::pow(kAmplitudes[static_cast<std::size_t>(i / kFallOffCount)], 2);
      fall_off2[i] = std::pow(kFallOffs[fall_off], 2);
      fall_off4[i] = fall_off2[i] * fall_off2[i];
      ninth[i] = amplitude2[i] * fall_off2[i] * fall_off4[i] * fall_off4[i] * fall_off4[i];
      odds[i] = kPriorOdds[fall_off];
    }
  }
};

/// The terms of one parity of the free fit, at every grid point. A term of variance v and prior
/// variance s2 keeps the share s2 / (s2 + v) of itself.
struct ParityTerms {
  std::array<Pairs, kWindowSize> kept;
  std::array<Pairs, kWindowSize> inverse;  ///< 1 / (s2 + v)
  Pairs exponent = Pairs::Zero();          ///< of the evidence, and the square of its factor
  Pairs factor2 = Pairs::Ones();

  ParityTerms(int first, const Terms& c, const Terms& variance, double size2, Pairs s2,
              const Pairs& fall_off4) {
    for (int k = first; k < kWindowSize; k += 2) {
      const auto i = static_cast<std::size_t>(k);
      inverse[i] = (s2 + variance[k]).inverse();
      kept[i] = s2 * inverse[i];
      exponent += c[k] * c[k] * inverse[i];
      factor2 *= size2 * inverse[i];  // relative to the size, to stay in the range of a double
      s2 *= fall_off4;
    }
  }
};

/// Odd terms that vanish: nothing of them is kept, at any grid point.
struct NoTerms {
  double exponent = 0.0;
  double factor2 = 1.0;

  NoTerms(int first, const Terms& c, const Terms& variance, double size2) {
    for (int k = first; k < kWindowSize; k += 2) {
      exponent += c[k] * c[k] / variance[k];
      factor2 *= size2 / variance[k];
    }
  }
};

}  // namespace

HigherTerms higher_terms(const Terms& c, const Terms& variance) {
  static const GridPoints points;
  constexpr std::size_t kKinds = kOdd2.size();
  const double size2 =
      c[2] * c[2] + c[3] * c[3] + variance[2] + variance[3] + std::numeric_limits<double>::min();
  const Pairs second = size2 * points.amplitude2;
  const Pairs third = second * points.fall_off2;
  const ParityTerms even(kFirstEvidence, c, variance, size2, second, points.fall_off4);
  const auto odd_terms = [&](double odd2) {
    return ParityTerms(kFirstEvidence + 1, c, variance, size2, odd2 * third, points.fall_off4);
  };
  const std::array<ParityTerms, kKinds> odd = {odd_terms(kOdd2[0]), odd_terms(kOdd2[1])};
  const NoTerms none(kFirstEvidence + 1, c, variance, size2);

  const double least = std::min({(even.exponent + odd[0].exponent).minCoeff(),
                                 (even.exponent + odd[1].exponent).minCoeff(),
                                 even.exponent.minCoeff() + none.exponent});
  std::array<Pairs, kKinds> shares;
  for (std::size_t i = 0; i < kKinds; ++i) {
    shares[i] = points.odds * (even.factor2 * odd[i].factor2).sqrt() *
                (0.5 * (least - even.exponent - odd[i].exponent)).exp();
  }
  const Pairs share_of_none = points.odds * (even.factor2 * none.factor2).sqrt() *
                              (0.5 * (least - even.exponent - none.exponent)).exp();
  const Pairs pairs = shares[0] + shares[1] + share_of_none;
  const double total = pairs.sum();
  const double total_of_none = share_of_none.sum();

  // For each term: the kept shares, weighted with the posterior, and their products with those of
  // the other terms.
  std::array<Pairs, kPriorTerms> weighted;
  Eigen::Matrix<double, kPriorTerms, kPriorTerms> both;
  HigherTerms found;
  for (int k = kFirstPrior; k < kWindowSize; k += 2) {
    const auto at = static_cast<std::size_t>(k);
    Pairs& now = weighted[at - kFirstPrior];
    now = pairs * even.kept[at];
    found.variances[k - kFirstPrior] = now.sum() / (pairs * even.inverse[at]).sum();
    for (int j = kFirstPrior; j <= k; j += 2) {
      both(k - kFirstPrior, j - kFirstPrior) = (now * even.kept[static_cast<std::size_t>(j)]).sum();
    }
  }
  for (int k = kFirstPrior + 1; k < kWindowSize; k += 2) {
    const auto at = static_cast<std::size_t>(k);
    const Pairs usual = shares[0] * odd[0].kept[at];
    const Pairs near = shares[1] * odd[1].kept[at];
    Pairs& now = weighted[at - kFirstPrior];
    now = usual + near;
    found.variances[k - kFirstPrior] =
        now.sum() / ((shares[0] * odd[0].inverse[at] + shares[1] * odd[1].inverse[at]).sum() +
                     total_of_none / variance[k]);
    for (int j = kFirstPrior; j < kWindowSize; ++j) {
      const auto before = static_cast<std::size_t>(j);
      if (j % 2 == 0) {
        both(std::max(j, k) - kFirstPrior, std::min(j, k) - kFirstPrior) =
            (now * even.kept[before]).sum();
      } else if (j <= k) {
        both(k - kFirstPrior, j - kFirstPrior) =
            (usual * odd[0].kept[before] + near * odd[1].kept[before]).sum();
      }
    }
  }
  Eigen::Matrix<double, kPriorTerms, 1> kept;
  for (int k = 0; k < kPriorTerms; ++k) {
    kept[k] = weighted[static_cast<std::size_t>(k)].sum() / total;
    for (int j = 0; j <= k; ++j) {
      found.apart(k, j) = found.apart(j, k) = both(k, j) / total - kept[k] * kept[j];
    }
  }
  // Samples say something about the terms that the polynomial lacks only through A and rho.
  found.tail_variances[0] =
      size2 * ((kOdd2[0] * shares[0] + kOdd2[1] * shares[1]) * points.ninth).sum() / total;
  found.tail_variances[1] = size2 * (pairs * points.ninth * points.fall_off2).sum() / total;
  return found;
}

}  // namespace palpate
