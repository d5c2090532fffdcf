// The paper's method: an answer from the recognition tree and local estimates alone.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/recognition/localized_contact.h"
#include "core/recognition/recognition.h"
#include "core/recognition/tree/recognition_tree.h"

namespace palpate {

/// The contacts as points of the tree: one number per patch. Their windows share no samples.
std::vector<TreePoint> tree_points(std::span<const LocalizedContact> contacts);

/// Copies the tree's path, invariants and final class to the answer.
void add_path(TreeResult tree, Recognition* answer);

/// The answer by the tree alone. `ways`: possible sides of round tips, one side per patch each
/// (samples/tips/tip_sides.h); if more than one leads to a class, the answer is in doubt
/// (TwoShapes). `contacts_of`: computes the contacts for given sides; its last call is that for the
/// answer. `extent_m`: half extent of the samples. `determined_fraction`: as RecognizerOptions. The
/// caller sets the counts of samples.
Recognition answer_by_tree(
    const std::vector<std::vector<int>>& ways,
    const std::function<std::vector<LocalizedContact>(const std::vector<int>&)>& contacts_of,
    const RecognitionTreeOptions& options, double extent_m, double determined_fraction);

}  // namespace palpate
