#include "node/tool/text/recognition_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include "node/files/printable.h"
#include "node/files/quantity.h"
#include "node/tool/text/report.h"

namespace palpate {
namespace {

/// Unit of a shape parameter; nullptr = a length.
const char* unit_of(v1::CurveClass curve_class, char letter) {
  switch (curve_class) {
    case v1::CURVE_CLASS_CUBICAL_PARABOLA:
      return letter == 'a' ? "1/m^2" : "";
    case v1::CURVE_CLASS_SEMI_CUBICAL_PARABOLA:
      return letter == 'a' ? "1/sqrt(m)" : "";
    case v1::CURVE_CLASS_CUBIC_SPLINE:
      return letter == 'a' ? "1/sqrt(m)" : letter == 'b' ? "" : "sqrt(m)";
    default:
      return nullptr;
  }
}

struct Named {
  char letter;
  double value;
};

std::vector<Named> parameters_of(const v1::Parameters& parameters) {
  std::vector<Named> named;
  if (parameters.has_a()) named.push_back({'a', parameters.a()});
  if (parameters.has_b()) named.push_back({'b', parameters.b()});
  if (parameters.has_c()) named.push_back({'c', parameters.c()});
  return named;
}

/// Standard deviation of entry i of [those of a, b, c that the class has; x; y; theta].
double sigma_of(const v1::Recognition& answer, std::size_t i) {
  const auto count = static_cast<std::size_t>(answer.covariance_size());
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count))));
  if (n * n != count) return std::numeric_limits<double>::infinity();  // not a square matrix
  if (i >= n) return 0.0;
  return std::sqrt(std::max(answer.covariance(static_cast<int>(i * n + i)), 0.0));
}

std::string parameter_text(const v1::Recognition& answer, const Named& named, std::size_t i) {
  const double sigma = sigma_of(answer, i);
  const char* unit = unit_of(answer.curve_class(), named.letter);
  if (unit != nullptr) {
    return with_sigma(named.value, sigma) + (*unit != '\0' ? " " : "") + unit;
  }
  const LengthUnit length = length_unit_for(std::abs(named.value));
  return with_sigma(named.value * length.per_m, sigma * length.per_m) + " " +
         std::string(length.name);
}

void add_line(std::string& text, const char* label, const std::string& value) {
  char start[32];
  std::snprintf(start, sizeof start, "  %-12s ", label);
  text += start + value + "\n";
}

void add_hypotheses(const v1::Recognition& answer, bool noise_is_known, std::string& text) {
  if (answer.hypotheses().empty()) return;
  constexpr double kWorthShowing = 1e-9;
  if (noise_is_known) {
    add_row(text, "  %-24s %12s %14s %6s  %s\n", "hypothesis", "probability", "chi2", "dof",
            "shape");
  } else {
    add_row(text, "  %-24s %12s  %s\n", "hypothesis", "probability", "shape");
  }
  for (const v1::Hypothesis& hypothesis : answer.hypotheses()) {
    if (hypothesis.probability() < kWorthShowing) {
      continue;
    }
    std::string shape;
    for (const Named& named : parameters_of(hypothesis.parameters())) {
      shape +=
          (shape.empty() ? "" : ", ") + std::string(1, named.letter) + " = " + number(named.value);
    }
    if (hypothesis.at_limit()) {
      shape = "none: best where it turns into another class";
    }
    const std::string name = spoken_name(hypothesis.curve_class());
    if (noise_is_known) {
      add_row(text, "    %-22s %12.4g %14.6g %6u  %s\n", name.c_str(), hypothesis.probability(),
              hypothesis.chi2(), hypothesis.dof(), shape.c_str());
    } else {
      add_row(text, "    %-22s %12.4g  %s\n", name.c_str(), hypothesis.probability(),
              shape.c_str());
    }
  }
}

