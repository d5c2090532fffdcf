#include "node/tool/text/advice.h"

#include <cmath>
#include <vector>

#include "node/files/quantity.h"
#include "node/tool/text/recognition_text.h"

namespace palpate {
namespace {

std::string percent(double fraction) { return with_digits(100.0 * fraction, 3) + " %"; }

std::string with_article(v1::CurveClass curve_class) {
  const std::string name = spoken_name(curve_class);
  return (name.front() == 'e' ? "an " : "a ") + name;
}

/// The most probable class other than the answer's.
v1::CurveClass rival_of(const v1::Recognition& answer) {
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    if (hypothesis.curve_class() != answer.curve_class()) return hypothesis.curve_class();
  }
  return v1::CURVE_CLASS_UNSPECIFIED;
}

/// Few data may have a class of an unusual shape, which is improbable beforehand.
std::string not_excluded(const v1::Recognition& answer) {
  const v1::CurveClass rival = rival_of(answer);
  return "Most probably of no class, but the samples do not exclude " +
         (rival == v1::CURVE_CLASS_UNSPECIFIED ? std::string("one") : with_article(rival)) +
         " of a shape that is improbable beforehand: touch more of the part.";
}

std::string several_classes(const v1::Recognition& answer) {
  constexpr int kMostNamed = 3;
  std::string names;
  int named = 0;
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    if (hypothesis.probability() < kWorthNaming || named++ == kMostNamed) break;
    names += (names.empty() ? "" : ", ") + spoken_name(hypothesis.curve_class()) + " " +
             percent(hypothesis.probability());
  }
  return "Several classes remain plausible: " + names +
         ". Touch further round, where their curves part.";
}

std::string undetermined(const v1::Recognition& answer) {
  const Quantity* loosest = nullptr;
  double worst = 0.0;
  const std::vector<Quantity> quantities = quantities_of(answer);
  for (const Quantity& quantity : quantities) {
    if (quantity.name.size() > 1 || quantity.name[0] > 'c') continue;
    const double relative = quantity.sigma / std::abs(quantity.value);
    if (relative > worst) {
      worst = relative;
      loosest = &quantity;
    }
  }
  std::string text = "The touched arc does not determine the shape: touch further round";
  if (loosest != nullptr && std::isfinite(worst)) {
    const std::string known =
        worst < 1.0 ? " is known to " + percent(worst) + " only" : " is not known";
    text += " (" + loosest->name + known + ")";
  }
  return text + ".";
}

std::string form_error(const std::string& name, const Stated& stated) {
  const std::string text =
      "What the samples leave beside the " + name +
      " follows a pattern along the arc: the part deviates from its ideal curve";
  if (stated.form_deviation_m > 0.0) {
    return text + " by more than the stated form_deviation_m of " +
           text_of_length(stated.form_deviation_m) + ", or is of a class not known here.";
  }
  return text +
         ", or is of a class not known here. Tell the recognizer the part's tolerance "
         "(form_deviation_m).";
}

std::string two_shapes(const v1::Recognition& answer, const Stated& stated) {
  if (stated.tip_sides) return "Two shapes fit alike: touch another place.";
  // It has no bend to be outside or inside of.
  if (answer.curve_class() == v1::CURVE_CLASS_LINE) {
    return "Two lines fit alike, one on either side of the round tips: tell the material side of a "
           "stroke.";
  }
  return std::string("Two shapes fit alike: touch another place, or tell ") +
         (stated.touched_from
              ? "the material side of a stroke."
              : "where round tips touch (touched_from, or the material side of a stroke).");
}

std::string work_limit(const Stated& stated) {
  std::string text =
      "The samples are too hard to look at in full within the work that an answer may take: check "
      "that all patches lie on one curve";
  if (!stated.noise && !stated.tip_sides) return text + ", and state noise, tip and material side.";
  if (!stated.noise) return text + ", and state the noise.";
  return text + (stated.tip_sides ? "." : ", and state the material side of every stroke.");
}

