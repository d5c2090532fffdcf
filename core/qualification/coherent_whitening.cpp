#include "core/qualification/coherent_whitening.h"

#include <cmath>

namespace palpate {

double whiten(const Coherence& coherence, std::span<const StrokePlaces> strokes,
              std::span<const double> arc_m, std::span<const char> used, Eigen::MatrixXd& columns) {
  const double variance = coherence.ratio * coherence.ratio;
  double log_determinant = 0.0;
  Eigen::RowVectorXd expected(columns.cols());
  for (const StrokePlaces& stroke : strokes) {
    expected.setZero();
    double known = variance;  // variance of the coherent part, given the samples before
    for (Eigen::Index i = stroke.begin; i < stroke.end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (i > stroke.begin) {
        const double decay = std::exp(-(arc_m[k] - arc_m[k - 1]) / coherence.length_m);
        expected *= decay;
        known = variance + (known - variance) * decay * decay;
      }
      if (used[k] == 0) {
        columns.row(i).setZero();
        continue;
      }
      const double spread = known + 1.0;
      columns.row(i) -= expected;
      expected += known / spread * columns.row(i);
      columns.row(i) /= std::sqrt(spread);
      known -= known * known / spread;
      log_determinant += std::log(spread);
    }
  }
  return log_determinant;
}

}  // namespace palpate
