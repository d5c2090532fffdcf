#include "tests/bench/real/mirrors.h"

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/local/estimator.h"
#include "core/local/stream/sliding_window.h"
#include "tests/bench/real/design_on_profile.h"
#include "tests/bench/real/recording.h"
#include "tests/support/scene_data.h"

namespace palpate::bench {
namespace {

struct Mirror {
  Curve design;
  double t_pole = 0.0;  ///< of the design, where the central ray of the beam meets it
};

double number(const google::protobuf::Struct& fields, const std::string& name) {
  const auto field = fields.fields().find(name);
  if (field == fields.fields().end() || !field->second.has_number_value()) {
    throw std::runtime_error("design.json: no number " + name);
  }
  return field->second.number_value();
}

/// y^2 = 2 P x, seen from its focus at distance r: a = P / 2 and r = a (1 + t^2).
Mirror parabolic(const google::protobuf::Struct& fields) {
  constexpr double kMillimetre = 1e-3;
  const double a = 0.5 * number(fields, "P_mm") * kMillimetre;
  const double r = number(fields, "r_mm") * kMillimetre;
  return {Parabola{a}, std::sqrt(r / a - 1.0)};
}

/// Foci at distances p and q from the pole, with rays at the grazing angle theta there: x = (p - q)
/// / (2 e) with e = sqrt(1 - b^2 / a^2).
Mirror elliptic(const google::protobuf::Struct& fields) {
  const double p = number(fields, "p");
  const double q = number(fields, "q");
  const double a = 0.5 * (p + q);
  const double b = std::sqrt(p * q) * std::sin(number(fields, "theta"));
  const double focus = std::sqrt((a - b) * (a + b));
  return {Ellipse{a, b}, std::acos(0.5 * (p - q) / focus)};
}

std::map<std::string, Mirror> read_designs(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  google::protobuf::Struct json;
  if (!in || !google::protobuf::util::JsonStringToMessage(text.str(), &json).ok()) {
    throw std::runtime_error("cannot read " + path.string());
  }
  std::map<std::string, Mirror> mirrors;
  for (const auto& [name, value] : json.fields()) {
    const google::protobuf::Struct& fields = value.struct_value();
    const bool is_parabola = fields.fields().contains("shape");
    mirrors.emplace(name, is_parabola ? parabolic(fields) : elliptic(fields));
  }
  return mirrors;
}

std::string text(double value, int digits = 4) {
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

std::string with_deviation(double value, double variance) {
  return text(value, 5) + " +- " + text(std::sqrt(variance), 2);
}

/// "a +- sd | b +- sd" of the ellipse, whether it won or not.
std::string ellipse_cells(const Recognition& answer) {
  const Hypothesis* ellipse = test::hypothesis_of(answer, CurveClass::Ellipse);
  if (ellipse == nullptr) {
    return "not fitted | not fitted";
  }
  if (ellipse->at_limit) {
    return "at limit | at limit";
  }
  return with_deviation(ellipse->shape.values[0], ellipse->covariance(0, 0)) + " | " +
         with_deviation(ellipse->shape.values[1], ellipse->covariance(1, 1));
}

/// The estimate along the profile that is nearest to `place`.
std::optional<LocalEstimate> sliding_window_at(const std::vector<Vec2>& points, const Vec2& place) {
  SlidingWindow window;
  std::optional<LocalEstimate> nearest;
  for (const Vec2& point : points) {
    const auto found = window.add(point);
    if (found && found->result &&
        (!nearest ||
         (found->result.estimate.position - place).norm() < (nearest->position - place).norm())) {
      nearest = found->result.estimate;
    }
  }
  return nearest;
}

using NamedEstimate = std::pair<std::string, LocalEstimate>;

std::vector<NamedEstimate> middle_estimates(const Recording& recording, const Recognition& answer) {
  EstimatorOptions whole;
  whole.window = static_cast<int>(recording.points.size());
  whole.jet_degree = 5;
  std::vector<NamedEstimate> estimates = {
      {"jet, degree 5, whole profile", estimate_window(recording.points, whole).estimate}};
  const Vec2 middle = recording.points[recording.points.size() / 2];
  if (const auto sliding = sliding_window_at(recording.points, middle)) {
    estimates.emplace_back("sliding window", *sliding);
  }
  const auto nearest = std::min_element(answer.contacts.begin(), answer.contacts.end(),
                                        [&](const LocalizedContact& a, const LocalizedContact& b) {
                                          return (a.estimate.position - middle).norm() <
                                                 (b.estimate.position - middle).norm();
                                        });
  if (nearest != answer.contacts.end()) {
    estimates.emplace_back("contact", nearest->estimate);
  }
  return estimates;
}

void print_local(const std::string& title, const LocalEstimate& here, const LocalGeometry& design,
                 double figure_error_m, std::ostream& out) {
  out << "| " << title << " | " << with_deviation(here.kappa, here.covariance(2, 2)) << " | "
      << text(design.kappa, 5) << " | " << text(here.kappa / design.kappa - 1.0, 2) << " | "
      << with_deviation(here.kappa_s, here.covariance(3, 3)) << " | " << text(design.kappa_s, 5)
      << " | " << text(here.kappa_s / design.kappa_s - 1.0, 2) << " | " << text(figure_error_m, 2)
      << " |\n";
}

}  // namespace

void print_mirrors(const std::filesystem::path& folder, std::ostream& out) {
  std::ostringstream local;
  out << "What palpate says, and its ellipse whether it won or not, beside the design [m]. The "
         "deviations are standard ones.\n\n"
      << "| mirror | length | status | doubt | class | a | b | design a | design b | correlation "
         "length "
         "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, mirror] : read_designs(folder / "design.json")) {
    const Recording recording = read_recording(folder / (name + ".csv"));
    const Recognition answer = recognise(recording.context, recording.points);
    const Eigen::Vector3d design = parameters(mirror.design);
    const bool is_ellipse = class_of(mirror.design) == CurveClass::Ellipse;
    out << "| " << name << " | "
        << text((recording.points.back() - recording.points.front()).norm()) << " | "
        << name_of(answer.status) << " | " << palpate::name_of(answer.doubt) << " | "
        << palpate::name_of(answer.shape.curve_class) << " | " << ellipse_cells(answer) << " | "
        << text(design[0], 6) << (is_ellipse ? "" : " (parabola)") << " | "
        << (is_ellipse ? text(design[1], 5) : "") << " | " << text(answer.noise_correlation_m)
        << " |\n";

    const auto laid = lay_on(mirror.design, mirror.t_pole, recording.points);
    if (!laid) {
      throw std::runtime_error(name + ": the design cannot be laid on the profile");
    }
    for (const auto& [estimator, estimate] : middle_estimates(recording, answer)) {
      print_local(name + " | " + estimator, estimate,
                  design_at(mirror.design, *laid, estimate.position), laid->residual_rms_m, local);
    }
  }
  out << "\nCurvature [1/m] and its derivative by arc length [1/m^2] about the profile's middle, "
         "beside those of the design there, laid on the profile by least squares of its pose; "
         "figure error: what that leaves, rms [m]. The contact is the published one nearest to the "
         "middle.\n\n"
         "| mirror | estimator | kappa | design | relative | kappa_s | design | relative | figure "
         "error |\n|---|---|---|---|---|---|---|---|---|\n"
      << local.str();
}

}  // namespace palpate::bench
