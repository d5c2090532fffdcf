// The tree beside an answer by likelihood, at every answer.
#pragma once

#include <span>

#include "core/recognition/localized_contact.h"
#include "core/recognition/tree/recognition_tree.h"
#include "core/recognition/weigh/weigh.h"

namespace palpate {

/// The path on the contacts of a weighing, a few of them where they are many. It is reported only:
/// curves are not searched for, their fits begin where the samples laid them. `places` are those of
/// the contacts `pooled`.
TreeResult tree_beside(const Weighing& w, std::span<const LocalizedContact> contacts,
                       const RecognitionTreeOptions& options);

}  // namespace palpate
