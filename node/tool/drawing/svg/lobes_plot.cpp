#include "node/tool/drawing/svg/lobes_plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "node/files/quantity.h"
#include "node/tool/drawing/svg/colours.h"
#include "node/tool/drawing/svg/svg_table.h"
#include "node/tool/drawing/svg/ticks.h"

namespace palpate {
namespace {

constexpr double kRound = 480.0;   // side of the polar picture's square [px]
constexpr double kCircle = 130.0;  // radius of the circle of the mean offset [px]
constexpr double kReach = 85.0;    // of the sample that lies farthest off that circle [px]
constexpr double kStrip = 500.0;   // width of the strip of residuals [px]
constexpr const char* kSpikeColour = "#c2185b";

/// A point of the polar picture.
std::string polar(double angle, double lobe_px) {
  const double radius = kCircle + lobe_px;
  return formatted("%.1f,%.1f ", 0.5 * kRound + radius * std::cos(angle),
                   0.5 * kRound - radius * std::sin(angle));
}

/// The offset less its mean, which may be many times the lobes.
double lobe_at(const NormalOffset& offset, double normal_angle) {
  return offset_at(offset, normal_angle) - offset.coefficients_m[0];
}

/// The lobes plus `deviations` standard deviations, all around.
std::string ring(const NormalOffset& offset, double deviations, double px_per_m) {
  std::string points;
  constexpr int kSteps = 360;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = 2.0 * kPi * i / kSteps;
    points += polar(
        phi, px_per_m * (lobe_at(offset, phi) + deviations * offset_deviation_at(offset, phi)));
  }
  return points;
}

/// Of each sample, what is left of its distance without the mean offset and that of its set-up. [m]
std::vector<double> sampled_lobes(const Qualification& qualification) {
  std::vector<double> lobes;
  for (const QualifiedSample& sample : qualification.samples) {
    lobes.push_back(lobe_at(qualification.probe.offset, sample.normal_angle) + sample.residual_m);
  }
  return lobes;
}

/// Largest size of all samples' values except spikes'. [m]
double largest(const Qualification& qualification, const std::vector<double>& values) {
  double most = 1e-12;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!qualification.samples[i].spike) most = std::max(most, std::abs(values[i]));
  }
  return most;
}

/// A length with its name, at the lower left of the polar picture.
std::string scale_bar(double reach_m, double px_per_m) {
  constexpr double kLeft = 12.0;
  constexpr double kBottom = kRound - 40.0;
  const double length_m = tick_step(reach_m, 2.0);
  const double right = kLeft + px_per_m * length_m;
  return formatted("<path d=\"M%.1f,%.1f v8 m0,-4 H%.1f m0,-4 v8\" fill=\"none\" stroke=\"%s\"/>\n",
                   kLeft, kBottom - 8.0, right, kCurveColour) +
         formatted("<text x=\"%.1f\" y=\"%.1f\">%s</text>\n", right + 6.0, kBottom,
                   text_of_length(length_m).c_str());
}

/// "mean offset beyond the tip radius of 2 mm: -30.0 +- 1.2 um"
std::string mean_text(const Qualification& qualification) {
  const ProbeCharacter& probe = qualification.probe;
  const bool is_stated = probe.tip_radius_m > 0.0 && !qualification.tip_is_estimated;
  const double mean_m = probe.offset.coefficients_m[0] + (is_stated ? 0.0 : probe.tip_radius_m);
  const double deviation_m = std::sqrt(probe.offset.covariance_m2(0, 0));
  const LengthUnit unit = length_unit_for(std::max(std::abs(mean_m), deviation_m));
  const std::string beyond = is_stated
                                 ? "beyond the tip radius of " + text_of_length(probe.tip_radius_m)
                                 : "with no tip radius stated";
  return "mean offset " + beyond + ": " +
         with_sigma(unit.per_m * mean_m, unit.per_m * deviation_m) + " " + std::string(unit.name);
}

}  // namespace

