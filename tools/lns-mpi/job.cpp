#include "tools/lns-mpi/job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "common/mwis/ground/search_log.hpp"
#include "common/mwis/ground/target_weight.hpp"
#include "common/run/progress.hpp"
#include "formats/choice/fragments_file.hpp"
#include "formats/streams/output.hpp"
#include "tools/lns-mpi/checkpoint.hpp"
#include "tools/lns-mpi/local_graph.hpp"
#include "tools/lns-mpi/shared_dual.hpp"
#include "tools/lns-mpi/source.hpp"

namespace hexpipe::lns_mpi {
namespace {

// How much all ranks sent together, and how much the busiest rank sent.
struct Sent {
  std::int64_t messages = 0, bytes = 0, most_messages = 0, most_bytes = 0;
};

Sent put_together(Ranks& ranks, const Traffic& own) {
  std::array<std::int64_t, 2> sums{own.messages, own.bytes}, most = sums;
  ranks.sum(sums);
  ranks.maximum(most);
  return {sums[0], sums[1], most[0], most[1]};
}

class Job {
 public:
  Job(Ranks& ranks, RunContext& context, const LnsMpiOptions& options)
      : ranks_(ranks), context_(context), options_(options), rounds_(options.rounds), deadline_(context.deadline()) {
    source_ = options_.parts.empty() ? whole_graph(context, options_.blocks) : graph_parts(context, options_.parts);
  }

  void run() {
    expect_same_options();
    ranks_.together([&] {
      log_.emplace(ranks_.is_first() ? context_.common.log_file : std::string());
      if (!ranks_.is_first()) return;
      if (!options_.fragments.empty()) fragments_.emplace(options_.fragments);
      if (!options_.certificate.empty()) certificate_.emplace(options_.certificate);
    });
    OwnedRows rows = source_->read(ranks_);
    const BlockOwners owners(source_->blocks(), ranks_.count());
    choose_target();
    const std::optional<std::vector<std::uint64_t>> earlier = resume(owners, rows);
    const std::int32_t overlap = choose_overlap(rows);
    LocalGraph local = make_local_graph(ranks_, owners, std::move(rows), overlap);
    setup_ = put_together(ranks_, ranks_.traffic());
    note_size(local);

    Packer improved;
    if (!options_.fragments.empty())
      rounds_.improved = [&](std::span<const std::int32_t> fragment) {
        std::vector<std::uint64_t> numbers;
        numbers.reserve(fragment.size());
        for (const std::int32_t v : fragment)
          if (local.keys[v] < source_->candidates()) numbers.push_back(local.keys[v]);
        if (!numbers.empty()) improved.put_all(std::span<const std::uint64_t>(numbers));
      };
    Step step("improving the choice");
    step_ = &step;
    // As in lns, the limit is for the search, without reading and cutting.
    deadline_ = context_.deadline();
    if (std::isfinite(deadline_.remaining())) step.usually_takes(deadline_.remaining());
    improve_in_rounds(ranks_, local, rounds_, deadline_, earlier, progress_, memories_,
                      [&](const RoundsProgress&, const RoundCosts& costs, bool last) {
                        report(costs);
                        if (!options_.fragments.empty()) write_fragments(improved.take());
                        if (checkpoint_ && (last || checkpoint_->is_due()))
                          checkpoint_->write(local, progress_, memories_);
                      });
    step_ = nullptr;
    if (options_.passes > 0) prove(local);
    finish(local);
  }

 private:
  // Ranks may be started one by one, each with its own command line. If these differed, some would wait for ever.
  void expect_same_options() {
    const std::string options = context_.options.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::string own =
        fmt::format("{} {} parts, checkpoint '{}', certificate '{}', fragments '{}'", options, options_.parts.size(),
                    options_.checkpoint, options_.certificate, options_.fragments);
    Bytes first(own.begin(), own.end());
    ranks_.broadcast(first);
    ranks_.together([&] {
      if (std::string(first.begin(), first.end()) != own)
        throw UsageError(fmt::format("rank {}: expected the options of the first rank, found others", ranks_.rank()));
    });
  }

