// The paper's way: nothing but the tree on local estimates.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/recognition/localized_contact.h"
#include "core/recognition/recognition.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// The contacts as the tree takes them: their windows share no sample.
std::vector<TreePoint> tree_points(std::span<const LocalizedContact> contacts);

/// The path, the invariants and where the tree ended, in the answer.
void add_path(TreeResult tree, Recognition* answer);

/// The answer by the tree alone. `ways`: in which round tips may lie, the sides of the patches each
/// (samples/tip_sides.h); a second one that ends in a class leaves a doubt. `contacts_of`: contacts
/// with the tips so, the last call being that of the answer. `extent_m`: half extent of the
/// samples; `determined_fraction`: as RecognizerOptions. Counts of samples are the caller's.
Recognition answer_by_tree(
    const std::vector<std::vector<int>>& ways,
    const std::function<std::vector<LocalizedContact>(const std::vector<int>&)>& contacts_of,
    const RecognitionTreeOptions& options, double extent_m, double determined_fraction);

}  // namespace palpate
