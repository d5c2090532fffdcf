#include "node/wire/recognizer_options.h"

#include <algorithm>
#include <optional>

#include "core/recognition/samples/side_words.h"

namespace palpate {

std::string flag_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

std::string flags_of(const OptionInfo& info) {
  const std::string also = info.also;
  return (also.empty() ? "" : also + ",") + flag_of(info.name);
}

std::string switch_flags_of(const OptionInfo& info) {
  return flags_of(info) + ",!--no-" + flag_of(info.name).substr(2);
}

std::string resolve(const RecognizerWords& words, RecognizerOptions& recognizer) {
  if (words.method == "ml") {
    recognizer.method = RecognitionMethod::MaximumLikelihood;
  } else if (words.method == "tree") {
    recognizer.method = RecognitionMethod::Tree;
  } else {
    return "method: expected ml or tree";
  }
  recognizer.contacts.estimator.reset();
  if (words.estimator != "sliding") {
    const std::optional<EstimatorKind> kind = estimator_kind_from_name(words.estimator);
    if (!kind) {
      return "estimator: expected sliding, finite-difference, circle, two-round or jet";
    }
    EstimatorOptions& estimator = recognizer.contacts.estimator.emplace();
    estimator.kind = *kind;
    estimator.window = static_cast<int>(words.window);
    estimator.shift = static_cast<int>(words.shift);
  }
  const std::optional<TouchedFrom> touched_from = touched_from_from_name(words.touched_from);
  if (!touched_from) return "touched_from: expected outside, inside or unknown";
  recognizer.touched_from = *touched_from;
  recognizer.classes = words.classes.empty() ? ~0U : 0U;
  for (const std::string& name : words.classes) {
    const std::optional<CurveClass> curve_class = curve_class_from_name(name);
    if (!curve_class || *curve_class == CurveClass::Unclassified) {
      return "classes: \"" + name + "\" is no curve class";
    }
    recognizer.classes |= 1U << static_cast<unsigned>(*curve_class);
  }
  return {};
}

}  // namespace palpate
