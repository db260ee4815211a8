#include "common/mwis/local_search/recombination.hpp"

// Boost 1.74's walk over all edges keeps an optional iterator, which GCC 12 takes for uninitialized.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunknown-warning-option"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#pragma GCC diagnostic pop

#include <algorithm>
#include <iterator>
#include <vector>

namespace hexpipe::mwis::local_search {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
struct Node {
  boost::default_color_type color = boost::white_color;
  std::int64_t distance = 0;
  Traits::edge_descriptor predecessor;
};
struct Arc {
  std::int64_t capacity = 0, residual = 0;
  Traits::edge_descriptor reverse;
};
using Network = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Node, Arc>;

// The flow goes from the source through the vertices of one side, along conflicts, through those of the other side to
// the sink. A vertex that the cut separates from source or sink is left out; conflicts cannot be cut.
class Cut {
 public:
  explicit Cut(std::size_t vertices) : network_(vertices + 2), source_(vertices), sink_(vertices + 1) {}

  void from_source(std::size_t to, std::int64_t capacity) { connect(source_, to, capacity); }
  void to_sink(std::size_t from, std::int64_t capacity) { connect(from, sink_, capacity); }
  void connect(std::size_t from, std::size_t to, std::int64_t capacity) {
    const auto forth = boost::add_edge(from, to, Arc{capacity, 0, {}}, network_).first;
    const auto back = boost::add_edge(to, from, Arc{}, network_).first;
    network_[forth].reverse = back;
    network_[back].reverse = forth;
  }

  void find() {
    boost::boykov_kolmogorov_max_flow(network_, get(&Arc::capacity, network_), get(&Arc::residual, network_),
                                      get(&Arc::reverse, network_), get(&Node::predecessor, network_),
                                      get(&Node::color, network_), get(&Node::distance, network_),
                                      get(boost::vertex_index, network_), source_, sink_);
  }
  bool on_side_of_source(std::size_t vertex) const { return network_[vertex].color == boost::black_color; }

 private:
  Network network_;
  std::size_t source_, sink_;
};

graph::IndependentSet difference(const graph::IndependentSet& a, const graph::IndependentSet& b) {
  graph::IndependentSet only;
  std::ranges::set_difference(a, b, std::back_inserter(only));
  return only;
}

}  // namespace

graph::IndependentSet recombine(const graph::ConflictGraph& graph, const graph::IndependentSet& a,
                                const graph::IndependentSet& b) {
  const graph::IndependentSet only_a = difference(a, b), only_b = difference(b, a);
  Cut cut(only_a.size() + only_b.size());
  for (std::size_t j = 0; j < only_b.size(); ++j) cut.to_sink(only_a.size() + j, graph.weights[only_b[j]]);
  for (std::size_t i = 0; i < only_a.size(); ++i) {
    const std::int64_t weight = graph.weights[only_a[i]];
    cut.from_source(i, weight);
    auto at = only_b.begin();
    for (const std::int32_t u : graph.neighbours_of(only_a[i])) {
      at = std::lower_bound(at, only_b.end(), u);
      if (at == only_b.end()) break;
      if (*at == u) cut.connect(i, only_a.size() + static_cast<std::size_t>(at - only_b.begin()), weight);
    }
  }
  cut.find();

  graph::IndependentSet set;
  set.reserve(std::max(a.size(), b.size()));
  std::ranges::set_intersection(a, b, std::back_inserter(set));
  for (std::size_t i = 0; i < only_a.size(); ++i)
    if (cut.on_side_of_source(i)) set.push_back(only_a[i]);
  for (std::size_t j = 0; j < only_b.size(); ++j)
    if (!cut.on_side_of_source(only_a.size() + j)) set.push_back(only_b[j]);
  std::ranges::sort(set);
  return set;
}

}  // namespace hexpipe::mwis::local_search
