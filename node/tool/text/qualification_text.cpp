#include <algorithm>
#include <cmath>
#include <string>

#include "node/files/counted.h"
#include "node/files/quantity.h"
#include "node/tool/qualification_answer.h"

namespace palpate {
namespace {

std::string length_text(double value_m, double deviation_m) {
  const LengthUnit unit = length_unit_for(std::max(std::abs(value_m), deviation_m));
  return with_sigma(value_m * unit.per_m, deviation_m * unit.per_m) + " " + std::string(unit.name);
}

void add_line(std::string& text, const std::string& name, const std::string& value) {
  text += "  " + name + std::string(name.size() < 16 ? 16 - name.size() : 1, ' ') + value + "\n";
}

std::string degrees(double angle) { return std::to_string(std::lround(angle * kDegrees)) + " deg"; }

/// A size with its deviation. If the deviation is larger than the size: an upper bound, two
/// deviations above it.
std::string size_text(const Estimate& size) {
  if (size.value > size.deviation) return length_text(size.value, size.deviation);
  const double most = size.value + 2.0 * size.deviation;
  const LengthUnit unit = length_unit_for(most);
  return "at most " + number(most * unit.per_m) + " " + std::string(unit.name) + ", if any";
}

}  // namespace

std::string why_not(QualificationStatus status) {
  switch (status) {
    case QualificationStatus::NotFinite:
      return "a coordinate or tip radius is no finite number";
    case QualificationStatus::BadArtefact:
      return "a line has one normal only: its place and the probe's offset are the same";
    case QualificationStatus::TooFewSamples:
      return "fewer than 12 samples of the artefact in one of the recordings";
    case QualificationStatus::NotTheArtefact:
      return "the artefact cannot be laid on the samples: is it the right one, and its unit?";
    case QualificationStatus::SeveralTips:
      return "the samples state different tip radii: a probe has one tip, and is qualified alone "
             "(--tip-radius gives one to samples that state none)";
    default:
      return "";
  }
}

std::string qualification_text(const Qualification& qualification,
                               const QualificationOrigin& origin) {
  const ProbeCharacter& probe = qualification.probe;
  const NormalOffset& offset = probe.offset;
  std::string text = "qualified on " + origin.artefact + (qualification.bore ? ", a bore" : "") +
                     ": " + std::string(name_of(qualification.status)) + "\n";
  const auto deviation = [&](Eigen::Index i) { return std::sqrt(offset.covariance_m2(i, i)); };
  if (!qualification.tip_is_estimated) {
    add_line(text, "offset",
             length_text(offset.coefficients_m[0], deviation(0)) + " out of the material");
  }
  if (probe.setup_m.value > 0.0) {
    add_line(text, "set-ups",
             "another's offset differs by " +
                 length_text(probe.setup_m.value, probe.setup_m.deviation) +
                 (qualification.poses.size() > 1
                      ? std::string()
                      : std::string(", a guess: several recordings tell it")));
  }
  if (probe.tip_radius_m > 0.0) {
    add_line(text, "tip radius",
             length_text(probe.tip_radius_m + offset.coefficients_m[0], deviation(0)) +
                 (qualification.tip_is_estimated
                      ? std::string(", estimated: the samples state none; an error of the "
                                    "artefact's size is in it")
                      : ", nominal " + length_text(probe.tip_radius_m, 0.0)));
  }
  for (int order = 2; order <= offset.order; ++order) {
    const Eigen::Index i = 2 * order - 3;
    add_line(text, std::to_string(order) + " lobes",
             "cos " + length_text(offset.coefficients_m[i], deviation(i)) + ", sin " +
                 length_text(offset.coefficients_m[i + 1], deviation(i + 1)));
  }
  if (offset.order == 0) add_line(text, "lobes", "none that the samples ask for");
  add_line(text, "noise", length_text(probe.sigma_m.value, probe.sigma_m.deviation));
  add_line(text, "drift", size_text(probe.deviation_m));
  if (probe.deviation_m.value > probe.deviation_m.deviation) {
    add_line(text, "over",
             length_text(probe.deviation_length_m.value, probe.deviation_length_m.deviation) +
                 " of a stroke");
  }
  add_line(
      text, "spikes",
      with_sigma(100.0 * probe.spike_probability.value, 100.0 * probe.spike_probability.deviation) +
          " % of the samples");
  add_line(text, "lag",
           probe.lag_m ? length_text(probe.lag_m->value, probe.lag_m->deviation)
           : qualification.both_directions
               ? std::string("not told: no lobes show it")
               : std::string("not told: stroke the artefact both ways"));
  add_line(text, "samples",
           std::to_string(qualification.samples.size()) + " in " +
               counted(qualification.poses.size(), "recording"));
  for (const auto& [from, to] : qualification.untouched) {
    add_line(
        text, "not touched",
        "normals from " + degrees(from) + " to " + degrees(to) + ": the offset there is a guess");
  }
  add_line(
      text, "not told",
      "one lobe, an offset as the cosine of the normal's direction: it is a shift of the frame");
  if (qualification.rather_another_size) {
    add_line(
        text, "verdict",
        "the offset is more than a tenth of the tip radius: rather the artefact or the tip has "
        "another size than stated; usual tips differ by a fifth from size to size");
  } else if (qualification.status == QualificationStatus::Insufficient) {
    add_line(text, "verdict",
             "the offset is open by " + length_text(qualification.worst_offset_deviation_m, 0.0) +
                 ", more than a sample's noise: touch more of the artefact, more often, or in "
                 "several directions of it");
  }
  return text;
}

}  // namespace palpate
