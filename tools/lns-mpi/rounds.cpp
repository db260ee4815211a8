#include "tools/lns-mpi/rounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/mwis/ground/solution_state.hpp"
#include "common/run/parallel.hpp"
#include "common/run/random.hpp"
#include "tools/lns-mpi/regions.hpp"

namespace hexpipe::lns_mpi {
namespace {

// Under a time limit, borders move after each round, because what lies at a border is not searched; but the end of a
// round cuts off coolings. On 200,000 points at random and 20 s, 4 rounds are worse than 8, and 16 are as good. They
// are no longer than a minute, so that ranks do not go on for long after one of them was told to stop.
constexpr double round_share = 1.0 / 8, longest_round = 60;
// Under a time limit alone, this many fragments at a time where there are several rounds, so that the end of a round
// cuts off few: one that is annealed, as a batch has a quarter as many of these.
constexpr int fragments_a_thread = 4;
// A round takes at least this many times as long as taking the regions out of the graph did in the one before.
constexpr double least_times_extraction = 3;
// The share of a time limit, as in lns.
constexpr double share_for_reductions = 0.1;
// The search ends after this many rounds in which no region was improved.
constexpr std::int64_t most_quiet_rounds = 10;

std::int64_t own_weight(const LocalGraph& local) {
  std::int64_t sum = 0;
  for (std::int32_t v = 0; v < local.vertex_count(); ++v)
    if (local.chosen[v] != 0 && local.owns(v)) sum += local.graph.weights[v];
  return sum;
}

class Rounds {
 public:
  Rounds(Ranks& ranks, LocalGraph& local, const RoundsOptions& options, const Deadline& deadline,
         RoundsProgress& progress, std::vector<BlockMemory>& memories)
      : ranks_(ranks),
        local_(local),
        options_(options),
        deadline_(deadline),
        progress_(progress),
        searchers_(local.owners, is_timed_alone() ? Searchers::Kind::ranks : Searchers::Kind::blocks),
        first_own_(searchers_.first_of(local.rank)),
        end_own_(searchers_.first_of(local.rank + 1)),
        memories_(memories),
        sizes_(static_cast<std::size_t>(searchers_.count()), 0),
        changed_by_(local.keys.size(), no_index) {
    for (std::int32_t v = 0; v < local.vertex_count(); ++v)
      if (local.owns(v)) ++sizes_[searchers_.of_block(local.block[v])];
    ranks_.sum(sizes_);
    for (const std::int64_t size : sizes_) vertices_ += size;
    if (is_timed_alone() && memories_.size() > 1) join_memories();
    usual_round_seconds_ = round_seconds_ = std::isfinite(deadline.remaining())
                                                ? std::min(longest_round, share_of_round() * deadline.remaining())
                                                : std::numeric_limits<double>::infinity();
  }

  // Parts that chose separately may have chosen neighbours: the heavier of two stays.
  void make_independent() {
    changed_.clear();
    const auto outweighs = [&](std::int32_t u, std::int32_t v) {
      const auto& weights = local_.graph.weights;
      return local_.chosen[u] != 0 && (weights[u] != weights[v] ? weights[u] > weights[v] : u < v);
    };
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v)
      if (local_.chosen[v] != 0 && local_.owns(v) &&
          std::ranges::any_of(local_.graph.neighbours_of(v), [&](std::int32_t u) { return outweighs(u, v); }))
        changed_.push_back(v);
    for (const std::int32_t v : changed_) local_.chosen[v] = 0;
    tell_partners();
    progress_.weight = total_weight(ranks_, local_);
  }

  bool goes_on() const {
    return !stopped_ && progress_.allotted < options_.search.iterations && progress_.weight < options_.search.target &&
           progress_.quiet < most_quiet_rounds && vertices_ > 0;
  }

  void keep_given() {
    given_ = local_.chosen;
    given_weight_ = progress_.weight;
  }

  void take_up(const std::vector<std::uint64_t>& keys) {
    changed_.clear();
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v) {
      if (!local_.owns(v)) continue;
      const std::uint8_t chosen = std::ranges::binary_search(keys, local_.keys[v]) ? 1 : 0;
      if (chosen == local_.chosen[v]) continue;
      local_.chosen[v] = chosen;
      changed_.push_back(v);
    }
    tell_partners();
    make_independent();
  }

