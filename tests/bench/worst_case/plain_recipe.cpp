#include "tests/bench/worst_case/plain_recipe.h"

#include <cmath>

namespace palpate::bench {

InputRecipe plain_recipe(std::mt19937_64& rng) {
  const auto uniform = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(rng);
  };
  constexpr int kWithFormula = 12;  // the shapes up to Quartic
  InputRecipe recipe;
  recipe.shape = static_cast<Shape>(std::uniform_int_distribution<int>(0, kWithFormula - 1)(rng));
  recipe.seed = rng();
  recipe.patches = std::uniform_int_distribution<int>(1, 4)(rng);
  recipe.arc = std::pow(10.0, uniform(-1.0, 0.3));
  recipe.sigma = std::pow(10.0, uniform(-5.0, -2.7));
  return recipe;
}

}  // namespace palpate::bench
