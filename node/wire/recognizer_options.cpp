#include "node/wire/recognizer_options.h"

#include <optional>

namespace palpate {

std::string resolve(const RecognizerWords& words, RecognizerOptions& recognizer) {
  if (words.method == "ml") {
    recognizer.method = RecognitionMethod::MaximumLikelihood;
  } else if (words.method == "tree") {
    recognizer.method = RecognitionMethod::Tree;
  } else {
    return "method: expected ml or tree";
  }
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
