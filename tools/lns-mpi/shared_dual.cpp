#include "tools/lns-mpi/shared_dual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "common/graph/clique_cover.hpp"
#include "common/graph/conflict_graph.hpp"
#include "common/mwis/bounds/entropy_dual.hpp"
#include "common/run/random.hpp"

namespace hexpipe::lns_mpi {
namespace {

// Differs from the streams of the search's rounds.
constexpr std::uint64_t stream = 0x5eed0fd0a15u;

// The cliques of one block, in the numbers of its own vertices and their neighbours.
struct BlockCliques {
  std::int32_t block = 0;
  std::vector<std::int32_t> vertices;  // of the local graph, ascending
  graph::ConflictGraph graph;
  graph::CliqueCover cover;
  std::vector<double> prices;
  std::vector<std::int64_t> whole_prices;
};

class SharedDual {
 public:
  SharedDual(Ranks& ranks, const LocalGraph& local)
      : ranks_(ranks), local_(local), costs_(local.graph.weights.begin(), local.graph.weights.end()) {
    std::array<std::int64_t, 1> heaviest{1};
    for (const std::int64_t weight : local.graph.weights) heaviest[0] = std::max(heaviest[0], weight);
    ranks.maximum(heaviest);
    heaviest_ = static_cast<double>(heaviest[0]);
    for (std::int32_t b = local.owners.first_of(local.rank); b < local.owners.first_of(local.rank + 1); ++b)
      blocks_.push_back(find_cliques(b));
  }

  void run(std::int64_t passes, std::uint64_t seed, const Deadline& deadline) {
    double round = -1;
    for (std::int64_t pass = 0; pass < passes && goes_on(deadline); ++pass) {
      const double now = mwis::bounds::dual_rounds(static_cast<double>(pass) / static_cast<double>(passes));
      draw(seed, pass);
      if (std::floor(now) > round && pass > 0) add_cliques();
      round = std::floor(now);
      for (BlockCliques& cliques : blocks_) step(cliques, heaviest_ * mwis::bounds::dual_temperature(now));
      tell_costs();
    }
  }

  // The bound of whole prices. There is none if the prices prove no more than the sum of all weights, which no sum of
  // prices may overflow.
  std::int64_t whole_bound() {
    make_prices_whole();
    const std::optional<std::int64_t> priced = sum_of_prices();
    if (!priced) drop_prices();
    const std::int64_t prices = priced.value_or(0), left = sum_of_costs();
    if (prices <= std::numeric_limits<std::int64_t>::max() - left) return prices + left;
    drop_prices();
    return sum_of_costs();
  }

  // Sends the prices to the first rank.
  std::vector<Bytes> gather_prices() {
    std::string lines;
    for (const BlockCliques& cliques : blocks_)
      for (std::int64_t c = 0; c < cliques.cover.size(); ++c) {
        if (cliques.whole_prices[c] == 0) continue;
        fmt::format_to(std::back_inserter(lines), "{}", cliques.whole_prices[c]);
        for (const std::int32_t i : cliques.cover.clique(c))
          fmt::format_to(std::back_inserter(lines), " {}", local_.keys[cliques.vertices[i]] + 1);
        lines += '\n';
      }
    std::vector<Bytes> to(static_cast<std::size_t>(ranks_.count()));
    to[0].assign(lines.begin(), lines.end());
    return ranks_.all_to_all(std::move(to));
  }

 private:
  void make_prices_whole() {
    for (BlockCliques& cliques : blocks_) {
      cliques.whole_prices.resize(cliques.prices.size());
      for (std::int64_t c = 0; c < cliques.cover.size(); ++c)
        cliques.whole_prices[c] =
            mwis::bounds::whole_price(cliques.cover.clique(c), cliques.prices[c], cliques.graph.weights);
    }
  }

  void drop_prices() {
    for (BlockCliques& cliques : blocks_) std::ranges::fill(cliques.whole_prices, 0);
  }