void add_contacts(const v1::Recognition& answer, std::string& text) {
  if (answer.contacts().empty()) {
    return;
  }
  add_row(text, "  %-16s %5s %11s %11s %9s %11s %22s %26s\n", "contact", "patch", "t", "x [m]",
          "y [m]", "tangent [deg]", "kappa [1/m]", "kappa_s [1/m^2]");
  for (const v1::LocalizedContact& contact : answer.contacts()) {
    add_row(text, "    %-14s %5u %11.5g %11.6f %9.6f %11.2f %22s %26s\n",
            printable(contact.probe()).c_str(), contact.patch(), contact.t(), contact.x_m(),
            contact.y_m(), contact.tangent_rad() * kDegrees,
            with_sigma(contact.kappa_per_m(), contact.kappa_sigma_per_m()).c_str(),
            with_sigma(contact.kappa_s_per_m2(), contact.kappa_s_sigma_per_m2()).c_str());
  }
}

void add_decisions(const v1::Recognition& answer, std::string& text) {
  if (answer.decisions().empty()) {
    return;
  }
  text += "  recognition tree\n";
  for (const v1::Decision& decision : answer.decisions()) {
    const std::string chance = decision.has_p_value() ? ", p = " + number(decision.p_value()) : "";
    add_row(text, "    %-34s %12.5g against %-12.5g %s%s\n", printable(decision.test()).c_str(),
            decision.value(), decision.threshold(), decision.passed() ? "passed" : "failed",
            chance.c_str());
  }
}

/// Without a standard deviation if the tree used a plain tolerance.
std::string value_text(const v1::Invariant& invariant) {
  return std::isfinite(invariant.sigma()) ? with_sigma(invariant.value(), invariant.sigma())
                                          : number(invariant.value());
}

void add_invariants(const v1::Recognition& answer, std::string& text) {
  if (answer.invariants().empty()) {
    return;
  }
  text += "  invariants, in powers of metres\n";
  for (const v1::Invariant& invariant : answer.invariants()) {
    add_row(text, "    %-6s of %-24s %s\n", printable(invariant.name()).c_str(),
            spoken_name(invariant.curve_class()).c_str(), value_text(invariant).c_str());
  }
}

}  // namespace

std::vector<Quantity> quantities_of(const v1::Recognition& answer) {
  std::vector<Quantity> quantities;
  for (const Named& named : parameters_of(answer.parameters())) {
    const std::size_t i = quantities.size();
    quantities.push_back({std::string(1, named.letter), named.value, sigma_of(answer, i),
                          parameter_text(answer, named, i)});
  }
  if (!answer.has_pose()) return quantities;
  const std::size_t x = quantities.size();
  const v1::Pose2& pose = answer.pose();
  // One unit for both coordinates, chosen by the distance of the pose from the world's origin.
  const LengthUnit unit = length_unit_for(std::max(
      {std::abs(pose.x_m()), std::abs(pose.y_m()), sigma_of(answer, x), sigma_of(answer, x + 1)}));
  // Of a line that lies along x or y, rounding alone is left of the other one's deviation.
  constexpr double kRounding = 1e-6;
  const bool is_line = answer.curve_class() == v1::CURVE_CLASS_LINE;
  const double least =
      is_line ? kRounding * std::hypot(sigma_of(answer, x), sigma_of(answer, x + 1)) : 0.0;
  const auto add_length = [&](const char* name, double value) {
    const double sigma = sigma_of(answer, quantities.size());
    const double told = sigma > least ? sigma : 0.0;
    quantities.push_back(
        {name, value, sigma,
         with_sigma(value * unit.per_m, told * unit.per_m) + " " + std::string(unit.name)});
  };
  add_length("x", pose.x_m());
  add_length("y", pose.y_m());
  const double sigma = sigma_of(answer, x + 2);
  std::string theta = with_sigma(pose.theta_rad() * kDegrees, sigma * kDegrees) + " deg";
  if (answer.pose_symmetry() == 2) {
    theta += " (or that + 180)";
  } else if (answer.curve_class() == v1::CURVE_CLASS_CIRCLE) {
    theta = "free";
  } else if (is_line) {
    theta += "; free along itself";
  }
  quantities.push_back({"theta", pose.theta_rad(), sigma, theta});
  return quantities;
}

