// Whether a qualification finds what the probe does, and says how well: simulated, in markdown.
#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/numerics/chi_square.h"
#include "core/qualification/probe_correction.h"
#include "core/qualification/qualify.h"
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

void print_row(const std::string& scene_name, const test::ProbeScene& scene, int runs) {
  std::map<std::string, Count> counts;
  std::map<int, int> orders;
  std::map<std::string, int> verdicts;
  const auto start = std::chrono::steady_clock::now();
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 rng(static_cast<std::uint64_t>(run) + 1);
    const std::vector<ArtefactRecording> recordings = {test::simulate(scene, rng)};
    const Qualification result = qualify(scene.curve, recordings);
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

/// What an answer says of an ellipse's axes beside the truth.
struct Axes {
  int runs = 0;
  int held = 0;
  double squares = 0.0;     ///< of the error [m^2]
  double predicted = 0.0;   ///< by the covariance [m^2]
  double normalised = 0.0;  ///< error^T covariance^-1 error

  void add(const Recognition& answer, const Eigen::Vector2d& truth) {
    if (answer.shape.curve_class != CurveClass::Ellipse) return;
    const Eigen::Vector2d error = answer.shape.values.head<2>() - truth;
    const Eigen::Matrix2d covariance = answer.covariance.topLeftCorner<2, 2>();
    const double square = error.dot(covariance.inverse() * error);
    ++runs;
    held += square <= chi_square_threshold(0.05, 2) ? 1 : 0;
    squares += error.squaredNorm();
    predicted += covariance.trace();
    normalised += square;
  }

  void print(const std::string& name) const {
    std::cout << "| " << name << " | " << runs << " | " << std::sqrt(squares / runs) << " | "
              << std::sqrt(squares / predicted) << " | " << normalised / runs << " | "
              << 100.0 * held / runs << " |\n"
              << std::flush;
  }
};

/// The probe qualified on a ring, then an ellipse's arc measured with its file, and without.
void print_applied(const test::ProbeScene& ring, double arc_deg, int runs) {
  test::ProbeScene part = ring;
  part.curve = Ellipse{0.03, 0.022};
  part.start_t = 0.4;
  part.arc_t = arc_deg * kPi / 180.0;
  const Eigen::Vector2d truth(0.03, 0.022);
  Axes with;
  Axes without;
  for (int run = 0; run < runs; ++run) {
    std::mt19937_64 rng(static_cast<std::uint64_t>(run) + 1);
    const std::vector<ArtefactRecording> recordings = {test::simulate(ring, rng)};
    const Qualification qualification = qualify(ring.curve, recordings);
    std::vector<ProbedPatch> patches;
    for (const ArtefactStroke& stroke : test::simulate(part, rng).strokes) {
      ProbedPatch& patch = patches.emplace_back();
      patch.context.patch = static_cast<std::uint32_t>(patches.size());
      patch.context.tip_radius_m = stroke.tip_radius_m;
      // Every other stroke runs back. Without the side a short arc may be taken for touched from
      // within.
      patch.context.material_side =
          patches.size() % 2 == 1 ? MaterialSide::Left : MaterialSide::Right;
      patch.samples = stroke.samples;
    }
    without.add(recognise_probed(patches, {}).recognition, truth);
    for (ProbedPatch& patch : patches) patch.probe = &qualification.probe;
    with.add(recognise_probed(patches, {}).recognition, truth);
  }
  const std::string arc = std::to_string(static_cast<int>(arc_deg)) + " deg, ";
  with.print(arc + "with the file");
  without.print(arc + "without");
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  CLI::App app("Simulated qualifications beside what the probe really is, in markdown.");
  int runs = 500;
  app.add_option("--runs", runs, "Of each scene")
      ->check(CLI::PositiveNumber)
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
  std::cout
      << "\nAn ellipse of 30 and 22 mm, stroked both ways by the first scene's probe, after its "
         "qualification on that ring.\n\n"
         "| arc | ellipses | rms error of (a, b) [m] | over what the covariance says | squared "
         "error over covariance (law: 2) | 95 % region holds the truth [%] |\n"
         "|---|---|---|---|---|---|\n";
  for (const double arc : {120.0, 180.0, 360.0}) palpate::bench::print_applied(scene, arc, runs);
  return 0;
}
