#include "node/tool/drawing/enlarged_residuals.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Every step-th sample.
ContactRun thinned(const ContactRun& run, std::size_t step) {
  ContactRun kept{run.context, {}};
  for (std::size_t i = 0; i < run.samples.size(); i += step) kept.samples.push_back(run.samples[i]);
  return kept;
}

}  // namespace

double round_gain(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= value) return factor * power;
  }
  return power;
}

EnlargedResiduals enlarged_residuals(const CurveModel& model, const ContactGroup& group,
                                     double sigma_m, double size_m, std::size_t most_lines,
                                     std::span<const Vec2> set_aside) {
  constexpr std::size_t kFarPerLine = 10;
  std::size_t count = 0;
  for (const ContactRun& run : group.runs) count += run.samples.size();
  const std::size_t step = count / (kFarPerLine * most_lines) + 1;
  const std::size_t line_step = count / step / most_lines + 1;
  std::vector<SampleResidual> kept;
  EnlargedResiduals result;
  result.set_aside.assign(set_aside.begin(), set_aside.end());
  std::size_t index = 0;
  double squares = 0.0;
  for (const ContactRun& run : group.runs) {
    const ContactRun fewer = step > 1 ? thinned(run, step) : ContactRun();
    const ContactRun& used = step > 1 ? fewer : run;
    const std::vector<SampleResidual> residuals = residuals_of(model, used, sigma_m);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      if (residuals[i].is_far) {
        const ContactSample& sample = used.samples[i];
        const double near_m = kFarSigmas * (sample.sigma_m > 0.0 ? sample.sigma_m : sigma_m);
        const bool counts = std::none_of(
            set_aside.begin(), set_aside.end(),
            [&](const Vec2& spike) { return (spike - sample.position_m).norm() <= near_m; });
        if (counts) result.far.push_back(sample.position_m);
      } else if (index++ % line_step == 0) {
        kept.push_back(residuals[i]);
        squares += residuals[i].residual_m * residuals[i].residual_m;
      }
    }
  }
  if (kept.empty()) return result;
  // The root mean square becomes a hundredth of the picture: lines of 10 to 30 pixels in 1000.
  constexpr double kShownFraction = 0.01;
  const double typical = std::sqrt(squares / static_cast<double>(kept.size()));
  result.gain = std::max(round_gain(kShownFraction * size_m / typical), 1.0);
  for (const SampleResidual& residual : kept) {
    const Vec2 foot = model.world_position(residual.t);
    result.lines.push_back(
        {foot, foot + result.gain * residual.residual_m * model.world_left(residual.t)});
  }
  return result;
}

}  // namespace palpate