std::string ambiguous(const v1::Recognition& answer, const Stated& stated) {
  const std::string name = spoken_name(answer.curve_class());
  switch (answer.doubt()) {
    case v1::RECOGNITION_DOUBT_SEVERAL_CLASSES:
      return is_of_no_class_alone(answer) ? not_excluded(answer) : several_classes(answer);
    case v1::RECOGNITION_DOUBT_AT_LIMIT:
      return "The " + name + " fits best where it turns into another class: touch further round.";
    case v1::RECOGNITION_DOUBT_FORM_ERROR:
      return form_error(name, stated);
    case v1::RECOGNITION_DOUBT_MISFIT:
      return "The samples lie further from " +
             (answer.curve_class() == v1::CURVE_CLASS_UNCLASSIFIED ? std::string("any smooth path")
                                                                   : "the " + name) +
             " than their noise can put them. Check sigma_m and tip_radius_m of the probes, and "
             "that "
             "all patches lie on one curve.";
    case v1::RECOGNITION_DOUBT_TWO_SHAPES:
      return two_shapes(answer, stated);
    case v1::RECOGNITION_DOUBT_RICHER_CLASS: {
      const v1::CurveClass richer = rival_of(answer);
      return "The samples do not exclude " +
             (richer == v1::CURVE_CLASS_UNSPECIFIED ? std::string("a richer class")
                                                    : with_article(richer)) +
             ": touch further round, or more often where the part is touched all round.";
    }
    case v1::RECOGNITION_DOUBT_UNDETERMINED:
      return undetermined(answer);
    case v1::RECOGNITION_DOUBT_TREE_REJECTS:
      return "The samples together are " + with_article(answer.curve_class()) +
             ", but the local estimates along them are not: stroke on, and look at the contacts "
             "and "
             "the recognition tree's path where it stays so.";
    case v1::RECOGNITION_DOUBT_FEW_PLACES:
      return std::string("So few touches fit by chance: touch it at eight places") +
             (stated.noise ? "." : ", or state their noise.");
    case v1::RECOGNITION_DOUBT_WORK_LIMIT:
      return work_limit(stated);
    default:
      return "Not certain yet: touch further round.";
  }
}

/// The best class of a part that is of none, and how far it is from that.
std::string nearest(const v1::Recognition& answer, const Stated& stated) {
  double of_noise = 0.0;
  const v1::Hypothesis* best = nullptr;
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    if (hypothesis.curve_class() == v1::CURVE_CLASS_UNCLASSIFIED) {
      of_noise = hypothesis.chi2();
    } else if (best == nullptr && hypothesis.has_parameters()) {
      best = &hypothesis;
    }
  }
  if (best == nullptr || best->dof() <= 0 || !(best->chi2() > of_noise)) return "";
  const double deviation_m =
      answer.sigma_m() * std::sqrt((best->chi2() - of_noise) / static_cast<double>(best->dof()));
  const LengthUnit unit = length_unit_for(deviation_m);
  return " The nearest is " + with_article(best->curve_class()) + ", from which it deviates by " +
         with_digits(deviation_m * unit.per_m, 2) + " " + std::string(unit.name) +
         " (root mean square, beyond the noise). Is that within the part's tolerance, or within "
         "what the probe deviates by, state " +
         (stated.form_deviation_m > 0.0
              ? "more than " + text_of_length(stated.form_deviation_m) + " (form_deviation_m)."
              : "it (form_deviation_m).");
}

}  // namespace

std::string advice_text(const v1::Recognition& answer, const Stated& stated) {
  switch (answer.status()) {
    case v1::RECOGNITION_STATUS_COLLECTING:
      return "Too few places yet, as far as noise tells them apart (samples: " +
             std::to_string(answer.sample_count()) + "): touch more of the part.";
    case v1::RECOGNITION_STATUS_RECOGNIZED:
      return answer.curve_class() == v1::CURVE_CLASS_UNCLASSIFIED
                 ? "None of the known classes explains the samples: the part has another shape, "
                   "the "
                   "patches lie on several pieces of it, or a stroke leaves it (through the air, "
                   "over an edge)." +
                       nearest(answer, stated)
                 : "The part is " + with_article(answer.curve_class()) +
                       ": its shape and place are known. No further touch is needed.";
    case v1::RECOGNITION_STATUS_AMBIGUOUS:
      return ambiguous(answer, stated);
    default:
      return "Nothing is known yet: touch the part.";
  }
}

}  // namespace palpate
