#include "core/qualification/coherent_whitening.h"

#include <cmath>
#include <limits>

#include "core/recognition/coherent/markov_drift.h"

namespace palpate {

double whiten(const Coherence& coherence, std::span<const StrokePlaces> strokes,
              std::span<const double> arc_m, std::span<const char> used, Eigen::MatrixXd& columns) {
  DriftFilter filter({coherence.ratio, coherence.length_m});
  double log_determinant = 0.0;
  Eigen::RowVectorXd expected = Eigen::RowVectorXd::Zero(columns.cols());
  for (const StrokePlaces& stroke : strokes) {
    double last_m = -std::numeric_limits<double>::infinity();  // of the sample used before
    for (Eigen::Index i = stroke.begin; i < stroke.end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (used[k] == 0) {
        columns.row(i).setZero();
        continue;
      }
      const DriftFilter::Gain gain = filter.next({.from_last = arc_m[k] - last_m});
      last_m = arc_m[k];
      expected *= gain.kept;
      columns.row(i) -= expected;
      expected += gain.share * columns.row(i);
      columns.row(i) /= std::sqrt(gain.variance);
      log_determinant += std::log(gain.variance);
    }
  }
  return log_determinant;
}

}  // namespace palpate
