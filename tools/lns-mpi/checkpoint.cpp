#include "tools/lns-mpi/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "formats/bundle.hpp"
#include "formats/input.hpp"
#include "formats/output.hpp"

namespace hexpipe {
namespace {

constexpr const char* chosen_member = "chosen.npy";

// The numbers of RoundsProgress by name, for both directions.
template <class Progress, class Visit>
void visit_numbers(Progress& progress, Visit&& visit) {
  visit("round", progress.round), visit("weight", progress.weight), visit("allotted", progress.allotted);
  visit("iterations", progress.iterations), visit("improvements", progress.improvements);
  visit("quiet", progress.quiet);
}

// What checkpoint.json says.
struct Title {
  RoundsProgress progress;
  std::int64_t ranks = 0, blocks = 0;
  std::uint64_t fingerprint = 0;
};

Title read_title(const std::string& path) {
  Input input = Input::open(path);
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

std::vector<std::uint64_t> read_chosen(const std::string& path) {
  Input input = Input::open(path);
  BundleReader reader(input);
  while (reader.next())
    if (reader.name() == chosen_member) return reader.read_array<std::uint64_t>();
  throw DataError::at(path, "expected {} in this part of a checkpoint, found none", chosen_member);
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

bool Checkpoint::resume(const BlockOwners& owners, OwnedRows& rows, RoundsProgress& progress) {
  const std::string path = (directory_ / "checkpoint.json").string();
  std::array<std::int64_t, 1> there{ranks_.is_first() && std::filesystem::exists(path) ? 1 : 0};
  ranks_.sum(there);
  if (there[0] == 0) return false;
  ranks_.together([&] {
    const Title title = read_title(path);
    if (title.fingerprint != fingerprint_ || title.blocks != owners.blocks())
      throw DataError::at(path, "expected a checkpoint of this graph and its blocks, found one of another");
    // Another number of ranks may have written it; each has the blocks of some of them.
    const BlockOwners writers(owners.blocks(), static_cast<int>(title.ranks));
    const std::int32_t first = owners.first_of(ranks_.rank()), last = owners.first_of(ranks_.rank() + 1) - 1;
    std::vector<std::uint8_t> chosen(rows.keys.size(), 0);
    for (int writer = writers.rank_of(first); writer <= writers.rank_of(last); ++writer)
      for (const std::uint64_t key :
           read_chosen((folder_of(title.progress.round) / fmt::format("{:04}.tar", writer)).string())) {
        const auto found = std::ranges::lower_bound(rows.keys, key);
        if (found != rows.keys.end() && *found == key) chosen[found - rows.keys.begin()] = 1;
      }
    rows.chosen = std::move(chosen);
    progress = title.progress;
    round_ = title.progress.round;
  });
  return true;
}

// The one before, and what a run left that was killed while it wrote. Where that fails it does no harm.
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

void Checkpoint::write(const Piece& piece, const RoundsProgress& progress) {
  if (round_ == progress.round) return;
  next_ = watch_.seconds() + seconds_between_;
  const std::filesystem::path folder = folder_of(progress.round);
  ranks_.together([&] {
    std::error_code error;
    if (ranks_.is_first()) std::filesystem::create_directory(folder, error);
    if (error) throw DataError::at(folder.string(), "cannot make this directory: {}", error.message());
  });
  ranks_.together([&] {
    std::vector<std::uint64_t> chosen;
    for (std::int32_t v = 0; v < piece.vertex_count(); ++v)
      if (piece.chosen[v] != 0 && piece.owns(v)) chosen.push_back(piece.keys[v]);
    Output output((folder / fmt::format("{:04}.tar", ranks_.rank())).string());
    BundleWriter writer(output, false);
    writer.add_array(chosen_member, chosen);
    writer.close();
    output.commit();
  });
  ranks_.together([&] {
    if (!ranks_.is_first()) return;
    nlohmann::ordered_json title;
    visit_numbers(progress, [&](const char* name, std::int64_t number) { title[name] = number; });
    title["ranks"] = ranks_.count();
    title["blocks"] = piece.owners.blocks();
    title["fingerprint"] = fingerprint_;
    Output output((directory_ / "checkpoint.json").string());
    output.write(title.dump(2) + "\n");
    output.commit();
    remove_rounds_but(folder);
  });
  round_ = progress.round;
}

}  // namespace hexpipe
