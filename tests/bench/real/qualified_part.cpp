#include "tests/bench/real/qualified_part.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "core/qualification/probed_recognition.h"
#include "core/qualification/qualify.h"
#include "tests/bench/real/simulated_part.h"
#include "tests/support/ellipse_bound.h"
#include "tests/support/scene_data.h"

namespace palpate::bench {
namespace {

constexpr int kStarts = 72;
/// Relative error of the worse axis beyond which even the right class counts as wrong, if the 95 %
/// region does not contain the truth either.
constexpr double kAxisBeyondUse = 0.1;

std::vector<ContactSample> samples_of(const std::vector<Vec2>& points) {
  std::vector<ContactSample> samples;
  for (const Vec2& point : points) samples.push_back({point, 0.0, 0});
  return samples;
}

struct Row {
  std::vector<double> errors;
  int recognised = 0;
  int recognised_held = 0;
  int ellipses = 0;
  int ellipses_held = 0;
  std::vector<std::string> wrong;  ///< RECOGNIZED, one line each
};

std::string line_of(const Recognition& answer) {
  std::ostringstream line;
  line << std::setprecision(4) << palpate::name_of(answer.shape.curve_class) << " p "
       << answer.hypotheses.front().probability << ',';
  for (std::size_t i = 0; i < parameter_letters(answer.shape.curve_class).size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    line << ' ' << answer.shape.values[k] << " +- " << std::sqrt(answer.covariance(k, k));
  }
  line << ", sigma " << answer.sigma_m << " m, " << answer.outlier_count << " of "
       << answer.sample_count << " outliers";
  return line.str();
}

void add(const std::string& arc, const Recognition& answer, const EllipsePart& part, Row* row) {
  const Hypothesis* ellipse = test::hypothesis_of(answer, CurveClass::Ellipse);
  const Eigen::Vector2d truth(part.semi_major_m, part.semi_minor_m);
  double worst = std::numeric_limits<double>::infinity();
  if (ellipse != nullptr && !ellipse->at_limit) {
    const Eigen::Vector2d off = ellipse->shape.values.head<2>() - truth;
    worst = off.cwiseQuotient(truth).cwiseAbs().maxCoeff();
  }
  row->errors.push_back(worst);
  const bool recognised = answer.status == RecognitionStatus::Recognized;
  const bool is_ellipse = answer.shape.curve_class == CurveClass::Ellipse;
  if (recognised && !is_ellipse) row->wrong.push_back(arc + line_of(answer));
  if (!is_ellipse || ellipse == nullptr || ellipse->at_limit) return;
  const Eigen::Vector2d off = answer.shape.values.head<2>() - truth;
  const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
  const bool held = off.dot(covariance.inverse() * off) <= chi_square_threshold(0.05, 2);
  if (recognised && worst > kAxisBeyondUse && !held) row->wrong.push_back(arc + line_of(answer));
  ++row->ellipses;
  row->ellipses_held += held ? 1 : 0;
  row->recognised += recognised ? 1 : 0;
  row->recognised_held += recognised && held ? 1 : 0;
}

double middle_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string share(int part, int whole) {
  return whole == 0 ? "-"
                    : std::to_string(static_cast<int>(std::lround(100.0 * part / whole))) +
                          " % of " + std::to_string(whole);
}

/// The constant of a recording relative to its known shape, and its lobe along an axis, with their
/// variances for white noise of the samples' scatter. The lobes between an ellipse's axes cannot be
/// distinguished from its rotation.
struct KnownTerms {
  Eigen::VectorXd value_m;
  Eigen::VectorXd variance_m2;
};

KnownTerms terms_of(const Qualification& result, double axis_angle) {
  constexpr Eigen::Index kTold = 2;
  constexpr int kLobes = 2;
  const int count = offset_coefficients(kLobes);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count + 2, count + 2);  // plus the place's x and y
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count + 2);
  double squares = 0.0;
  int used = 0;
  for (const QualifiedSample& sample : result.samples) {
    if (sample.spike) continue;
    Eigen::VectorXd row(count + 2);
    row << offset_basis(sample.normal_angle - axis_angle, kLobes).transpose(),
        std::cos(sample.normal_angle), std::sin(sample.normal_angle);
    normal += row * row.transpose();
    right += sample.distance_m * row;
    squares += sample.distance_m * sample.distance_m;
    ++used;
  }
  const Eigen::MatrixXd inverse = normal.inverse();
  const Eigen::VectorXd value = inverse * right;
  const double variance = (squares - value.dot(right)) / (used - count - 2);
  return {value.head(kTold), variance * inverse.diagonal().head(kTold)};
}