  void reduce() {
    const double left = deadline_.remaining();
    reduce_blocks(ranks_, local_, std::isfinite(left) ? Deadline(share_for_reductions * left) : Deadline());
    progress_.weight = total_weight(ranks_, local_);
  }

  // Takes vertices that have no chosen neighbour: reductions left them out, or a search that ended early left them
  // where borders were. The solution may then still be lighter than the given one, as reductions cost weight at first.
  void complete() {
    std::ranges::fill(local_.decided, 0);
    make_maximal();
    if (progress_.weight >= given_weight_) return;
    local_.chosen = given_;
    make_maximal();
  }

  void make_maximal() {
    for (std::int64_t round = progress_.round; count_free() > 0; ++round) {
      Regions regions(local_, searchers_, options_.search.seed, round);
      changed_.clear();
      for (std::int32_t s = first_own_; s < end_own_; ++s) add_free(regions.extract(s));
      tell_partners();
    }
    progress_.weight = total_weight(ranks_, local_);
  }

  RoundCosts run_one() {
    RoundCosts costs;
    const Traffic before = ranks_.traffic();
    const Stopwatch watch;
    Regions regions(local_, searchers_, options_.search.seed, progress_.round);
    extraction_seconds_ = watch.seconds();
    changed_.clear();
    improvements_ = iterations_ = unproven_ = 0;
    search_own(regions);
    costs.search_seconds = watch.seconds();
    tell_partners();
    forget_changed_places();
    put_together();
    choose_round_seconds();
    costs.wait_seconds = watch.seconds() - costs.search_seconds;
    costs.traffic = ranks_.traffic() - before;
    return costs;
  }

