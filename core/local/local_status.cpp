#include "core/local/local_status.h"

namespace palpate {

std::string_view name_of(LocalStatus status) {
  switch (status) {
    case LocalStatus::Ok:
      return "ok";
    case LocalStatus::TooFewSamples:
      return "too_few_samples";
    case LocalStatus::NotFinite:
      return "not_finite";
    case LocalStatus::NoExtent:
      return "no_extent";
    case LocalStatus::Unresolved:
      return "unresolved";
    case LocalStatus::DoublesBack:
      return "doubles_back";
    case LocalStatus::TurnsTooFar:
      return "turns_too_far";
    case LocalStatus::NotFollowed:
      return "not_followed";
  }
  return "unknown";
}

}  // namespace palpate
