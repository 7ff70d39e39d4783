#pragma once
// Which of the words that there are somebody may have meant.

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace kinebus {

/// Letters to change, add, take out or exchange with the next (optimal string alignment) to make `b` of `a`.
inline std::size_t word_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      row[k] = std::min({last[k] + 1, row[k - 1] + 1, last[k - 1] + (a[i - 1] == b[k - 1] ? 0U : 1U)});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        row[k] = std::min(row[k], before[k - 2] + 1);
    }
  }
  return row[b.size()];
}

/// The word of `words` that is nearest to `given`; empty: none is near. The words must outlive the result.
template <typename Words>
std::string_view near_word(const Words& words, std::string_view given) {
  given = given.substr(0, 100);
  std::size_t least = 2 + given.size() / 3;
  std::string_view nearest;
  for (const auto& word : words)
    if (const std::size_t d = word_distance(given, word); d < least) {
      least = d;
      nearest = word;
    }
  return nearest;
}

}  // namespace kinebus