 private:
  // The number on all ranks.
  std::int64_t count_free() {
    std::array<std::int64_t, 1> count{0};
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v)
      if (local_.chosen[v] == 0 && local_.owns(v) &&
          std::ranges::none_of(local_.graph.neighbours_of(v), [&](std::int32_t u) { return local_.chosen[u] != 0; }))
        ++count[0];
    ranks_.sum(count);
    return count[0];
  }

  void add_free(const Region& region) {
    mwis::ground::SolutionState state(region.graph, region.chosen);
    state.make_maximal();
    put_back(region, state.to_set());
  }

  void join_memories() {
    memories_.front().join(std::span(memories_).subspan(1));
    std::fill(memories_.begin() + 1, memories_.end(), BlockMemory());
  }

  // A time limit alone gives no number of fragments to share, and the result depends on the clock anyway. So each rank
  // searches its blocks as one.
  bool is_timed_alone() const { return options_.search.iterations == std::numeric_limits<std::int64_t>::max(); }

  // A searcher that has no others beside it needs no rounds.
  double share_of_round() const { return searchers_.count() == 1 ? 1 : round_share; }

  // The number of fragments of this round up to a searcher, in proportion to the vertices up to there.
  std::int64_t allotment() const {
    const std::int64_t wanted = std::max<std::int64_t>(options_.fragments_a_round * vertices_ / 1000, 1);
    return std::min(wanted, options_.search.iterations - progress_.allotted);
  }
  std::int64_t share_of(std::int64_t fragments, std::int64_t vertices) const {
    return static_cast<std::int64_t>(static_cast<long double>(fragments) * static_cast<long double>(vertices) /
                                     static_cast<long double>(vertices_));
  }

  void search_own(Regions& regions) {
    const Stopwatch watch;
    std::int64_t own = 0, before = 0;
    for (std::int32_t s = first_own_; s < end_own_; ++s) own += sizes_[s];
    for (std::int32_t s = 0; s < first_own_; ++s) before += sizes_[s];
    for (std::int32_t s = first_own_; s < end_own_; ++s) {
      const std::int64_t size = sizes_[s];
      const double left = std::min(round_seconds_ - watch.seconds(), deadline_.remaining());
      const Deadline deadline =
          std::isfinite(left)
              ? Deadline(left * static_cast<double>(size) / static_cast<double>(std::max<std::int64_t>(own, 1)))
              : Deadline();
      const std::int64_t fragments = is_timed_alone()
                                         ? options_.search.iterations
                                         : share_of(allotment(), before + size) - share_of(allotment(), before);
      search(regions, s, fragments, deadline);
      own -= size;
      before += size;
    }
  }

  void search(Regions& regions, std::int32_t searcher, std::int64_t fragments, const Deadline& deadline) {
    if (fragments == 0 || deadline.passed()) {
      ++unproven_;
      return;
    }
    const Stopwatch watch;
    const Region region = regions.extract(searcher);
    extraction_seconds_ += watch.seconds();
    BlockMemory& known = memories_[searcher - first_own_];
    mwis::local_search::LnsOptions options = options_.search;
    options.iterations = fragments;
    options.target = std::numeric_limits<std::int64_t>::max();
    if (is_timed_alone() && searchers_.count() > 1)
      options.batch = std::min(options.batch, fragments_a_thread * thread_count());
    // Places that are new to this block begin with the size that fragments have reached elsewhere in it.
    if (known.usual_size() > 0) options.fragment_size = known.usual_size();
    // A different seed for every region.
    options.seed =
        Random(options.seed, static_cast<std::uint64_t>(progress_.round)).next() + static_cast<std::uint64_t>(searcher);
    mwis::local_search::LnsMemory memory = known.recall(region, local_.keys);
    std::vector<std::int32_t> fragment;
    const auto report = [&](const mwis::local_search::LnsProgress& now) {
      if (!options_.improved) return;
      fragment.clear();
      for (const std::int32_t v : now.fragment) fragment.push_back(region.vertices[v]);
      options_.improved(fragment);
    };
    const mwis::local_search::LnsResult result =
        mwis::local_search::continue_lns(region.graph, region.chosen, options, deadline, memory, report);
    known.remember(memory, region, local_.keys);
    iterations_ += result.iterations;
    improvements_ += result.improvements;
    unproven_ += result.complete ? 0 : 1;
    const std::size_t before = changed_.size();
    put_back(region, result.solution);
    for (std::size_t i = before; i < changed_.size(); ++i) changed_by_[changed_[i]] = searcher;
  }

  void put_back(const Region& region, const graph::IndependentSet& solution) {
    const std::size_t before = changed_.size();
    std::ranges::set_symmetric_difference(region.chosen, solution, std::back_inserter(changed_));
    for (std::size_t i = before; i < changed_.size(); ++i) {
      changed_[i] = region.vertices[changed_[i]];
      local_.chosen[changed_[i]] ^= 1;
    }
  }

  // Where another searcher changed a neighbour, a place of a searcher's memory counts as never tried.
  void forget_changed_places() {
    for (const std::int32_t v : heard_) changed_by_[v] = searchers_.count();
    std::vector<std::pair<std::uint64_t, std::int32_t>> changed_near;  // a place, and who changed a neighbour
    for (std::int32_t v = 0; v < local_.vertex_count(); ++v) {
      if (local_.chosen[v] == 0) continue;
      std::int32_t searcher = changed_by_[v];
      const auto meet = [&](std::int32_t other) {
        if (other == no_index || other == searcher) return;
        if (searcher != no_index) changed_near.push_back({local_.keys[v], searcher});
        searcher = other;
      };
      for (const std::int32_t u : local_.graph.neighbours_of(v)) meet(changed_by_[u]);
      if (searcher != no_index) changed_near.push_back({local_.keys[v], searcher});
    }
    std::vector<std::uint64_t> keys;
    for (std::int32_t s = first_own_; s < end_own_; ++s) {
      keys.clear();
      for (const auto& [key, searcher] : changed_near)
        if (searcher != s) keys.push_back(key);
      memories_[s - first_own_].forget_tries(keys);
    }
    for (const std::int32_t v : changed_) changed_by_[v] = no_index;
    for (const std::int32_t v : heard_) changed_by_[v] = no_index;
  }

  void choose_round_seconds() {
    if (!std::isfinite(round_seconds_)) return;
    constexpr double microseconds = 1e6;
    std::array<std::int64_t, 1> longest{static_cast<std::int64_t>(extraction_seconds_ * microseconds)};
    ranks_.maximum(longest);
    const double least = least_times_extraction * static_cast<double>(longest[0]) / microseconds;
    round_seconds_ = std::min(longest_round, std::max(usual_round_seconds_, least));
  }

  // Sends partners the changes, by place in the list that both have.
  void tell_partners() {
    std::ranges::sort(changed_);
    std::vector<int> to;
    std::vector<Bytes> news;
    for (const LocalGraph::Partner& partner : local_.partners) {
      Packer packer;
      auto at = partner.shared.begin();
      for (const std::int32_t v : changed_) {
        at = std::lower_bound(at, partner.shared.end(), v);
        if (at == partner.shared.end()) break;
        if (*at == v) packer.put(static_cast<std::uint32_t>(at - partner.shared.begin()));
      }
      to.push_back(partner.rank);
      news.push_back(packer.take());
    }
    const std::vector<Bytes> heard = ranks_.all_to_all(to, news);
    heard_.clear();
    for (std::size_t i = 0; i < heard.size(); ++i)
      for (Unpacker unpacker(heard[i]); !unpacker.at_end();) {
        heard_.push_back(local_.partners[i].shared[unpacker.get<std::uint32_t>()]);
        local_.chosen[heard_.back()] ^= 1;
      }
  }

  void put_together() {
    std::array<std::int64_t, 5> sums{own_weight(local_), iterations_, improvements_, unproven_,
                                     stop_requested() || deadline_.passed() ? 1 : 0};
    const std::int64_t allotted = allotment();
    ranks_.sum(sums);
    ++progress_.round;
    progress_.weight = sums[0];
    progress_.allotted += allotted;
    progress_.iterations += sums[1];
    progress_.improvements += sums[2];
    progress_.quiet = sums[2] == 0 && sums[3] == 0 ? progress_.quiet + 1 : 0;
    stopped_ = sums[4] > 0;
  }

  Ranks& ranks_;
  LocalGraph& local_;
  const RoundsOptions& options_;
  const Deadline& deadline_;
  RoundsProgress& progress_;
  Searchers searchers_;
  std::int32_t first_own_, end_own_;    // of the searchers
  std::vector<BlockMemory>& memories_;  // of the own ones, in order
  std::vector<std::int64_t> sizes_;     // vertices in the blocks of each searcher
  std::int64_t vertices_ = 0;
  double usual_round_seconds_ = 0, round_seconds_ = 0;
  double extraction_seconds_ = 0;    // of the regions of this round
  std::vector<std::uint8_t> given_;  // the solution that the run began with
  std::int64_t given_weight_ = 0;
  // Vertices of the local graph that changed in this round: here, and on other ranks; and who did it, or
  // searchers_.count() for one of another rank, no_index for the others.
  std::vector<std::int32_t> changed_, heard_, changed_by_;
  std::int64_t iterations_ = 0, improvements_ = 0, unproven_ = 0;
  bool stopped_ = false;
};

}  // namespace

