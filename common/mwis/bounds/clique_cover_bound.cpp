#include "common/mwis/bounds/clique_cover_bound.hpp"

#include <algorithm>

namespace hexpipe::mwis::bounds {

bool CliqueCoverBound::at_most(const ground::DenseGraph& graph, bits::Word* set, std::int64_t limit) {
  const std::size_t words = graph.words();
  clique_.resize(std::max(words, clique_.size()));
  for (std::size_t w = 0; w < words; ++w)
    while (set[w] != 0) {
      const std::size_t first = 64 * w + static_cast<std::size_t>(std::countr_zero(set[w]));
      bits::erase(set, first);
      std::int64_t heaviest = graph.weight(first);
      if (heaviest > limit) return false;
      const bits::Word* const row = graph.row(first);
      for (std::size_t i = w; i < words; ++i) clique_[i] = set[i] & row[i];
      for (std::size_t i = w; i < words; ++i)
        while (clique_[i] != 0) {
          const std::size_t next = 64 * i + static_cast<std::size_t>(std::countr_zero(clique_[i]));
          bits::erase(set, next);
          heaviest = std::max(heaviest, graph.weight(next));
          if (heaviest > limit) return false;
          const bits::Word* const other = graph.row(next);
          for (std::size_t j = i; j < words; ++j) clique_[j] &= other[j];
        }
      limit -= heaviest;
    }
  return true;
}

}  // namespace hexpipe::mwis::bounds