  void choose_target() {
    if (!options_.target_gap) return;
    const std::optional<std::int64_t> bound = options_.known_bound ? options_.known_bound : source_->bound();
    ranks_.together([&] {
      rounds_.search.target = mwis::ground::target_weight(*options_.target_gap, bound, source_->weight_of_quads());
    });
  }

  // Where blocks are small and borders move by two edges, a rank that gives to others on all sides keeps a fourth of
  // its vertices for a while, and has as much time as the others. On 12,500 vertices a rank, one edge gains 0.2 % of
  // the weight; on 25,000 there is no difference. Under a limit of iterations, the result must not depend on the number
  // of ranks.
  std::int32_t choose_overlap(const OwnedRows& rows) {
    constexpr std::int64_t few = 20000;  // vertices of a rank
    if (options_.overlap > 0) return options_.overlap;
    std::array<std::int64_t, 1> vertices{std::ssize(rows.keys)};
    ranks_.sum(vertices);
    return context_.common.iterations || vertices[0] >= few * ranks_.count() ? 2 : 1;
  }

  // The keys that an earlier run chose.
  std::optional<std::vector<std::uint64_t>> resume(const BlockOwners& owners, const OwnedRows& rows) {
    if (options_.checkpoint.empty()) return std::nullopt;
    checkpoint_.emplace(ranks_, options_.checkpoint, options_.checkpoint_interval, fingerprint_of(ranks_, rows));
    auto earlier = checkpoint_->resume(owners, progress_, memories_);
    if (earlier) context_.note(fmt::format("goes on after round {} of {}", progress_.round, options_.checkpoint));
    return earlier;
  }

  void note_size(const LocalGraph& local) {
    std::array<std::int64_t, 4> sizes{0, local.vertex_count(), local.graph.edge_count(),
                                      static_cast<std::int64_t>(local.partners.size())};
    for (std::int32_t v = 0; v < local.vertex_count(); ++v) sizes[0] += local.owns(v) ? 1 : 0;
    ranks_.sum(sizes);
    std::array<std::int64_t, 1> most{local.vertex_count()};
    ranks_.maximum(most);
    context_.statistics["ranks"] = ranks_.count();
    context_.statistics["blocks"] = local.owners.blocks();
    context_.statistics["vertices"] = sizes[0];
    context_.statistics["held_vertices"] = sizes[1];
    context_.statistics["most_held_vertices"] = most[0];
    context_.statistics["held_edges"] = sizes[2];
    context_.statistics["partners"] = sizes[3];
    context_.statistics["setup_bytes"] = setup_.bytes;
    context_.note(fmt::format("{} ranks, {} blocks, {} vertices, {} held with halos, {} bytes sent for that",
                              ranks_.count(), local.owners.blocks(), sizes[0], sizes[1], setup_.bytes));
  }

  void report(const RoundCosts& costs) {
    const Sent sent = put_together(ranks_, costs.traffic);
    messages_ += sent.messages, bytes_ += sent.bytes;
    log_->record(deadline_.elapsed(), progress_.iterations, progress_.weight);
    show_progress();
    context_.note(
        fmt::format("round {}: weight {}, {:.2f} s of search, {:.2f} s of waiting; {} messages, {} bytes in all, {} "
                    "and {} a rank at most",
                    progress_.round, progress_.weight, costs.search_seconds, costs.wait_seconds, sent.messages,
                    sent.bytes, sent.most_messages, sent.most_bytes));
  }

  void show_progress() {
    if (!first_weight_) first_weight_ = progress_.weight;
    if (!step_->due()) return;
    const auto gain = static_cast<double>(progress_.weight - *first_weight_);
    step_->say(fmt::format("round {}, {:.2f} % gained since the first", progress_.round,
                           100 * gain / static_cast<double>(std::max<std::int64_t>(1, *first_weight_))));
  }

