#include "tests/support/reference_curves.h"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace palpate::test {
namespace {

std::vector<ReferenceCurve> read_reference_curves() {
  const std::string path = std::string(PALPATE_TEST_DATA) + "/reference/curves.csv";
  std::ifstream file(path);
  std::vector<ReferenceCurve> curves;
  std::string line;
  while (std::getline(file, line)) {
    if (!line.empty() && line.back() == '\r') {
      line.pop_back();
    }
    if (line.empty() || line.front() == '#' || line.starts_with("class,")) {
      continue;
    }
    std::array<std::string, 12> field;
    std::istringstream stream(line);
    for (std::string& text : field) {
      std::getline(stream, text, ',');
    }
    const auto curve_class = curve_class_from_name(field[0]);
    if (!curve_class) {
      throw std::runtime_error(path + ": unknown class " + field[0]);
    }
    const auto number = [&](std::size_t i) { return std::stod(field[i]); };
    const auto optional_number = [&](std::size_t i) {
      return field[i].empty() ? std::nullopt : std::optional(number(i));
    };
    const double a = number(1);
    const double b = number(2);
    const double c = number(3);
    if (curves.empty() || curves.back().curve_class != *curve_class || curves.back().a != a ||
        curves.back().b != b || curves.back().c != c) {
      curves.push_back({*curve_class, a, b, c, {}});
    }
    curves.back().points.push_back({number(4), number(5), number(6), number(7), optional_number(8),
                                    number(9), number(10), optional_number(11)});
  }
  if (curves.empty()) {
    throw std::runtime_error(path + ": no curves");
  }
  return curves;
}

}  // namespace

const std::vector<ReferenceCurve>& reference_curves() {
  static const std::vector<ReferenceCurve> curves = read_reference_curves();
  return curves;
}

}  // namespace palpate::test
