// The effect of a probe's habits on answers, over random scenes that are otherwise the same: noise
// that is not stated or stated wrongly or shared by neighbours, a probe that stands still, spikes,
// strokes that do not meet, a wavy part. Prints which answers are right, which are sure and wrong,
// and which scenes lose samples.
//   bench_habits [--scenes N] [--seed S]
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/worst_case/plain_recipe.h"
#include "tests/bench/worst_case/touched_input.h"

namespace {

using namespace palpate;
using bench::InputRecipe;

CurveClass class_of(bench::Shape shape) {
  switch (shape) {
    case bench::Shape::Line:
      return CurveClass::Line;
    case bench::Shape::Circle:
      return CurveClass::Circle;
    case bench::Shape::Ellipse:
      return CurveClass::Ellipse;
    case bench::Shape::Parabola:
      return CurveClass::Parabola;
    case bench::Shape::Hyperbola:
      return CurveClass::Hyperbola;
    case bench::Shape::CubicalParabola:
      return CurveClass::CubicalParabola;
    case bench::Shape::SemiCubicalParabola:
      return CurveClass::SemiCubicalParabola;
    default:
      return CurveClass::Unclassified;
  }
}

Recognition answer_to(const InputRecipe& recipe) {
  Recognizer recognizer;
  for (const bench::TouchedPatch& patch : bench::input_of(recipe)) {
    recognizer.add(patch.context, patch.samples);
  }
  return recognizer.recognize();
}

/// A part that is not a spline: most of the splines that touched_input draws are semi-cubical
/// parabolas to within the noise, and neither answer would be wrong.
InputRecipe recipe_to_tell(std::mt19937_64& rng) {
  InputRecipe recipe = bench::plain_recipe(rng);
  while (recipe.shape == bench::Shape::CubicSpline) {
    recipe = bench::plain_recipe(rng);
  }
  return recipe;
}

/// Scenes of one habit.
struct Tally {
  int of_class = 0;
  int right = 0;       ///< RECOGNIZED as the class touched
  int as_another = 0;  ///< RECOGNIZED as another class
  int as_none = 0;     ///< RECOGNIZED as none of the classes
  int of_none = 0;
  int none_as_class = 0;
  int losing = 0;  ///< scenes with samples set aside as spikes
};

void count(const InputRecipe& recipe, Tally* tally) {
  const CurveClass truth = class_of(recipe.shape);
  const Recognition answer = answer_to(recipe);
  const bool recognized = answer.status == RecognitionStatus::Recognized;
  const CurveClass said = answer.shape.curve_class;
  if (truth == CurveClass::Unclassified) {
    ++tally->of_none;
    tally->none_as_class += recognized && said != truth ? 1 : 0;
  } else {
    ++tally->of_class;
    tally->right += recognized && said == truth ? 1 : 0;
    tally->as_none += recognized && said == CurveClass::Unclassified ? 1 : 0;
    tally->as_another += recognized && said != truth && said != CurveClass::Unclassified ? 1 : 0;
  }
  tally->losing += answer.outlier_count > 0 ? 1 : 0;
}

/// A habit and how to add it to an ordinary scene.
struct Habit {
  const char* name;
  void (*put)(InputRecipe* recipe);
};

constexpr Habit kHabits[] = {
    {"none", [](InputRecipe*) {}},
    {"noise not stated", [](InputRecipe* r) { r->stated_over_true = 0.0; }},
    {"noise stated three times too high", [](InputRecipe* r) { r->stated_over_true = 3.0; }},
    {"noise stated three times too low", [](InputRecipe* r) { r->stated_over_true = 1.0 / 3.0; }},
    {"neighbours' noise correlates by 0.5", [](InputRecipe* r) { r->shared_noise = 0.5; }},
    {"by 0.8", [](InputRecipe* r) { r->shared_noise = 0.8; }},
    {"by 0.8, noise not stated",
     [](InputRecipe* r) {
       r->shared_noise = 0.8;
       r->stated_over_true = 0.0;
     }},
    {"30 % of the samples stand still", [](InputRecipe* r) { r->dwelling = 0.3; }},
    {"80 % of the samples stand still", [](InputRecipe* r) { r->dwelling = 0.8; }},
    {"30 % stand still, noise not stated",
     [](InputRecipe* r) {
       r->dwelling = 0.3;
       r->stated_over_true = 0.0;
     }},
    {"80 % stand still, noise not stated",
     [](InputRecipe* r) {
       r->dwelling = 0.8;
       r->stated_over_true = 0.0;
     }},
    {"half the samples from one place", [](InputRecipe* r) { r->standing = 0.5; }},
    {"90 % of ten times as many, not stated",
     [](InputRecipe* r) {
       r->samples *= 10;
       r->standing = 0.9;
       r->stated_over_true = 0.0;
     }},
    {"three passes, there and back", [](InputRecipe* r) { r->passes = 3; }},
    {"spikes in 5 % of the samples", [](InputRecipe* r) { r->spikes = 0.05; }},
    {"spikes in 30 % of the samples", [](InputRecipe* r) { r->spikes = 0.3; }},
    {"strokes shifted by 3 deviations", [](InputRecipe* r) { r->misplacement = 3.0 * r->sigma; }},
    {"a wave of 3 deviations", [](InputRecipe* r) { r->wave = 3.0 * r->sigma; }},
};

}  // namespace

int main(int argc, char** argv) {
  int scenes = 300;
  std::uint64_t seed = 1;
  if (const auto end = bench::BenchOptions("What habits of a probe do to answers")
                           .number("--scenes", scenes, "Number of scenes of each habit")
                           .seed(seed)
                           .parse(argc, argv)) {
    return *end;
  }
  std::mt19937_64 rng(seed);
  std::vector<InputRecipe> recipes;
  for (int i = 0; i < scenes; ++i) {
    recipes.push_back(recipe_to_tell(rng));
  }
  std::printf(
      "RECOGNIZED, of scenes of a class and of none; scenes of which samples were set aside\n");
  std::printf("%-36s %8s %8s %8s %8s   %8s %8s %8s\n", "habit", "of class", "right", "another",
              "as none", "of none", "as class", "set aside");
  for (const Habit& habit : kHabits) {
    Tally tally;
    for (InputRecipe recipe : recipes) {
      habit.put(&recipe);
      count(recipe, &tally);
    }
    std::printf("%-36s %8d %8d %8d %8d   %8d %8d %8d\n", habit.name, tally.of_class, tally.right,
                tally.as_another, tally.as_none, tally.of_none, tally.none_as_class, tally.losing);
  }
  return 0;
}
