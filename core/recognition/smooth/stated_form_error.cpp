#include "core/recognition/smooth/stated_form_error.h"

namespace palpate {

double coherent_variance(const FitData& data, double deviation) {
  double weight = 0.0;
  for (const FitPoint& point : data.points) {
    weight += point.inverse_sigma * point.inverse_sigma;
  }
  return deviation * deviation * weight;
}

}  // namespace palpate
