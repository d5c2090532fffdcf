// Class probabilities if probe and part may deviate smoothly: the shape of one class may be such a
// deviation from another.
#pragma once

#include "core/recognition/weigh/contenders.h"

namespace palpate {

/// Adds to the evidence of each class within reach what deviations shared by neighbours explain
/// (coherent/coherent_gain.h): a probe with two lobes turns a ring into an ellipse. By default this
/// changes only the shares of the classes, not their total, and "unclassified" keeps its evidence,
/// because free paths follow any deviation. `of_any_size`: if another shape may be the better
/// answer (free paths, or parts that deviate by more than kLargestFormError), and classes with
/// deviations have more evidence than free paths, it is even odds whether there is such a deviation
/// or another shape. Otherwise, as for a probe that is trusted, it is another shape. `margin`: log
/// odds below which the best is not RECOGNIZED.
Contenders with_shared_deviations(Contenders contenders, const EvidenceContext& context,
                                  bool of_any_size, double margin);

}  // namespace palpate