std::string lobes_plot(const Qualification& qualification, const std::string& title) {
  constexpr std::size_t kMostDrawn = 4000;
  const std::size_t step = qualification.samples.size() / kMostDrawn + 1;
  const NormalOffset& offset = qualification.probe.offset;
  const std::vector<double> lobes = sampled_lobes(qualification);
  const double reach_m = largest(qualification, lobes);
  const double px_per_m = kReach / reach_m;
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" "
      "fill=\"#fff\"/>\n",
      kRound + kStrip + 60.0, kRound + 60.0);
  svg += "<text x=\"12\" y=\"20\" font-size=\"14\">" +
         escaped(end_within(title, kRound + kStrip + 36.0, 14.0)) + "</text>\n";
  svg += "<g transform=\"translate(0 30)\">\n";
  svg += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"none\" stroke=\"#bbb\"/>\n",
                   0.5 * kRound, 0.5 * kRound, kCircle);
  // 95 % of a normal distribution.
  constexpr double kBand = 1.96;
  svg += "<path fill=\"" + std::string(kBandColour) +
         "\" fill-opacity=\"0.25\" fill-rule=\"evenodd\" d=\"M" + ring(offset, kBand, px_per_m) +
         "Z M" + ring(offset, -kBand, px_per_m) + "Z\"/>\n";
  for (std::size_t i = 0; i < qualification.samples.size(); i += step) {
    const QualifiedSample& sample = qualification.samples[i];
    const double px = std::clamp(px_per_m * lobes[i], -kReach, kReach);
    const std::string place = polar(sample.normal_angle, px);
    const std::size_t comma = place.find(',');
    svg += "<circle cx=\"" + place.substr(0, comma) + "\" cy=\"" +
           place.substr(comma + 1, place.size() - comma - 2) + "\" r=\"1.5\" fill=\"" +
           (sample.spike ? kSpikeColour : kPatchColours[0]) + "\"/>\n";
  }
  svg += "<polygon fill=\"none\" stroke=\"" + std::string(kCurveColour) +
         "\" stroke-width=\"1.5\" points=\"" + ring(offset, 0.0, px_per_m) + "\"/>\n";
  svg += scale_bar(reach_m, px_per_m);
  SvgTable words(12.0, kRound - 20.0, kRound);
  words.words(mean_text(qualification) + " (grey circle)");
  words.words("lobes: the offset less its mean, by the normal's direction");
  svg += words.svg() + "</g>\n";

  // Residuals over the direction.
  std::vector<double> residuals;
  for (const QualifiedSample& sample : qualification.samples)
    residuals.push_back(sample.residual_m);
  const double most_m = largest(qualification, residuals);
  const LengthUnit small = length_unit_for(most_m);
  const double left = kRound + 40.0;
  const double middle = 30.0 + 0.5 * kRound;
  const double half = 0.4 * kRound;
  svg += formatted("<line x1=\"%.0f\" y1=\"%.1f\" x2=\"%.0f\" y2=\"%.1f\" stroke=\"#bbb\"/>\n",
                   left, middle, left + kStrip, middle);
  for (int tick = -180; tick <= 180; tick += 90) {
    const double x = left + kStrip * (tick + 180.0) / 360.0;
    svg += formatted("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#eee\"/>\n", x,
                     middle - half, x, middle + half);
    svg += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%d</text>\n", x,
                     middle + half + 16.0, tick);
  }
  for (std::size_t i = 0; i < qualification.samples.size(); i += step) {
    const QualifiedSample& sample = qualification.samples[i];
    const double x = left + kStrip * (wrap_angle(sample.normal_angle) + kPi) / (2.0 * kPi);
    const double y = middle - half * std::clamp(sample.residual_m / most_m, -1.0, 1.0);
    svg += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.5\" fill=\"%s\"/>\n", x, y,
                     sample.spike ? kSpikeColour : kPatchColours[0]);
  }
  SvgTable caption(left, middle + half + 36.0, kStrip);
  caption.words(formatted("residuals within %.3g ", most_m * small.per_m) +
                std::string(small.name) + ", over the normal's direction [deg]; red: spikes" +
                (step > 1 ? "; not all samples are drawn" : ""));
  return svg + caption.svg() + "</svg>\n";
}

}  // namespace palpate
