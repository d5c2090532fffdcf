// Checks on simulated probes whether a qualification finds the probe's errors and states its own
// accuracy correctly. Prints markdown.
#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "core/numerics/probability/chi_square.h"
#include "core/qualification/coherent_whitening.h"
#include "core/qualification/probed_recognition.h"
#include "core/qualification/qualify.h"
#include "tests/support/ellipse_bound.h"
#include "tests/support/probe_scene.h"
#include "tests/support/qualified_terms.h"

namespace palpate::bench {
namespace {

struct Count {
  int runs = 0;
  int within = 0;
  double squares = 0.0;
  double error = 0.0;
  double deviation = 0.0;
};

/// The part is touched in the set-up of the ring.
QualificationOptions in_one_setup() {
  QualificationOptions options;
  options.same_setup = true;
  return options;
}

void print_row(const std::string& scene_name, const test::ProbeScene& scene, int runs) {
  std::map<std::string, Count> counts;
  std::map<int, int> orders;
  std::map<std::string, int> verdicts;
  const auto start = std::chrono::steady_clock::now();
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 rng(static_cast<std::uint64_t>(run) + 1);
    const std::vector<ArtefactRecording> recordings = {test::simulate(scene, rng)};
    const Qualification result = qualify(scene.curve, recordings, in_one_setup());
    ++verdicts[std::string(name_of(result.status))];
    ++orders[result.probe.offset.order];
    for (const test::QualifiedTerm& term : test::qualified_terms(scene.probe, result.probe)) {
      Count& count = counts[term.name];
      ++count.runs;
      const bool exact = term.estimate.value == term.truth;
      count.within += exact || std::abs(term.deviations()) <= 2.5 ? 1 : 0;
      count.squares += exact ? 0.0 : term.deviations() * term.deviations();
      count.error += std::pow(term.estimate.value - term.truth, 2);
      count.deviation += term.estimate.deviation / runs;
    }
  }
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
  std::cout << "\n"
            << scene_name << ": " << runs << " runs, " << taken.count() / runs
            << " ms each; verdicts:";
  for (const auto& [verdict, count] : verdicts) std::cout << " " << count << " " << verdict;
  std::cout << "; highest harmonic:";
  for (const auto& [order, count] : orders) std::cout << " " << count << " x " << order;
  std::cout << "\n\n| term | within 2.5 deviations [%] | rms of error over deviation | rms error | "
               "mean deviation |\n|---|---|---|---|---|\n";
  for (const auto& [name, count] : counts) {
    std::cout << "| " << name << " | " << 100.0 * count.within / count.runs << " | "
              << std::sqrt(count.squares / count.runs) << " | "
              << std::sqrt(count.error / count.runs) << " | " << count.deviation << " |\n";
  }
}

/// The bound on the covariance of the axes for the part's strokes, from the derivatives of the
/// distances by shape and pose, the true noise, and the offset's covariance from the qualification.
Eigen::Matrix2d bound_of_axes(const test::ProbeScene& part, const ArtefactRecording& touched,
                              const Eigen::MatrixXd& offset_covariance) {
  const auto& ellipse = std::get<Ellipse>(part.curve);
  const Eigen::Index terms = offset_covariance.rows();
  std::vector<Vec2> points;
  std::vector<StrokePlaces> strokes;
  std::vector<double> arc_m;
  for (const ArtefactStroke& stroke : touched.strokes) {
    const auto begin = static_cast<Eigen::Index>(points.size());
    double arc = 0.0;
    for (std::size_t i = 0; i < stroke.samples.size(); ++i) {
      const Vec2& at = stroke.samples[i].position_m;
      if (i > 0) arc += (at - points.back()).norm();
      points.push_back(at);
      arc_m.push_back(arc);
    }
    strokes.push_back({begin, static_cast<Eigen::Index>(points.size())});
  }
  Eigen::MatrixXd white(static_cast<Eigen::Index>(points.size()), 5 + terms);
  white.leftCols<5>() = test::distance_slopes(ellipse, part.world_T_curve, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FootPoint foot = foot_point(part.curve, part.world_T_curve.to_local(points[i]));
    const double phi =
        geometry(part.curve, foot.t).tangent_angle + part.world_T_curve.theta - 0.5 * kPi;
    white.row(static_cast<Eigen::Index>(i)).tail(terms) =
        -offset_basis(phi, static_cast<int>(terms + 1) / 2);
  }
  const double sigma = part.probe.sigma_m.value;
  const std::vector<char> used(points.size(), 1);
  whiten({part.probe.deviation_m.value / sigma, part.probe.deviation_length_m.value}, strokes,
         arc_m, used, white);
  Eigen::MatrixXd information = white.transpose() * white / (sigma * sigma);
  information.bottomRightCorner(terms, terms) += offset_covariance.inverse();
  return information.inverse().topLeftCorner<2, 2>();
}

/// An answer's axes of an ellipse compared with the truth.
struct Axes {
  int runs = 0;
  int held = 0;
  double squares = 0.0;     ///< of the error [m^2]
  double bound = 0.0;       ///< of the same [m^2]
  double predicted = 0.0;   ///< by the covariance [m^2]
  double normalised = 0.0;  ///< error^T covariance^-1 error

  void add(const Recognition& answer, const Eigen::Vector2d& truth, const Eigen::Matrix2d& least) {
    if (answer.shape.curve_class != CurveClass::Ellipse) return;
    const Eigen::Vector2d error = answer.shape.values.head<2>() - truth;
    const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
    const double square = error.dot(covariance.inverse() * error);
    ++runs;
    held += square <= chi_square_threshold(0.05, 2) ? 1 : 0;
    squares += error.squaredNorm();
    bound += least.trace();
    predicted += covariance.trace();
    normalised += square;
  }

