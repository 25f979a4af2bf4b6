#include <locograph/common/suggestion.h>

#include <algorithm>
#include <cctype>

namespace locograph {
namespace {

int lower_case(char letter) { return std::tolower(static_cast<unsigned char>(letter)); }

bool begins(std::string_view typed, std::string_view name) {
  return typed.size() >= 3 && typed.size() <= name.size() &&
         edit_distance(typed, name.substr(0, typed.size())) == 0;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Rows i − 2, i − 1 and i of the table: from the first i letters of a to the first j of b.
  std::vector<int> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int here = lower_case(a[i - 1]), there = lower_case(b[j - 1]);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (here == there ? 0 : 1)});
      const bool exchanged =
          i > 1 && j > 1 && here == lower_case(b[j - 2]) && lower_case(a[i - 2]) == there;
      if (exchanged) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last.back();
}

std::string did_you_mean(std::string_view typed, const std::vector<std::string>& names) {
  const auto is_begun = [typed](const std::string& name) { return begins(typed, name); };
  const std::string* meant = nullptr;
  if (std::count_if(names.begin(), names.end(), is_begun) == 1) {
    meant = &*std::find_if(names.begin(), names.end(), is_begun);
  } else if (typed.size() <= 100) {  // no name is that long, and the table would be
    int least = 0;
    for (const std::string& name : names) {
      const int distance = edit_distance(typed, name);
      const int most = std::max(1, static_cast<int>(name.size()) / 3);
      if (distance > most || (meant != nullptr && distance >= least)) continue;
      meant = &name;
      least = distance;
    }
  }
  return meant == nullptr ? "" : "; did you mean '" + *meant + "'?";
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace locograph
