#include "core/recognition/recognition.h"

namespace palpate {

ShapePoseCovariance noise_covariance(const Recognition& recognition) {
  return recognition.covariance_inflation * recognition.white_covariance;
}

void add_doubt(Doubt doubt, Recognition* answer) {
  if (answer->status == RecognitionStatus::Recognized) {
    answer->status = RecognitionStatus::Ambiguous;
    answer->doubt = doubt;
  }
}

std::string_view name_of(Doubt doubt) {
  switch (doubt) {
    case Doubt::None:
      break;
    case Doubt::SeveralClasses:
      return "several_classes";
    case Doubt::AtLimit:
      return "at_limit";
    case Doubt::FormError:
      return "form_error";
    case Doubt::Misfit:
      return "misfit";
    case Doubt::TwoShapes:
      return "two_shapes";
    case Doubt::Undetermined:
      return "undetermined";
    case Doubt::TreeRejects:
      return "tree_rejects";
    case Doubt::WorkLimit:
      return "work_limit";
    case Doubt::FewPlaces:
      return "few_places";
  }
  return "none";
}

}  // namespace palpate