bool is_of_no_class_alone(const v1::Recognition& answer) {
  return answer.curve_class() == v1::CURVE_CLASS_UNCLASSIFIED &&
         std::all_of(answer.hypotheses().begin(), answer.hypotheses().end(),
                     [](const v1::Hypothesis& hypothesis) {
                       return hypothesis.curve_class() == v1::CURVE_CLASS_UNCLASSIFIED ||
                              hypothesis.probability() < kWorthNaming;
                     });
}

std::string status_text(const v1::Recognition& answer) {
  switch (answer.status()) {
    case v1::RECOGNITION_STATUS_COLLECTING:
      return "collecting: too few samples yet";
    case v1::RECOGNITION_STATUS_RECOGNIZED:
      return "recognized";
    case v1::RECOGNITION_STATUS_AMBIGUOUS:
      if (answer.doubt() == v1::RECOGNITION_DOUBT_SEVERAL_CLASSES && is_of_no_class_alone(answer)) {
        return "ambiguous: most probably of no class, but one is not excluded";
      }
      return "ambiguous: " + std::string(sentence_of(answer.doubt()));
    default:
      return "unknown status";
  }
}

std::string_view sentence_of(v1::RecognitionDoubt doubt) {
  switch (doubt) {
    case v1::RECOGNITION_DOUBT_SEVERAL_CLASSES:
      return "several classes remain plausible";
    case v1::RECOGNITION_DOUBT_AT_LIMIT:
      return "the class fits best where it turns into another";
    case v1::RECOGNITION_DOUBT_FORM_ERROR:
      return "residuals are correlated along the arc (form error, or another class)";
    case v1::RECOGNITION_DOUBT_MISFIT:
      return "residuals are larger than the noise can be";
    case v1::RECOGNITION_DOUBT_TWO_SHAPES:
      return "two shapes fit alike (a curve and its twin, or tips on either side)";
    case v1::RECOGNITION_DOUBT_RICHER_CLASS:
      return "the samples do not exclude a class of which this one is a limit";
    case v1::RECOGNITION_DOUBT_UNDETERMINED:
      return "the shape is not determined";
    case v1::RECOGNITION_DOUBT_TREE_REJECTS:
      return "the recognition tree rejects the class that all samples together are";
    case v1::RECOGNITION_DOUBT_FEW_PLACES:
      return "touched at so few places that they may fit by chance";
    case v1::RECOGNITION_DOUBT_WORK_LIMIT:
      return "the work that an answer may take was spent before all was looked at";
    default:
      return "no reason given";
  }
}

std::string spoken_name(v1::CurveClass curve_class) {
  switch (curve_class) {
    case v1::CURVE_CLASS_UNCLASSIFIED:
      return "unclassified";
    case v1::CURVE_CLASS_LINE:
      return "line";
    case v1::CURVE_CLASS_CIRCLE:
      return "circle";
    case v1::CURVE_CLASS_ELLIPSE:
      return "ellipse";
    case v1::CURVE_CLASS_PARABOLA:
      return "parabola";
    case v1::CURVE_CLASS_HYPERBOLA:
      return "hyperbola";
    case v1::CURVE_CLASS_CUBICAL_PARABOLA:
      return "cubical parabola";
    case v1::CURVE_CLASS_SEMI_CUBICAL_PARABOLA:
      return "semi-cubical parabola";
    case v1::CURVE_CLASS_CUBIC_SPLINE:
      return "cubic spline";
    default:
      return "nothing yet";
  }
}

std::string noise_text(const v1::Recognition& answer) {
  return answer.sigma_m() == 0.0 ? "not known yet" : text_of_length(answer.sigma_m());
}