/// What a file from the ring cannot contain: how much the same probe's errors differ on the part.
void print_reproducibility(const Qualification& on_ring, const Qualification& on_part,
                           std::ostream& out) {
  const double axis_angle = on_part.poses.front().theta;
  const KnownTerms first = terms_of(on_ring, axis_angle);
  const KnownTerms second = terms_of(on_part, axis_angle);
  out << "\n| beside its known shape | constant [um] | lobe along the part's axes [um] "
         "|\n|---|---|---|\n";
  const auto print = [&](const char* name, const KnownTerms& terms) {
    out << "| " << name;
    for (Eigen::Index i = 0; i < terms.value_m.size(); ++i) {
      out << " | " << 1e6 * terms.value_m[i] << " +- " << 1e6 * std::sqrt(terms.variance_m2[i]);
    }
    out << " |\n";
  };
  print("ring", first);
  print("part", second);
  print("part less ring",
        {second.value_m - first.value_m, Eigen::VectorXd(first.variance_m2 + second.variance_m2)});
}

/// Errors of the worse axis that normal errors with the bound's covariance would have for white
/// noise alone: no unbiased estimate from these contacts has smaller ones.
void add_bound(const std::vector<Vec2>& points, double sigma_m, const Pose2& pose,
               const EllipsePart& part, std::mt19937_64& rng, std::vector<double>* errors) {
  const Eigen::MatrixXd slopes =
      test::distance_slopes(Ellipse{part.semi_major_m, part.semi_minor_m}, pose, points);
  const Eigen::MatrixXd covariance = sigma_m * sigma_m * (slopes.transpose() * slopes).inverse();
  const Eigen::Matrix2d root = covariance.topLeftCorner<2, 2>().llt().matrixL();
  std::normal_distribution<double> normal;
  constexpr int kDraws = 200;
  for (int i = 0; i < kDraws; ++i) {
    const double first = normal(rng);
    const Eigen::Vector2d off = root * Eigen::Vector2d(first, normal(rng));
    errors->push_back(
        std::max(std::abs(off[0]) / part.semi_major_m, std::abs(off[1]) / part.semi_minor_m));
  }
}

/// What palpate knows about the probe: the default, or that it errs by noise alone, or its file.
enum class Told { Nothing, NoiseAlone, File };
constexpr Told kAllTold[] = {Told::Nothing, Told::NoiseAlone, Told::File};

std::string name_of(Told told) {
  return told == Told::Nothing      ? "nothing"
         : told == Told::NoiseAlone ? "that it errs by noise alone"
                                    : "its file";
}

RecognizerOptions options_of(Told told) {
  RecognizerOptions options;
  if (told == Told::NoiseAlone) options.unqualified_probe = false;
  options.touched_from = TouchedFrom::Outside;  // a pusher pushes
  return options;
}

