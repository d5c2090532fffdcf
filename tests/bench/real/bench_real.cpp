// Results on real recordings, printed as markdown.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/real/ellipse_part.h"
#include "tests/bench/real/local_coverage.h"
#include "tests/bench/real/mirrors.h"
#include "tests/bench/real/qualified_part.h"

namespace {

constexpr const char* kAbout =
    R"(Figures on real recordings, in markdown.

  bench_real
      the X-ray mirrors of tests/data/real/dabam beside their design
  bench_real --ellipse-part FILE --semi-axes 0.065445,0.0525 --tip-radius 0.00475
      the sliding window along a closed elliptic part, and arcs of it; FILE is in palpate's CSV format: a header line
      "probe,patch,x_m,y_m", then one patch of contacts all around the part, in order.
      The axes and radius above are those of part "ellip2" and its pusher in the public data set
      "More than a Million Ways to Be Pushed" (K.-T. Yu, M. Bauza, N. Fazeli, A. Rodriguez, IROS 2016;
      MIT MCube Lab): contacts of a robot's cylindrical pusher, whose centres in the part's
      frame are x_m, y_m. The data are not part of this repository.
  bench_real --ring RING --ring-radius 0.0525 --ellipse-part FILE --semi-axes 0.065445,0.0525 --tip-radius 0.00475
      the same part by a probe that is qualified on a ring (part "ellip1" of that set), touched on the
      same surface, beside the answers without that. --simulations 20 adds what is to be expected.)";

/// The makers of the data state no tolerance of the part. A round figure: half of the +-0.1 mm that
/// is usual for plates of that size cut without special care.
constexpr double kFormDeviation_m = 5e-5;

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kAbout);
  std::optional<std::string> file;
  std::vector<double> semi_axes;
  std::optional<double> tip_radius;
  std::optional<std::string> arcs;
  std::string mirrors = PALPATE_TEST_DATA "/real/dabam";
  app.add_option("--mirrors", mirrors, "Folder of mirrors with design.json")->capture_default_str();
  auto* part = app.add_option("--ellipse-part", file, "Contacts around an elliptic part, CSV");
  auto* axes = app.add_option("--semi-axes", semi_axes, "Of the part, A,B [m]")
                   ->delimiter(',')
                   ->expected(2)
                   ->check(CLI::PositiveNumber)
                   ->needs(part);
  part->needs(axes);
  app.add_option(
         "--tip-radius", tip_radius,
         "Of the probe, whose centres the contacts are [m]; without it, the file's own column")
      ->check(CLI::NonNegativeNumber)
      ->needs(part);
  app.add_option("--arcs", arcs, "Write the arcs' points to this CSV file, for opencv_arcs.py")
      ->needs(part);
  bool side_known = false;
  app.add_flag("--side-known", side_known, "Tell palpate that the material lies inside")
      ->needs(part);
  bool local_only = false;
  app.add_flag("--local-only", local_only, "The sliding window's estimates along the part, no arcs")
      ->needs(part);
  double form_deviation_m = kFormDeviation_m;
  app.add_option("--form-deviation", form_deviation_m,
                 "What palpate is told of the part's making, beside being told nothing: standard "
                 "deviation of its surface from the ellipse [m]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->needs(part);
  std::optional<std::string> ring;
  double ring_radius = 0.0;
  auto* ring_file =
      app.add_option("--ring", ring, "Contacts around a ring, to qualify the probe on, CSV")
          ->needs(part);
  ring_file->needs(app.add_option("--ring-radius", ring_radius, "Of the ring [m]")
                       ->check(CLI::PositiveNumber)
                       ->needs(ring_file));
  int simulations = 0;
  app.add_option("--simulations", simulations,
                 "Simulated recordings with errors drawn from the probe's file: how many answers a "
                 "95 % region is to leave wrong, from 2 on")
      ->check(CLI::NonNegativeNumber)
      ->needs(ring_file);
  CLI11_PARSE(app, argc, argv);
  try {
    if (!file) {
      palpate::bench::print_mirrors(mirrors, std::cout);
      return 0;
    }
    palpate::bench::EllipsePart ellipse{
        palpate::bench::read_recording(*file), std::max(semi_axes[0], semi_axes[1]),
        std::min(semi_axes[0], semi_axes[1]), side_known, form_deviation_m};
    if (tip_radius) {
      ellipse.recording.context.tip_radius_m = *tip_radius;
    }
    if (ring) {
      palpate::bench::Ring artefact{palpate::bench::read_recording(*ring), ring_radius};
      if (tip_radius) artefact.recording.context.tip_radius_m = *tip_radius;
      palpate::bench::print_qualified_part(artefact, ellipse, simulations, std::cout);
      return 0;
    }
    palpate::bench::print_local_coverage(ellipse, std::cout);
    if (!local_only) {
      palpate::bench::print_ellipse_part(ellipse, arcs, std::cout);
    }
  } catch (const std::runtime_error& error) {
    std::cerr << "bench_real: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
