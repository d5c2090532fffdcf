// What somebody may have meant by a word that is unknown.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

/// Letters to change, insert, leave out or swap with their neighbour until `a` is `b`.
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        cost[i][j] = i + j;
        continue;
      }
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
      }
    }
  }
  return cost[a.size()][b.size()];
}

/// The known word that is spelled most alike; empty if none is.
inline std::string nearest_word(const std::string& wrong, const std::vector<std::string>& known) {
  constexpr std::size_t kLongest = 64;  // no name is that long, and the distance takes its square
  if (wrong.size() > kLongest) return {};
  std::size_t least = std::max<std::size_t>(1, wrong.size() / 4);  // else it is another word
  std::string nearest;
  for (const std::string& word : known) {
    const std::size_t distance = edit_distance(wrong, word);
    if (distance > least || (distance == least && !nearest.empty())) continue;
    least = distance;
    nearest = word;
  }
  return nearest;
}

}  // namespace palpate
