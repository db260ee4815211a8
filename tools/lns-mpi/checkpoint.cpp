#include "tools/lns-mpi/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "formats/pipeline/bundle.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"

namespace hexpipe::lns_mpi {
namespace {

// The numbers of RoundsProgress by name, for both directions.
template <class Progress, class Visit>
void visit_numbers(Progress& progress, Visit&& visit) {
  visit("round", progress.round), visit("weight", progress.weight), visit("allotted", progress.allotted);
  visit("iterations", progress.iterations), visit("improvements", progress.improvements);
  visit("quiet", progress.quiet);
}

// The content of checkpoint.json.
struct Title {
  RoundsProgress progress;
  std::int64_t ranks = 0, blocks = 0;
  std::uint64_t fingerprint = 0;
};

Title read_title(const std::string& path) {
  formats::Input input = formats::Input::open(path);
  const auto json = nlohmann::json::parse(input.read_all(), nullptr, false);
  Title title;
  const auto take = [&](const char* name, auto& number) {
    if (!json.is_object() || !json.contains(name) || !json[name].is_number_integer())
      throw DataError::at(path, "expected the title of a checkpoint with '{}', found something else", name);
    number = json[name].get<std::remove_reference_t<decltype(number)>>();
  };
  visit_numbers(title.progress, take);
  take("ranks", title.ranks), take("blocks", title.blocks), take("fingerprint", title.fingerprint);
  if (title.ranks < 1 || title.blocks < title.ranks)
    throw DataError::at(path, "expected at least a block for each rank, found {} and {}", title.blocks, title.ranks);
  return title;
}

// The state of one rank: rows of the same length for places, and a row of `operator_scores` for each of its blocks.
struct RankState {
  std::vector<std::uint64_t> chosen, keys;
  std::vector<std::int32_t> blocks;
  std::vector<std::array<std::uint32_t, 4>> places;    // tries by operator, and the size
  std::vector<std::array<double, 9>> operator_scores;  // credit, cost and yield by operator

  template <class Visit>
  void visit(Visit&& each) {
    each("chosen.npy", chosen), each("place_key.npy", keys), each("place_block.npy", blocks);
    each("place_state.npy", places), each("operator_scores.npy", operator_scores);
  }

