#include "node/tool/text/given_class_text.h"

#include <cmath>
#include <string>
#include <string_view>

#include "core/curves/pose2.h"
#include "node/files/quantity.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

std::string_view sentence_of(v1::GivenClassStatus status) {
  switch (status) {
    case v1::GIVEN_CLASS_STATUS_FITTED:
      return "least squares of all orthogonal distances";
    case v1::GIVEN_CLASS_STATUS_TOO_FEW_POINTS:
      return "none: there are fewer different points than the class has unknowns";
    case v1::GIVEN_CLASS_STATUS_COLLINEAR:
      return "none: all points lie on one straight line";
    case v1::GIVEN_CLASS_STATUS_AT_LIMIT:
      return "none: the points fit best where the class turns into another, or into two parallel "
             "lines";
    case v1::GIVEN_CLASS_STATUS_UNFINISHED:
      return "none: so many curves fit nearly alike that the search has not found the best";
    case v1::GIVEN_CLASS_STATUS_NOT_DETERMINED:
      return "one of many: the points do not determine the class";
    default:
      return "none: a number of the samples is not finite";
  }
}

}  // namespace

std::string given_class_text(const v1::GivenClassAnswer& answer) {
  std::string text = report_text(answer.recognition());
  text += "  class given  " + std::string(sentence_of(answer.status())) + "\n";
  if (!answer.residual_m().empty()) {
    const LengthUnit unit = length_unit_for(answer.peak_to_valley_m());
    const std::string name(unit.name);
    text += "  form         rms " + number(answer.rms_m() * unit.per_m) + " " + name +
            ", peak to valley " + number(answer.peak_to_valley_m() * unit.per_m) + " " + name +
            "\n";
    text += std::string("  chi2         ") +
            (answer.sigma_stated() ? "of the stated noise"
                                   : "is dof: the noise is estimated from the residuals") +
            "\n";
  }
  if (answer.normal_count() > 0) {
    double squares = 0.0;
    for (const double miss : answer.residual_normal_rad()) {
      squares += std::isfinite(miss) ? miss * miss : 0.0;
    }
    const double rms = std::sqrt(squares / static_cast<double>(answer.normal_count()));
    text += "  normals      " + std::to_string(answer.normal_count()) + " measured, rms " +
            number(rms * 180.0 / kPi) + " degrees off the curve's\n";
  }
  if (answer.left_out_size() > 0) {
    text += "  left out     " + std::to_string(answer.left_out_size()) + " samples\n";
  }
  return text;
}

}  // namespace palpate