  // The sum over all ranks; nothing if it does not fit. Halves of the numbers are added separately: 2^31 of them fit.
  std::optional<std::int64_t> sum_of_prices() {
    constexpr int half = 32;
    std::array<std::int64_t, 2> halves{0, 0};
    for (const BlockCliques& cliques : blocks_)
      for (const std::int64_t price : cliques.whole_prices) {
        halves[0] += price >> half;
        halves[1] += price & ((std::int64_t{1} << half) - 1);
      }
    ranks_.sum(halves);
    const std::int64_t high = halves[0] + (halves[1] >> half);
    if (high > std::numeric_limits<std::int64_t>::max() >> half) return std::nullopt;
    return (high << half) + (halves[1] & ((std::int64_t{1} << half) - 1));
  }

  // The weight of vertices beyond their prices, on all ranks.
  std::int64_t sum_of_costs() {
    std::vector<std::int64_t> left = local_.graph.weights;
    for (const BlockCliques& cliques : blocks_)
      for (std::int64_t c = 0; c < cliques.cover.size(); ++c)
        for (const std::int32_t i : cliques.cover.clique(c)) left[cliques.vertices[i]] -= cliques.whole_prices[c];
    add_prices_of_others(left);
    std::array<std::int64_t, 1> sum{0};
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v)
      if (local_.owns(v)) sum[0] += std::max<std::int64_t>(left[v], 0);
    ranks_.sum(sum);
    return sum[0];
  }

  // Finds cliques in the graph of the block and its neighbours; each has a vertex of the block.
  BlockCliques find_cliques(std::int32_t block) const {
    BlockCliques found;
    found.block = block;
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v)
      if (local_.block[v] == block || touches(v, block)) found.vertices.push_back(v);
    found.graph = graph::induced_subgraph(local_.graph, found.vertices);
    const graph::CliqueCover all = graph::greedy_edge_clique_cover(found.graph);
    std::vector<std::int32_t> clique;
    for (std::int64_t c = 0; c < all.size(); ++c) {
      clique.assign(all.clique(c).begin(), all.clique(c).end());
      if (std::ranges::any_of(clique, [&](std::int32_t i) { return local_.block[found.vertices[i]] == block; }))
        found.cover.add(clique);
    }
    found.prices.assign(static_cast<std::size_t>(found.cover.size()), 0);
    return found;
  }

  bool touches(std::int32_t v, std::int32_t block) const {
    return std::ranges::any_of(local_.near_of(v),
                               [&](const NearBlock& near) { return near.block == block && near.distance == 1; });
  }

  bool goes_on(const Deadline& deadline) {
    std::array<std::int64_t, 1> passed{deadline.passed() ? 1 : 0};
    ranks_.maximum(passed);
    return passed[0] == 0;
  }