/// The points within `degrees` as seen from `centre`, in order, from start `i` of kStarts.
std::vector<Vec2> arc_of(const std::vector<Vec2>& all, const Vec2& centre, int degrees, int i) {
  const double start = 2.0 * kPi * i / kStarts;
  std::vector<std::pair<double, Vec2>> inside;
  for (const Vec2& point : all) {
    const Vec2 away = point - centre;
    const double from = std::fmod(std::atan2(away.y(), away.x()) - start + 4.0 * kPi, 2.0 * kPi);
    if (from < degrees * kPi / 180.0) inside.emplace_back(from, point);
  }
  std::stable_sort(inside.begin(), inside.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vec2> points;
  for (const auto& [from, point] : inside) points.push_back(point);
  return points;
}

/// Arcs of the ring itself: how many are RECOGNIZED as a circle, and how many as something else.
void print_ring(const Ring& ring, std::ostream& out) {
  const Recording& whole = ring.recording;
  const Recognition centred = recognise(whole.context, whole.points, options_of(Told::Nothing));
  out << "\n| arc of the ring [deg] | told of the probe | RECOGNIZED as a circle | as anything "
         "else "
         "| AMBIGUOUS |\n|---|---|---|---|---|\n";
  for (const int degrees : {60, 90, 120, 180, 270, 360}) {
    for (const Told told : {Told::Nothing, Told::NoiseAlone}) {
      int circles = 0;
      int others = 0;
      for (int i = 0; i < kStarts; ++i) {
        const Recognition answer = recognise(
            whole.context, arc_of(whole.points, centred.world_T_curve.translation(), degrees, i),
            options_of(told));
        const bool sure = answer.status == RecognitionStatus::Recognized;
        const bool circle = answer.shape.curve_class == CurveClass::Circle;
        circles += sure && circle ? 1 : 0;
        others += sure && !circle ? 1 : 0;
      }
      out << "| " << degrees << " | " << name_of(told) << " | " << circles << " | " << others
          << " | " << kStarts - circles - others << " |\n"
          << std::flush;
    }
  }
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

/// What a 95 % region is to leave out: the same arcs of recordings whose errors are drawn from the
/// probe's file, the answers told that file. Arcs of one recording share their contacts with their
/// neighbours, so that wrong ones come in groups: hence the deviation from recording to recording.
void print_simulated(const Recording& whole, const Vec2& centre, const Qualification& on_part,
                     const ProbeCharacter& probe, const EllipsePart& part, int recordings,
                     std::ostream& out) {
  out << "\n"
      << recordings
      << " simulated recordings of the same contacts, as the file says:\n\n| arc [deg] | ellipses "
         "RECOGNIZED | of these the 95 % region leaves out | RECOGNIZED and wrong | recordings "
         "without a wrong one |\n|---|---|---|---|---|\n";
  for (const int degrees : {60, 90, 120, 180}) {
    std::mt19937_64 rng(2);
    std::vector<double> recognised;
    std::vector<double> missed;
    std::vector<double> wrong;
    int clean = 0;
    for (int k = 0; k < recordings; ++k) {
      const std::vector<Vec2> contacts = simulated(whole.points, on_part, probe, rng);
      Row row;
      for (int i = 0; i < kStarts; ++i) {
        const ProbedPatch patch{whole.context, samples_of(arc_of(contacts, centre, degrees, i)),
                                &probe};
        add("", recognise_probed({&patch, 1}, options_of(Told::File)).recognition, part, &row);
      }
      recognised.push_back(row.recognised);
      missed.push_back(row.recognised - row.recognised_held);
      wrong.push_back(static_cast<double>(row.wrong.size()));
      clean += row.wrong.empty() ? 1 : 0;
    }
    const auto print = [&](const std::vector<double>& counts) {
      out << " | " << mean_of(counts) << " (a recording's deviation " << deviation_of(counts)
          << ')';
    };
    out << "| " << degrees;
    print(recognised);
    print(missed);
    print(wrong);
    out << " | " << clean << " |\n" << std::flush;
  }
}

}  // namespace

void print_qualified_part(const Ring& ring, const EllipsePart& part, int simulations,
                          std::ostream& out) {
  ArtefactRecording recording;
  recording.strokes.push_back(
      {samples_of(ring.recording.points), ring.recording.context.tip_radius_m});
  const Qualification result = qualify(Circle{ring.radius_m}, {{recording}});
  const ProbeCharacter& probe = result.probe;
  const auto um = [](const Estimate& e) {
    return std::to_string(1e6 * e.value) + " +- " + std::to_string(1e6 * e.deviation) + " um";
  };
  out << "Ring of radius " << ring.radius_m << " m, " << result.samples.size()
      << " contacts: " << name_of(result.status) << "; noise " << um(probe.sigma_m)
      << ", coherent deviation " << um(probe.deviation_m) << " of length "
      << um(probe.deviation_length_m) << ", spikes " << probe.spike_probability.value << " +- "
      << probe.spike_probability.deviation << ". Offset, constant and harmonics from 2 on:";
  for (Eigen::Index i = 0; i < probe.offset.coefficients_m.size(); ++i) {
    out << (i > 0 ? ", " : " ")
        << um({probe.offset.coefficients_m[i], std::sqrt(probe.offset.covariance_m2(i, i))});
  }
  out << "; in another set-up the constant differs by " << um(probe.setup_m)
      << ". Probability of no harmonic, of harmonic 2, to 3, ...:";
  for (const double p : result.order_probabilities) out << ' ' << p;
  out << ".\n\n"
      << "| arc [deg] | told of the probe | median error of the worse axis [%] | by the bound | 95 "
         "% "
         "region "
         "holds the truth, RECOGNIZED | the same, every ellipse | RECOGNIZED and wrong |\n"
      << "|---|---|---|---|---|---|---|\n";
  const Recording& whole = part.recording;
  ArtefactRecording round_the_part;
  round_the_part.strokes.push_back({samples_of(whole.points), ring.recording.context.tip_radius_m});
  const Qualification on_part =
      qualify(Ellipse{part.semi_major_m, part.semi_minor_m}, {{round_the_part}});
  if (on_part.poses.empty()) throw std::runtime_error("the part is not that ellipse");
  const auto answer_to = [&](const std::vector<Vec2>& points, Told told) {
    if (told != Told::File) return recognise(whole.context, points, options_of(told));
    const ProbedPatch patch{whole.context, samples_of(points), &probe};
    return recognise_probed({&patch, 1}, options_of(told)).recognition;
  };
  const Recognition centred = recognise(whole.context, whole.points);
  const Vec2 centre = centred.world_T_curve.translation();
  std::vector<std::string> wrong;
  for (const int degrees : {60, 90, 120, 180}) {
    for (const Told told : kAllTold) {
      Row row;
      std::vector<double> by_bound;
      std::mt19937_64 rng(1);
      for (int i = 0; i < kStarts; ++i) {
        const std::vector<Vec2> points = arc_of(whole.points, centre, degrees, i);
        const std::string arc = std::to_string(degrees) + " deg from " +
                                std::to_string(i * 360 / kStarts) + " deg, " + name_of(told) + ": ";
        add(arc, answer_to(points, told), part, &row);
        add_bound(points, probe.sigma_m.value, on_part.poses.front(), part, rng, &by_bound);
      }
      out << "| " << degrees << " | " << name_of(told) << " | " << 100.0 * middle_of(row.errors)
          << " | " << 100.0 * middle_of(std::move(by_bound)) << " | "
          << share(row.recognised_held, row.recognised) << " | "
          << share(row.ellipses_held, row.ellipses) << " | " << row.wrong.size() << " |\n"
          << std::flush;
      wrong.insert(wrong.end(), row.wrong.begin(), row.wrong.end());
    }
  }
  out << "\nThe wrong ones (" << wrong.size() << "):\n";
  for (const std::string& line : wrong) out << "- " << line << '\n';
  out << "\n| full turn | a - truth [um] | b - truth [um] |\n|---|---|---|\n";
  for (const Told told : kAllTold) {
    const Recognition answer = answer_to(whole.points, told);
    out << "| " << name_of(told) << " | " << 1e6 * (answer.shape.values[0] - part.semi_major_m)
        << " +- " << 1e6 * std::sqrt(answer.covariance(0, 0)) << " | "
        << 1e6 * (answer.shape.values[1] - part.semi_minor_m) << " +- "
        << 1e6 * std::sqrt(answer.covariance(1, 1)) << " |\n";
  }
  if (simulations > 1) {
    print_simulated(whole, centre, on_part, probe, part, simulations, out);
  }
  print_reproducibility(result, on_part, out);
  print_ring(ring, out);
}

}  // namespace palpate::bench