  // Fragments are written in the order of the blocks, whichever ranks have them.
  void write_fragments(Bytes own) {
    std::vector<Bytes> to(static_cast<std::size_t>(ranks_.count()));
    to.front() = std::move(own);
    const std::vector<Bytes> all = ranks_.all_to_all(std::move(to));
    ranks_.together([&] {
      for (const Bytes& from : all)
        for (Unpacker unpacker(from); fragments_ && !unpacker.at_end();) {
          std::vector<std::uint64_t> numbers;
          unpacker.get_all(numbers);
          fragments_->add(numbers);
        }
    });
  }

  void prove(const LocalGraph& local) {
    proof_ =
        prove_bound(ranks_, local, options_.passes, rounds_.search.seed, Deadline(), !options_.certificate.empty());
    const double gap = mwis::ground::gap_to(proof_->bound, progress_.weight);
    context_.statistics["bound"] = proof_->bound;
    context_.statistics["gap"] = gap;
    context_.note(fmt::format("at most {} is possible: gap {:.4f} %", proof_->bound, 100 * gap));
  }

  void finish(const LocalGraph& local) {
    std::array<std::int64_t, 1> chosen{0};
    for (std::int32_t v = 0; v < local.vertex_count(); ++v) chosen[0] += local.chosen[v] != 0 && local.owns(v) ? 1 : 0;
    ranks_.sum(chosen);
    context_.statistics["weight"] = progress_.weight;
    context_.statistics["chosen"] = chosen[0];
    context_.statistics["iterations"] = progress_.iterations;
    context_.statistics["improvements"] = progress_.improvements;
    context_.statistics["rounds"] = progress_.round;
    context_.statistics["round_messages"] = messages_;
    context_.statistics["round_bytes"] = bytes_;
    context_.note(fmt::format("{} chosen, weight {}, {} of {} fragments were improved in {} rounds", chosen[0],
                              progress_.weight, progress_.improvements, progress_.iterations, progress_.round));
    nlohmann::ordered_json details{
        {"weight", progress_.weight}, {"iterations", progress_.iterations}, {"rounds", progress_.round}};
    if (proof_) details["bound"] = proof_->bound;
    if (rounds_.search.free_running) details["depends_on_timing"] = true;
    const double seconds = deadline_.elapsed();
    source_->write(ranks_, local, details);
    // Written after the solution, so that a full disk does not cost it. The file that took longest comes first.
    ranks_.together([&] {
      if (certificate_) write_certificate();
      if (fragments_) fragments_->commit();
      log_->finish(seconds, progress_.iterations, progress_.weight);
    });
    if (!ranks_.is_first()) context_.common.stats_file.clear();
  }

  void write_certificate() {
    certificate_->print("bound {}\n", proof_->bound);
    for (const Bytes& prices : proof_->prices) certificate_->write({prices.data(), prices.size()});
    certificate_->commit();
  }

  Ranks& ranks_;
  RunContext& context_;
  const LnsMpiOptions& options_;
  RoundsOptions rounds_;
  Deadline deadline_;
  std::unique_ptr<Source> source_;
  std::optional<mwis::ground::SearchLog> log_;
  std::optional<formats::FragmentsFile> fragments_;  // of the first rank
  std::optional<formats::Output> certificate_;       // of the first rank, too
  std::optional<Checkpoint> checkpoint_;
  RoundsProgress progress_;
  Step* step_ = nullptr;  // while rounds are run
  std::vector<BlockMemory> memories_;
  std::optional<std::int64_t> first_weight_;  // after the first round
  std::optional<SharedProof> proof_;
  Sent setup_;
  std::int64_t messages_ = 0, bytes_ = 0;  // of all rounds, sent by all ranks
};

}  // namespace

void run_job(Ranks& ranks, RunContext& context, const LnsMpiOptions& options) {
  Job(ranks, context, options).run();
}

}  // namespace hexpipe::lns_mpi