std::string summary_text(const v1::Recognition& answer) {
  std::string text = spoken_name(answer.curve_class()) + " (" + status_text(answer) + ")";
  for (const Quantity& quantity : quantities_of(answer)) {
    text += ", " + quantity.name + " " + quantity.text;
  }
  return text;
}

std::string invariants_text(const v1::Recognition& answer) {
  std::string text;
  std::optional<v1::CurveClass> of;
  for (const v1::Invariant& invariant : answer.invariants()) {
    if (of != invariant.curve_class()) {
      of = invariant.curve_class();
      text += (text.empty() ? "" : "; ") + spoken_name(*of) + " ";
    } else {
      text += ", ";
    }
    text += printable(invariant.name()) + " " + value_text(invariant);
  }
  return text;
}

namespace {

/// What the uncertainties would be if the probe erred by noise alone.
std::string text_of_unqualified(v1::Recognition answer) {
  std::string text = "not qualified: what it may hide is in the uncertainties";
  answer.mutable_covariance()->Swap(answer.mutable_noise_covariance());
  const std::vector<Quantity> by_noise = quantities_of(answer);
  const std::size_t parameters = parameters_of(answer.parameters()).size();
  for (std::size_t i = 0; i < std::min(parameters, by_noise.size()); ++i) {
    const std::string& quantity = by_noise[i].text;
    const std::size_t sigma = quantity.find("+-");
    if (sigma == std::string::npos) continue;
    text += (i == 0 ? "; by noise alone " : ", ") + by_noise[i].name + " " + quantity.substr(sigma);
  }
  return text;
}

}  // namespace

std::string report_text(const v1::Recognition& answer) { return report_text(answer, true); }

std::string report_text(const v1::Recognition& answer, bool noise_is_known) {
  std::string text = "group " + printable(answer.group()) + ", object " +
                     std::to_string(answer.object()) + ": " + spoken_name(answer.curve_class()) +
                     "\n";
  add_line(text, "status", status_text(answer));
  std::string pose;
  for (const Quantity& quantity : quantities_of(answer)) {
    if (quantity.name.size() == 1 && quantity.name[0] <= 'c') {
      add_line(text, quantity.name.c_str(), quantity.text);
    } else {
      pose += (pose.empty() ? "" : ", ") + quantity.name + " " + quantity.text;
    }
  }
  if (!pose.empty()) add_line(text, "pose", pose);
  std::string noise = noise_text(answer);
  if (answer.sigma_m() != 0.0) {
    noise = "sigma " + noise + (noise_is_known ? "" : ", estimated from the samples");
  }
  if (answer.noise_correlation_m() > 0.0) {
    noise += ", correlated over " + number(answer.noise_correlation_m() * 1e3) + " mm of arc";
  }
  add_line(text, "noise", noise);
  std::string samples = std::to_string(answer.sample_count());
  if (answer.outlier_count() > 0) {
    samples += ", of which " + std::to_string(answer.outlier_count()) + " set aside as spikes";
  }
  if (answer.dwelling_count() > 0) {
    samples += "; " + std::to_string(answer.dwelling_count()) +
               " repeat a place where the probe stood still";
  }
  if (answer.forgotten_count() > 0) {
    samples += "; " + std::to_string(answer.forgotten_count()) + " older ones forgotten";
  }
  if (answer.simplified_count() > 0) {
    samples += "; " + std::to_string(answer.simplified_count()) +
               " said more (normal, covariance) than a search uses";
  }
  add_line(text, "samples", samples);
  if (answer.unqualified_probe()) add_line(text, "probe", text_of_unqualified(answer));
  for (const std::string& file : answer.probe_files())
    add_line(text, "probe file", printable(file));
  add_line(text, "time", number(1e-6 * static_cast<double>(answer.compute_ns())) + " ms");
  add_hypotheses(answer, noise_is_known, text);
  add_contacts(answer, text);
  add_decisions(answer, text);
  add_invariants(answer, text);
  return text;
}

}  // namespace palpate