std::int64_t total_weight(Ranks& ranks, const LocalGraph& local) {
  std::array<std::int64_t, 1> sum{own_weight(local)};
  ranks.sum(sum);
  return sum[0];
}

void improve_in_rounds(Ranks& ranks, LocalGraph& local, const RoundsOptions& options, const Deadline& deadline,
                       const std::optional<std::vector<std::uint64_t>>& earlier, RoundsProgress& progress,
                       std::vector<BlockMemory>& memories,
                       const std::function<void(const RoundsProgress&, const RoundCosts&, bool)>& report) {
  const std::int32_t blocks = local.owners.first_of(local.rank + 1) - local.owners.first_of(local.rank);
  memories.resize(static_cast<std::size_t>(blocks));
  Rounds rounds(ranks, local, options, deadline, progress, memories);
  std::array<std::int64_t, 1> passed{deadline.passed() ? 1 : 0};
  ranks.maximum(passed);
  rounds.make_independent();
  rounds.keep_given();
  if (earlier) rounds.take_up(*earlier);
  if (options.search.reduce && passed[0] == 0 && rounds.goes_on()) rounds.reduce();
  while (passed[0] == 0 && rounds.goes_on()) {
    const RoundCosts costs = rounds.run_one();
    report(progress, costs, !rounds.goes_on());
  }
  rounds.complete();
}

}  // namespace hexpipe::lns_mpi
