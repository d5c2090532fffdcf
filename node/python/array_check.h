// What palpate fit says of a file's samples, said of arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "node/check/contact_group.h"

namespace palpate {

/// Judges the patches of one object. Keeps the newest samples, as many as a judgement needs.
class ArrayCheck {
 public:
  /// As Recognizer::add.
  void add(PatchContext context, std::span<const ContactSample> samples,
           std::span<const SampleDetail> details);

  /// What makes an answer wrong or worth less, whatever the recognizer makes of the samples.
  std::vector<std::string> warnings() const;

  /// Which ends may be approaches or retracts. They may be the part's own, so palpate fit says it
  /// only where it recognised no class.
  std::optional<std::string> approaches() const;

 private:
  void forget_oldest();
  std::uint32_t index_of(std::uint32_t probe);

  ContactGroup group_;
  std::size_t count_ = 0;
};

}  // namespace palpate
