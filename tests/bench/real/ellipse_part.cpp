#include "tests/bench/real/ellipse_part.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/support/scene_data.h"

namespace palpate::bench {
namespace {

constexpr int kArcs = 36;
constexpr int kArcDegrees[] = {60, 90, 120, 180};
/// Relative error of the worse axis beyond which even the right class counts as wrong.
constexpr double kWrongAxis = 0.1;

/// A contact and its polar angle about the part's centre, in [0, 2 pi).
struct Polar {
  double angle = 0.0;
  Vec2 point;
};

double turn(double angle) {
  const double rest = std::fmod(angle, 2.0 * kPi);
  return rest < 0.0 ? rest + 2.0 * kPi : rest;
}

/// Centre of the ellipse fitted to the whole recording.
Vec2 centre_of(const Recording& recording) {
  const Recognition whole = recognise(recording.context, recording.points);
  const Hypothesis* ellipse = test::hypothesis_of(whole, CurveClass::Ellipse);
  if (ellipse == nullptr || ellipse->at_limit) {
    throw std::runtime_error("the whole recording is no closed ellipse");
  }
  return ellipse->world_T_curve.translation();
}

/// The contacts within `width` from `start` on, by increasing angle.
std::vector<Vec2> arc(const std::vector<Polar>& contacts, double start, double width) {
  std::vector<Polar> inside;
  for (const Polar& contact : contacts) {
    const double from_start = turn(contact.angle - start);
    if (from_start < width) {
      inside.push_back({from_start, contact.point});
    }
  }
  std::stable_sort(inside.begin(), inside.end(),
                   [](const Polar& a, const Polar& b) { return a.angle < b.angle; });
  std::vector<Vec2> points;
  for (const Polar& contact : inside) {
    points.push_back(contact.point);
  }
  return points;
}

void write_arc(std::ostream& out, int degrees, int start, const std::vector<Vec2>& points) {
  for (const Vec2& point : points) {
    out << degrees << ',' << start << ',' << point.x() << ',' << point.y() << '\n';
  }
}

/// Relative error of the worse axis; infinite without a shape.
double worse_axis(const ShapeParameters& shape, const EllipsePart& part) {
  return std::max(std::abs(shape.values[0] / part.semi_major_m - 1.0),
                  std::abs(shape.values[1] / part.semi_minor_m - 1.0));
}

struct Counts {
  std::vector<double> errors;  ///< of the ellipse hypothesis, whether it won or not
  std::map<std::string, int> answers;
  int other_class = 0;             ///< RECOGNIZED
  int wrong_axis = 0;              ///< RECOGNIZED as an ellipse of another size
  std::vector<std::string> wrong;  ///< both kinds, one line each
};

void add(const std::string& arc, const Recognition& answer, const EllipsePart& part,
         Counts* counts) {
  const Hypothesis* ellipse = test::hypothesis_of(answer, CurveClass::Ellipse);
  counts->errors.push_back(ellipse == nullptr || ellipse->at_limit
                               ? std::numeric_limits<double>::infinity()
                               : worse_axis(ellipse->shape, part));
  const std::string curve_class(palpate::name_of(answer.shape.curve_class));
  ++counts->answers[std::string(name_of(answer.status)) + ' ' + curve_class];
  const bool is_ellipse = answer.shape.curve_class == CurveClass::Ellipse;
  if (answer.status != RecognitionStatus::Recognized ||
      (is_ellipse && worse_axis(answer.shape, part) <= kWrongAxis)) {
    return;
  }
  ++(is_ellipse ? counts->wrong_axis : counts->other_class);
  std::ostringstream line;
  line << std::setprecision(3) << arc << ": " << curve_class << " p "
       << answer.hypotheses.front().probability << ',';
  for (std::size_t i = 0; i < parameter_letters(answer.shape.curve_class).size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    line << ' ' << answer.shape.values[k] << " +- " << std::sqrt(answer.covariance(k, k));
  }
  if (is_ellipse) {
    line << ", the worse axis off by " << 100.0 * worse_axis(answer.shape, part) << " %";
  }
  line << ", sigma " << answer.sigma_m << " m, " << answer.outlier_count << " outliers";
  counts->wrong.push_back(line.str());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle
                                : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

std::string joined(const std::map<std::string, int>& answers) {
  std::ostringstream out;
  for (const auto& [answer, count] : answers) {
    out << (out.tellp() > 0 ? ", " : "") << count << ' ' << answer;
  }
  return out.str();
}

/// Rows of the table for that `form_deviation_m`; returns the wrong answers.
std::vector<std::string> print_rows(const EllipsePart& part, const PatchContext& context,
                                    const std::vector<Polar>& contacts, double form_deviation_m,
                                    std::ostream& out) {
  RecognizerOptions options;
  options.form_deviation_m = form_deviation_m;
  std::vector<std::string> wrong;
  for (const int degrees : kArcDegrees) {
    Counts counts;
    for (int i = 0; i < kArcs; ++i) {
      const int start = i * 360 / kArcs;
      const auto points = arc(contacts, start * kPi / 180.0, degrees * kPi / 180.0);
      std::ostringstream name;
      name << degrees << " deg from " << start << " deg, form deviation " << form_deviation_m
           << " m";
      add(name.str(), recognise(context, points, options), part, &counts);
    }
    out << "| " << form_deviation_m << " | " << degrees << " | " << std::setprecision(3)
        << 100.0 * median(counts.errors) << " | "
        << std::count(counts.errors.begin(), counts.errors.end(),
                      std::numeric_limits<double>::infinity())
        << " | " << joined(counts.answers) << " | " << counts.other_class << " | "
        << counts.wrong_axis << " |\n"
        << std::flush;
    wrong.insert(wrong.end(), counts.wrong.begin(), counts.wrong.end());
  }
  return wrong;
}

/// Single touches: random contacts in random order. Prints the wrong answers.
void print_touches(const EllipsePart& part, const std::vector<Polar>& contacts, std::ostream& out) {
  constexpr int kDraws = 36;
  out << "\nOf the same contacts, touched one at a time in no order, " << kDraws
      << " draws a row; no side told, no form deviation.\n\n"
      << "| touches | median error [%] | answers | RECOGNIZED, another class | RECOGNIZED, wrong "
         "axis |\n|---|---|---|---|---|\n";
  std::vector<std::string> wrong;
  for (const std::size_t touches : {8U, 12U, 20U, 40U, 80U, 200U}) {
    if (touches > contacts.size()) break;
    Counts counts;
    for (int i = 0; i < kDraws; ++i) {
      std::mt19937_64 rng(static_cast<std::uint64_t>(i));
      std::vector<Polar> drawn = contacts;
      std::shuffle(drawn.begin(), drawn.end(), rng);
      std::vector<Vec2> points;
      for (std::size_t k = 0; k < touches; ++k) points.push_back(drawn[k].point);
      add(std::to_string(touches) + " touches, draw " + std::to_string(i),
          recognise_touches(part.recording.context, points), part, &counts);
    }
    out << "| " << touches << " | " << std::setprecision(3) << 100.0 * median(counts.errors)
        << " | " << joined(counts.answers) << " | " << counts.other_class << " | "
        << counts.wrong_axis << " |\n";
    wrong.insert(wrong.end(), counts.wrong.begin(), counts.wrong.end());
  }
  out << "\nThe wrong ones (" << wrong.size() << "):\n";
  for (const std::string& line : wrong) out << "- " << line << '\n';
}

}  // namespace

void print_ellipse_part(const EllipsePart& part,
                        const std::optional<std::filesystem::path>& arcs_csv, std::ostream& out) {
  std::ofstream arcs;
  if (arcs_csv) {
    arcs.open(*arcs_csv);
    arcs << std::setprecision(std::numeric_limits<double>::max_digits10)
         << "arc_deg,start_deg,x_m,y_m\n";
  }
  const Vec2 centre = centre_of(part.recording);
  PatchContext context = part.recording.context;
  // By increasing angle one travels around the part with the material on the left.
  context.material_side = part.side_known ? MaterialSide::Left : MaterialSide::Unspecified;
  std::vector<Polar> contacts;
  for (const Vec2& point : part.recording.points) {
    const Vec2 away = point - centre;
    contacts.push_back({turn(std::atan2(away.y(), away.x())), point});
  }
  out << "Ellipse of " << part.semi_major_m << " and " << part.semi_minor_m << " m, "
      << contacts.size() << " contacts, tip radius " << part.recording.context.tip_radius_m
      << " m, side " << (part.side_known ? "known" : "not known") << "; " << kArcs
      << " arcs a row. Form deviation: what the recognizer is told of the part's making. The error "
         "is the worse axis's of the ellipse hypothesis, whether it won or "
         "not. Wrong: RECOGNIZED as another class, or with an axis off by more than "
      << 100.0 * kWrongAxis << " %.\n\n"
      << "| form deviation [m] | arc [deg] | median error [%] | no ellipse | answers | RECOGNIZED, "
         "another class | RECOGNIZED, wrong axis |\n|---|---|---|---|---|---|---|\n";
  std::vector<std::string> wrong = print_rows(part, context, contacts, 0.0, out);
  if (part.form_deviation_m > 0.0) {
    const auto more = print_rows(part, context, contacts, part.form_deviation_m, out);
    wrong.insert(wrong.end(), more.begin(), more.end());
  }
  out << "\nThe wrong ones (" << wrong.size() << "), by polar angle of the arc's start:\n";
  for (const std::string& line : wrong) {
    out << "- " << line << '\n';
  }
  print_touches(part, contacts, out);
  if (arcs_csv) {
    for (const int degrees : kArcDegrees) {
      for (int i = 0; i < kArcs; ++i) {
        const int start = i * 360 / kArcs;
        write_arc(arcs, degrees, start, arc(contacts, start * kPi / 180.0, degrees * kPi / 180.0));
      }
    }
  }
  if (arcs_csv && !arcs.flush()) {
    throw std::runtime_error("cannot write " + arcs_csv->string());
  }
}

}  // namespace palpate::bench