  // Decides whose cliques may move at each vertex: those of the first block, in an order of all blocks, that has the
  // vertex.
  void draw(std::uint64_t seed, std::int64_t pass) {
    std::vector<std::int32_t> priority(static_cast<std::size_t>(local_.owners.blocks()));
    std::iota(priority.begin(), priority.end(), 0);
    Random(seed ^ stream, static_cast<std::uint64_t>(pass)).shuffle(std::span(priority));
    turn_ = local_.block;
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v)
      for (const NearBlock& near : local_.near_of(v))
        if (near.distance == 1 && priority[near.block] < priority[turn_[v]]) turn_[v] = near.block;
  }

  void step(BlockCliques& cliques, double temperature) {
    block_costs_.resize(cliques.vertices.size());
    for (std::size_t i = 0; i < block_costs_.size(); ++i) block_costs_[i] = costs_[cliques.vertices[i]];
    const auto move = [&](std::int64_t c) {
      const auto members = cliques.cover.clique(c);
      const bool may =
          std::ranges::all_of(members, [&](std::int32_t i) { return turn_[cliques.vertices[i]] == cliques.block; });
      if (may) cliques.prices[c] = mwis::bounds::step_price(members, cliques.prices[c], temperature, block_costs_);
    };
    for (std::int64_t c = 0; c < cliques.cover.size(); ++c) move(c);
    for (std::int64_t c = cliques.cover.size(); c-- > 0;) move(c);
    for (std::size_t i = 0; i < block_costs_.size(); ++i)
      if (turn_[cliques.vertices[i]] == cliques.block) costs_[cliques.vertices[i]] = block_costs_[i];
  }

  void add_cliques() {
    for (BlockCliques& cliques : blocks_) {
      std::vector<double> fractions(cliques.vertices.size());
      std::ranges::transform(cliques.vertices, fractions.begin(), [&](std::int32_t v) {
        return std::min(1.0, std::exp(costs_[v] / (heaviest_ * mwis::bounds::coldest_dual_temperature)));
      });
      graph::add_violated_cliques(cliques.graph, fractions, cliques.cover);
      cliques.prices.resize(static_cast<std::size_t>(cliques.cover.size()), 0);
    }
  }

  // Calls visit(v) for the shared vertices whose costs the rank may have changed, in an order that both know.
  template <class Visit>
  void visit_turns(const LocalGraph::Partner& partner, int rank, Visit&& visit) const {
    for (const std::int32_t v : partner.shared)
      if (local_.owners.rank_of(turn_[v]) == rank && is_between(v)) visit(v);
  }
  // Whether v is in cliques of several blocks.
  bool is_between(std::int32_t v) const {
    return std::ranges::any_of(local_.near_of(v), [](const NearBlock& near) { return near.distance == 1; });
  }

  void tell_costs() {
    std::vector<int> to;
    std::vector<Bytes> news;
    for (const LocalGraph::Partner& partner : local_.partners) {
      Packer packer;
      visit_turns(partner, local_.rank, [&](std::int32_t v) { packer.put(costs_[v]); });
      to.push_back(partner.rank);
      news.push_back(packer.take());
    }
    const std::vector<Bytes> heard = ranks_.all_to_all(to, news);
    for (std::size_t i = 0; i < heard.size(); ++i) {
      Unpacker unpacker(heard[i]);
      visit_turns(local_.partners[i], local_.partners[i].rank,
                  [&](std::int32_t v) { costs_[v] = unpacker.get<double>(); });
    }
  }

  // Subtracts the prices that blocks of other ranks put on this rank's vertices.
  void add_prices_of_others(std::vector<std::int64_t>& left) {
    std::vector<int> to;
    std::vector<Bytes> news;
    for (const LocalGraph::Partner& partner : local_.partners) {
      Packer packer;
      for (const std::int32_t v : partner.shared)
        if (local_.owners.rank_of(local_.block[v]) == partner.rank) packer.put(local_.graph.weights[v] - left[v]);
      to.push_back(partner.rank);
      news.push_back(packer.take());
    }
    const std::vector<Bytes> heard = ranks_.all_to_all(to, news);
    for (std::size_t i = 0; i < heard.size(); ++i) {
      Unpacker unpacker(heard[i]);
      for (const std::int32_t v : local_.partners[i].shared)
        if (local_.owns(v)) left[v] -= unpacker.get<std::int64_t>();
    }
  }

  Ranks& ranks_;
  const LocalGraph& local_;
  double heaviest_ = 1;
  std::vector<double> costs_;        // by vertex of the local graph; right where one of the rank's blocks has cliques
  std::vector<double> block_costs_;  // costs of the block whose prices move
  std::vector<std::int32_t> turn_;
  std::vector<BlockCliques> blocks_;
};

}  // namespace

SharedProof prove_bound(Ranks& ranks, const LocalGraph& local, std::int64_t passes, std::uint64_t seed,
                        const Deadline& deadline, bool with_prices) {
  SharedDual dual(ranks, local);
  dual.run(passes, seed, deadline);
  SharedProof proof;
  proof.bound = dual.whole_bound();
  if (with_prices) proof.prices = dual.gather_prices();
  return proof;
}

}  // namespace hexpipe::lns_mpi
