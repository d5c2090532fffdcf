// The feet of strokes over a cubic, in an order in which a probe can have gone there.
#pragma once

#include <span>

#include "core/recognition/given/placed/orthogonal_squares.h"
#include "core/recognition/given/placed/placed_curve.h"

namespace palpate {

/// Moves feet to other branches of a cubic where the nearest places are none that a stroke can have
/// gone along. Where two branches that meet in a cusp or in a sharp bend are no farther apart than
/// noise, the nearest feet of a stroke lie now on this one and now on that, and a bend laid over
/// the noise would explain it. But a probe goes from one branch to another only past the place
/// where they meet: from one sample to the next no foot moves farther along the curve than the
/// probe went. Of all ways the likeliest is taken, where it is negligibly probable that samples are
/// missing and the probe went farther between two of them: by the stated noise, and where none is
/// stated by that of the residuals.
///
/// Of a curve that is already fitted, is_touchable (fit/orthogonal/touchable.h) asks for one
/// direction between samples that noise does not put in another order; here each sample is given
/// its foot while the curve still moves, so that neighbours closer than noise must be told apart by
/// their way alone.
///
/// Round tips are left where they are: they go from branch to branch without coming to where these
/// meet. False if the shape is outside the class.
bool put_in_order(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points);

/// How often strokes break that rule with the feet that the curve has. The curve is in its class.
int jumps_of(const PlacedCurve<double>& placed, std::span<const WeighedPoint<double>> points);

}  // namespace palpate