  void print(const std::string& name) const {
    std::cout << "| " << name << " | " << runs << " | " << std::sqrt(squares / runs) << " | "
              << std::sqrt(squares / bound) << " | " << std::sqrt(squares / predicted) << " | "
              << normalised / runs << " | " << 100.0 * held / runs << " |\n"
              << std::flush;
  }
};

/// How the probe is qualified before it is used, and how it is set up.
struct SetUps {
  std::string name;
  int recordings = 1;
  double between_m = 0.0;  ///< standard deviation of the constant between set-ups
  bool same = true;        ///< the part is touched in the set-up of the recording
};

/// Qualifies the probe on a ring, then measures an ellipse's arc with its file and without.
void print_applied(const test::ProbeScene& ring, const SetUps& setups, double arc_deg, int runs) {
  test::ProbeScene part = ring;
  part.curve = Ellipse{0.03, 0.022};
  part.start_t = 0.4;
  part.arc_t = arc_deg * kPi / 180.0;
  const Eigen::Vector2d truth(0.03, 0.022);
  QualificationOptions options;
  options.same_setup = setups.same;
  Axes with;
  Axes without;
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 rng(static_cast<std::uint64_t>(run) + 1);
    std::normal_distribution<double> normal;
    const auto simulated = [&](test::ProbeScene scene) {
      if (setups.between_m > 0.0) {
        scene.probe.offset.coefficients_m[0] += setups.between_m * normal(rng);
      }
      return test::simulate(scene, rng);
    };
    std::vector<ArtefactRecording> recordings;
    for (int i = 0; i < setups.recordings; ++i) recordings.push_back(simulated(ring));
    const Qualification qualification = qualify(ring.curve, recordings, options);
    const ArtefactRecording touched = simulated(part);
    Eigen::MatrixXd offset = qualification.probe.offset.covariance_m2;
    offset(0, 0) += setups.between_m * setups.between_m * (1.0 + 1.0 / setups.recordings);
    const Eigen::Matrix2d least = bound_of_axes(part, touched, offset);
    std::vector<ProbedPatch> patches;
    for (const ArtefactStroke& stroke : touched.strokes) {
      ProbedPatch& patch = patches.emplace_back();
      patch.context.patch = static_cast<std::uint32_t>(patches.size());
      patch.context.tip_radius_m = stroke.tip_radius_m;
      // Every other stroke runs backwards. Without a stated side a short arc may be taken for one
      // touched from inside.
      patch.context.material_side =
          patches.size() % 2 == 1 ? MaterialSide::Left : MaterialSide::Right;
      patch.samples = stroke.samples;
    }
    without.add(recognise_probed(patches, {}).recognition, truth, least);
    for (ProbedPatch& patch : patches) patch.probe = &qualification.probe;
    with.add(recognise_probed(patches, {}).recognition, truth, least);
  }
  const std::string arc = std::to_string(static_cast<int>(arc_deg)) + " deg, " + setups.name + ", ";
  with.print(arc + "with the file");
  without.print(arc + "without");
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  CLI::App app("Simulated qualifications beside what the probe really is, in markdown.");
  int runs = 500;
  app.add_option("--runs", runs, "Of each scene that a qualification is made of")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  int applied = 500;
  app.add_option("--applied", applied, "Of each part that is measured with a file; 0 = none")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::cout << std::setprecision(3);
  palpate::test::ProbeScene scene;
  scene.probe = palpate::test::lobed_probe();
  palpate::bench::print_row("Ring, two strokes both ways", scene, runs);
  palpate::test::ProbeScene ellipse = scene;
  ellipse.curve = palpate::Ellipse{0.03, 0.02};
  palpate::bench::print_row("Ellipse, two strokes both ways", ellipse, runs);
  palpate::test::ProbeScene one_way = scene;
  one_way.strokes = 1;
  one_way.samples = 600;
  palpate::bench::print_row("Ring, one stroke", one_way, runs);
  palpate::test::ProbeScene half = one_way;
  half.arc_t = 0.5 * 2.0 * palpate::kPi;
  palpate::bench::print_row("Half of the ring", half, runs);
  palpate::test::ProbeScene ideal = scene;
  ideal.probe = {};
  ideal.probe.sigma_m = {1e-5, 0.0};
  ideal.probe.deviation_length_m = {5e-3, 0.0};
  palpate::bench::print_row("Ring, an ideal probe with noise", ideal, runs);
  if (applied == 0) return 0;
  std::cout
      << "\nAn ellipse of 30 and 22 mm, stroked both ways by the first scene's probe, after its "
         "qualification on that ring: in the same set-up; in others whose constants differ by 20 "
         "um "
         "(standard deviation), after one recording and after five. The bound knows that "
         "deviation.\n\n"
         "| arc | ellipses | rms error of (a, b) [m] | over the bound | over what the covariance "
         "says | squared error over covariance (law: 2) | 95 % region holds the truth [%] |\n"
         "|---|---|---|---|---|---|---|\n";
  for (const palpate::bench::SetUps& setups :
       {palpate::bench::SetUps{"one set-up", 1, 0.0, true},
        palpate::bench::SetUps{"another set-up, one recording", 1, 2e-5, false},
        palpate::bench::SetUps{"another set-up, five recordings", 5, 2e-5, false}}) {
    for (const double arc : {120.0, 180.0, 360.0}) {
      palpate::bench::print_applied(scene, setups, arc, applied);
    }
  }
  return 0;
}
