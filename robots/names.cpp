#include <locograph/robots/names.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace locograph {
namespace {

/// Levenshtein distance, one row at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string similar_names(const std::string& name, const std::vector<std::string>& candidates) {
  std::vector<std::pair<std::size_t, std::string>> ranked;
  for (const std::string& candidate : candidates) {
    ranked.emplace_back(edit_distance(name, candidate), candidate);
  }
  std::sort(ranked.begin(), ranked.end());
  if (ranked.empty()) return "none, because there are none";
  std::string text = "one like ";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, ranked.size()); ++i) {
    text += (i > 0 ? ", '" : "'") + ranked[i].second + "'";
  }
  return text;
}

std::string listed_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  const std::size_t told = std::min(names.size(), kMost);
  std::string text;
  for (std::size_t i = 0; i < told; ++i) {
    const bool last = i + 1 == names.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + names[i];
  }
  if (names.size() > told) text += " and " + std::to_string(names.size() - told) + " more";
  return text;
}

}  // namespace locograph
