// The recognition tree, walked in addition to each answer by likelihood.
#pragma once

#include <span>

#include "core/recognition/localized_contact.h"
#include "core/recognition/recognition.h"
#include "core/recognition/tree/recognition_tree.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// The tree's path on the contacts of a weighing, at most five of them. It is only reported. It
/// does not search: each fit starts from the class's fit to the samples. `places` of the result
/// belong to the contacts `pooled`.
TreeResult reported_tree_path(const Weighing& w, std::span<const LocalizedContact> contacts,
                              const RecognitionTreeOptions& options);

/// The answer of a weighing with that path on its contacts, and the doubt if the tree's tests
/// reject the class.
Recognition with_tree_path(Recognition answer, const Weighing& w,
                           const RecognitionTreeOptions& options);

}  // namespace palpate