  void add(std::int32_t block, const BlockMemory& memory) {
    for (const BlockMemory::Place& place : memory.places()) {
      keys.push_back(place.key);
      blocks.push_back(block);
      places.push_back({place.tries[0], place.tries[1], place.tries[2], place.size});
    }
    auto& row = operator_scores.emplace_back();
    for (std::size_t i = 0; i < memory.operator_scores().size(); ++i) {
      const mwis::local_search::OperatorScore& score = memory.operator_scores()[i];
      row[3 * i] = score.credit, row[3 * i + 1] = score.cost, row[3 * i + 2] = score.yield;
    }
  }
};

BlockMemory memory_of(std::int32_t block, const RankState& state, const std::array<double, 9>& row) {
  std::vector<BlockMemory::Place> places;
  for (std::size_t i = 0; i < state.keys.size(); ++i) {
    const auto& place = state.places[i];
    if (state.blocks[i] == block) places.push_back({state.keys[i], {place[0], place[1], place[2]}, place[3]});
  }
  mwis::local_search::OperatorScores scores;
  for (std::size_t i = 0; i < scores.size(); ++i) scores[i] = {row[3 * i], row[3 * i + 1], row[3 * i + 2]};
  return {std::move(places), scores};
}

bool is_sound(const RankState& state, std::size_t blocks) {
  const auto has_bounded_tries = [](const std::array<std::uint32_t, 4>& place) {
    return std::all_of(place.begin(), place.end() - 1,
                       [](auto tries) { return tries <= mwis::local_search::Schedule::most_tries; });
  };
  const auto is_finite = [](const std::array<double, 9>& row) {
    return std::ranges::all_of(row, [](double value) { return std::isfinite(value); });
  };
  return state.blocks.size() == state.keys.size() && state.places.size() == state.keys.size() &&
         state.operator_scores.size() == blocks && std::ranges::all_of(state.places, has_bounded_tries) &&
         std::ranges::all_of(state.operator_scores, is_finite);
}

RankState read_state(const std::string& path, std::size_t blocks) {
  formats::Input input = formats::Input::open(path);
  pipeline::BundleReader reader(input);
  RankState state;
  int found = 0, expected = 0;
  while (reader.next())
    state.visit([&]<class Row>(const char* name, std::vector<Row>& rows) {
      if (reader.name() != name) return;
      rows = reader.read_array<Row>();
      ++found;
    });
  state.visit([&](const char*, const auto&) { ++expected; });
  if (found != expected || !is_sound(state, blocks))
    throw DataError::at(path, "expected the state of {} blocks in this part of a checkpoint, found something else",
                        blocks);
  return state;
}

}  // namespace

Checkpoint::Checkpoint(Ranks& ranks, std::string directory, double seconds_between, std::uint64_t fingerprint)
    : ranks_(ranks),
      directory_(std::move(directory)),
      seconds_between_(seconds_between),
      fingerprint_(fingerprint),
      next_(seconds_between) {
  ranks.together([&] {
    std::error_code error;
    if (ranks.is_first()) std::filesystem::create_directories(directory_, error);
    if (error) throw DataError::at(directory_.string(), "cannot make this directory: {}", error.message());
  });
}

std::filesystem::path Checkpoint::folder_of(std::int64_t round) const {
  return directory_ / fmt::format("round-{}", round);
}

std::optional<std::vector<std::uint64_t>> Checkpoint::resume(const BlockOwners& owners, RoundsProgress& progress,
                                                             std::vector<BlockMemory>& memories) {
  const std::string path = (directory_ / "checkpoint.json").string();
  std::array<std::int64_t, 1> there{ranks_.is_first() && std::filesystem::exists(path) ? 1 : 0};
  ranks_.sum(there);
  if (there[0] == 0) return std::nullopt;
  std::vector<std::uint64_t> chosen;
  ranks_.together([&] {
    const Title title = read_title(path);
    if (title.fingerprint != fingerprint_ || title.blocks != owners.blocks())
      throw DataError::at(path, "expected a checkpoint of this graph and its blocks, found one of another");
    // Another number of ranks may have written it; each has the blocks of some of them.
    const BlockOwners writers(owners.blocks(), static_cast<int>(title.ranks));
    const std::int32_t first = owners.first_of(ranks_.rank()), last = owners.first_of(ranks_.rank() + 1) - 1;
    memories.clear();
    for (int writer = writers.rank_of(first); writer <= writers.rank_of(last); ++writer) {
      const std::int32_t begin = writers.first_of(writer), end = writers.first_of(writer + 1);
      const RankState state = read_state((folder_of(title.progress.round) / fmt::format("{:04}.tar", writer)).string(),
                                         static_cast<std::size_t>(end - begin));
      chosen.insert(chosen.end(), state.chosen.begin(), state.chosen.end());
      for (std::int32_t block = std::max(first, begin); block < std::min(last + 1, end); ++block)
        memories.push_back(memory_of(block, state, state.operator_scores[block - begin]));
    }
    std::ranges::sort(chosen);
    progress = title.progress;
    round_ = title.progress.round;
  });
  return chosen;
}

// Removes the round before, and files that a run left when it was killed while writing. A failure here does no harm.
void Checkpoint::remove_rounds_but(const std::filesystem::path& kept) const {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory_, ignored))
    if (entry.path() != kept && entry.path().filename().string().starts_with("round-"))
      std::filesystem::remove_all(entry.path(), ignored);
}

bool Checkpoint::is_due() {
  std::array<std::int64_t, 1> due{ranks_.is_first() && watch_.seconds() >= next_ ? 1 : 0};
  ranks_.sum(due);
  return due[0] != 0;
}

void Checkpoint::write(const LocalGraph& local, const RoundsProgress& progress,
                       const std::vector<BlockMemory>& memories) {
  if (round_ == progress.round) return;
  next_ = watch_.seconds() + seconds_between_;
  const std::filesystem::path folder = folder_of(progress.round);
  ranks_.together([&] {
    std::error_code error;
    if (ranks_.is_first()) std::filesystem::create_directory(folder, error);
    if (error) throw DataError::at(folder.string(), "cannot make this directory: {}", error.message());
  });
  ranks_.together([&] {
    RankState state;
    for (std::int32_t v = 0; v < local.vertex_count(); ++v)
      if (local.chosen[v] != 0 && local.owns(v)) state.chosen.push_back(local.keys[v]);
    for (std::int32_t block = local.owners.first_of(local.rank); const BlockMemory& memory : memories)
      state.add(block++, memory);
    formats::Output output((folder / fmt::format("{:04}.tar", ranks_.rank())).string());
    pipeline::BundleWriter writer(output, false);
    state.visit([&](const char* name, const auto& rows) { writer.add_array(name, rows); });
    writer.close();
    output.commit();
  });
  ranks_.together([&] {
    if (!ranks_.is_first()) return;
    auto title = nlohmann::ordered_json::object();
    visit_numbers(progress, [&](const char* name, std::int64_t number) { title[name] = number; });
    title["ranks"] = ranks_.count();
    title["blocks"] = local.owners.blocks();
    title["fingerprint"] = fingerprint_;
    formats::Output output((directory_ / "checkpoint.json").string());
    output.write(title.dump(2) + "\n");
    output.commit();
    remove_rounds_but(folder);
  });
  round_ = progress.round;
}

}  // namespace hexpipe::lns_mpi
