#include "common/run/command_line.hpp"

#include <algorithm>
#include <utility>

namespace hexpipe {
namespace {

// The restricted Damerau-Levenshtein distance.
std::size_t distance_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before_last[j - 2] + 1);
    }
    before_last = std::exchange(last, now);
  }
  return last.back();
}

std::string_view name_in(std::string_view given) {
  given.remove_prefix(std::min(given.find_first_not_of('-'), given.size()));
  return given.substr(0, given.find('='));
}

}  // namespace

std::string near_option(std::string_view given, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 40;  // no option is this long, but users may type a megabyte
  const std::string_view name = name_in(given);
  if (name.empty() || name.size() > longest) return {};
  const auto is_begun = [&](const std::string& other) { return other.starts_with(name); };
  const auto begun = std::find_if(known.begin(), known.end(), is_begun);
  if (begun != known.end() && std::none_of(begun + 1, known.end(), is_begun)) return *begun;

  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& other : known) {
    const std::size_t distance = distance_between(name, other);
    if (distance < least) least = distance, nearest = other;
  }
  return nearest;
}

}  // namespace hexpipe
