#include "core/recognition/recognizer.h"

#include <cmath>

namespace palpate {

class Recognizer::Impl {
 public:
  std::size_t sample_count = 0;
};

Recognizer::Recognizer(const RecognizerOptions&) : impl_(std::make_unique<Impl>()) {}
Recognizer::~Recognizer() = default;
Recognizer::Recognizer(Recognizer&&) noexcept = default;
Recognizer& Recognizer::operator=(Recognizer&&) noexcept = default;

AddResult Recognizer::add(const PatchContext&, std::span<const ContactSample> samples) {
  AddResult result;
  for (const ContactSample& sample : samples) {
    if (sample.position_m.allFinite() && std::isfinite(sample.sigma_m)) {
      ++result.accepted;
    } else {
      ++result.rejected_not_finite;
    }
  }
  impl_->sample_count += result.accepted;
  return result;
}

Recognition Recognizer::recognize() {
  Recognition recognition;
  recognition.sample_count = impl_->sample_count;
  return recognition;
}

void Recognizer::reset() { impl_->sample_count = 0; }

}  // namespace palpate
