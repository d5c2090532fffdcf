// Prints the paper's noise-free tables and figure 7 beside ours, as Markdown:
//     paper_tables > tables.md
#include <cstdio>
#include <string>
#include <vector>

#include "tests/paper/default_experiments.h"
#include "tests/paper/figure_invariants.h"
#include "tests/paper/paper_experiments.h"
#include "tests/paper/sensor_experiments.h"

namespace palpate::paper {
namespace {

void print_table1(const char* title, Measurement how) {
  std::printf("\n## Table 1: invariants on their own curves, %s\n\n", title);
  std::printf("| invariant | real | min | max | mean | paper: real | min | max | mean |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  for (const InvariantColumn& c : table1(how)) {
    std::printf("| %s | %.4f | %.4f | %.4f | %.4f | %.4f | %.4f | %.4f | %.4f |\n", c.name.data(),
                c.real, c.ours.min, c.ours.max, c.ours.mean, c.paper_real, c.paper.min, c.paper.max,
                c.paper.mean);
  }
}

void print_table2() {
  std::printf("\n## Table 2: invariants on curves of other classes\n\n");
  std::printf(
      "| invariant | data | min | max | mean | stdev | paper: min | max | mean | stdev |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
  for (const WrongInvariant& c : table2()) {
    std::printf("| %s | %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n",
                c.invariant.data(), c.data.data(), c.ours.min, c.ours.max, c.ours.mean,
                c.ours.stdev, c.paper.min, c.paper.max, c.paper.mean, c.paper.stdev);
  }
}

void print_table3() {
  std::printf("\n## Table 3: relative error of the recovered parameters [%%]\n\n");
  std::printf(
      "| class | curves | min | max | mean | paper: min | max | mean | mean, exact kappa, kappa_s "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
  const auto exact = table3(Measurement::Exact);
  std::size_t i = 0;
  for (const RecoveryColumn& c : table3()) {
    std::printf("| %s | %d | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.1e |\n", c.name.data(),
                c.curves, c.ours.min, c.ours.max, c.ours.mean, c.paper.min, c.paper.max,
                c.paper.mean, exact[i++].ours.mean);
  }
}

void print_figures4_and5() {
  std::printf("\n## Figure 4: parabolas y^2 = 4 a x, Ip at t = 0.7\n\n");
  std::printf("| a | Ip | (2 a)^(-2/3) |\n|---|---|---|\n");
  for (const FigureCurve& c : figure4()) {
    std::printf("| %g | %.6f | %.6f |\n", c.parameters[0], c.measured[0], c.expected[0]);
  }
  std::printf("\n## Figure 5: ellipses and a circle, Ic1 and Ic2 from t = 0.4 and 1.3\n\n");
  std::printf("| a | b | Ic1 | (a b)^(-2/3) | Ic2 | (a^2 + b^2) (a b)^(-4/3) |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const FigureCurve& c : figure5()) {
    std::printf("| %g | %g | %.6f | %.6f | %.6f | %.6f |\n", c.parameters[0], c.parameters[1],
                c.measured[0], c.expected[0], c.measured[1], c.expected[1]);
  }
}

void print_figure7() {
  const FigureEllipse ellipse = figure7_ellipse();
  std::printf("\n## Figure 7 (a): ellipse at t = 0.36, 1.86, 4.23\n\n");
  std::printf("| value | ours | paper |\n|---|---|---|\n");
  std::printf("| Ic1 (1,2), (1,3), (2,3) | %.4f %.4f %.4f | 0.3447 0.3446 0.3449 |\n",
              ellipse.ic1[0], ellipse.ic1[1], ellipse.ic1[2]);
  std::printf("| Ip at 1, 2 | %.4f %.4f | 0.8971 0.4030 |\n", ellipse.ip[0], ellipse.ip[1]);
  std::printf("\n## Figure 7: recognised shapes\n\n");
  std::printf("| shape | recognised as | ours | real | paper |\n|---|---|---|---|---|\n");
  for (const FigureShape& s : figure7()) {
    const auto& v = s.ours.shape.values;
    std::printf("| %s | %s | %.4f %.4f %.4f | %.4f %.4f %.4f |", s.name.data(),
                name_of(s.ours.shape.curve_class).data(), v[0], v[1], v[2], s.real[0], s.real[1],
                s.real[2]);
    if (s.paper.isZero()) {
      std::printf(" not printed |\n");
    } else {
      std::printf(" %.4f %.4f %.4f |\n", s.paper[0], s.paper[1], s.paper[2]);
    }
    for (const Decision& d : s.ours.decisions) {
      std::printf("|  | %s: %s | %.4g of %.4g | | |\n", d.test.data(), d.passed ? "yes" : "no",
                  d.value, d.threshold);
    }
  }
}

void print_defaults() {
  std::printf(
      "\n## Table 3 with the defaults: two patches of 111 exact samples, noise not told\n\n");
  std::printf(
      "| class | curves | recognised | mean error [%%] | worst [%%] |\n|---|---|---|---|---|\n");
  for (const DefaultRecovery& c : default_table3()) {
    std::printf("| %s | %d | %d | %.1e | %.1e |\n", c.name.data(), c.curves, c.recognised,
                c.mean_percent, c.worst_percent);
  }
}

/// The rows of a parameter: truth, the paper's own figures as text, its method in our hands, the
/// defaults.
void print_sensor(const char* title, const SensorExperiment& e,
                  const std::vector<std::string>& printed) {
  std::printf("\n## %s\n\n", title);
  std::printf(
      "%d trials: the paper's method gives a shape in %d, the defaults in %d and recognise the "
      "class with "
      "certainty in %d.\n\n",
      e.trials, e.by_paper.answers, e.by_defaults.answers, e.recognised);
  std::printf(
      "| | truth | printed (real part and sensor) | method, ours: min | max | median | spread | "
      "defaults: min | "
      "max | median | spread | bound |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < printed.size(); ++k) {
    std::printf("| %c | %.6g | %s |", parameter_letters(e.curve_class)[k], e.truth[k],
                printed[k].c_str());
    for (const Recovered* way : {&e.by_paper, &e.by_defaults}) {
      std::printf(" %.5g | %.5g | %.5g | %.2g |", way->min[k], way->max[k], way->median[k],
                  way->spread[k]);
    }
    std::printf(" %.2g |\n", e.bound[k]);
  }
}

void print_sensor_tables() {
  print_sensor(
      "Table 4: ellipse from two strokes of 111 samples 0.2 mm apart, sigma 0.05 mm; in mm",
      table4(), {"23.8636 to 26.7234, mean 25.1127", "16.2636 to 18.3549, mean 17.1959"});
  print_sensor("Table 5: cubic spline segment from three such strokes; in cm", table5(),
               {"1.07246, 1.06594", "1.57648, 1.55496", "-0.39233, -0.44884"});
}

}  // namespace
}  // namespace palpate::paper

int main() {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  using namespace palpate::paper;
  std::printf("# The paper's noise-free simulations, ours beside the printed values\n\n");
  std::printf("kappa and kappa_s by finite differences (51), chords for arc lengths.\n");
  print_table1("finite differences", Measurement::FiniteDifferences);
  print_table1("exact kappa and kappa_s", Measurement::Exact);
  print_table2();
  print_table3();
  print_figures4_and5();
  print_figure7();
  print_defaults();
  print_sensor_tables();
  return 0;
}
