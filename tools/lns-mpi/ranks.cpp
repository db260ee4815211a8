#include "tools/lns-mpi/ranks.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "common/run/error.hpp"
#include "common/run/messages.hpp"

namespace hexpipe::lns_mpi {
namespace {

// MPI counts in int, so longer messages are split.
constexpr std::size_t longest_message = std::size_t{1} << 30;
constexpr int tag = 1;

// A few tries follow each other at once. Then the pauses begin at a tenth of a millisecond, far below the time waited
// so far and far above a switch of processes. So a rank that waits while the first one reads and cuts a graph takes
// almost no processor time.
void pause(int tries) {
  constexpr int at_once = 200;
  constexpr int shortest = 100, longest = 10000;  // microseconds
  if (tries < at_once)
    sched_yield();
  else
    usleep(static_cast<useconds_t>(std::min(shortest + tries - at_once, longest)));
}

}  // namespace

std::optional<int> launched_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (const char* const text = std::getenv(name)) return std::atoi(text);
  return std::nullopt;
}

Ranks::Ranks() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
}

Ranks::~Ranks() {
  MPI_Finalize();
}

bool Ranks::were_started() {
  int started = 0;
  MPI_Initialized(&started);
  return started != 0;
}

void Ranks::abandon() {
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

void Ranks::wait() {
  int done = 0;
  for (int tries = 0; done == 0; ++tries) {
    MPI_Testall(static_cast<int>(requests_.size()), requests_.data(), &done, MPI_STATUSES_IGNORE);
    if (done == 0) pause(tries);
  }
  requests_.clear();
}

void Ranks::agree(Failure failure, const std::string& error) {
  // The first rank that failed, and how. Each rank has its own number, greater for ranks that come before.
  const std::int64_t behind = count_ - rank_;
  std::array<std::int64_t, 1> first{failure == Failure::none ? 0 : 2 * behind + (failure == Failure::usage ? 1 : 0)};
  maximum(first);
  if (first[0] == 0) return;
  silence_messages(first[0] / 2 != behind);
  throw ErrorOfAll(error, first[0] % 2 == 1);
}

void Ranks::sum(std::span<std::int64_t> values) {
  ++traffic_.collectives;
  requests_.emplace_back();
  MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD,
                 &requests_.back());
  wait();
}

void Ranks::maximum(std::span<std::int64_t> values) {
  ++traffic_.collectives;
  requests_.emplace_back();
  MPI_Iallreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD,
                 &requests_.back());
  wait();
}

void Ranks::broadcast(Bytes& bytes) {
  ++traffic_.collectives;
  auto size = static_cast<std::int64_t>(bytes.size());
  requests_.emplace_back();
  MPI_Ibcast(&size, 1, MPI_INT64_T, 0, MPI_COMM_WORLD, &requests_.back());
  wait();
  bytes.resize(static_cast<std::size_t>(size));
  requests_.emplace_back();
  MPI_Ibcast(bytes.data(), static_cast<int>(size), MPI_CHAR, 0, MPI_COMM_WORLD, &requests_.back());
  wait();
}

void Ranks::post_send(int to, const Bytes& bytes) {
  ++traffic_.messages;
  traffic_.bytes += static_cast<std::int64_t>(bytes.size());
  for (std::size_t at = 0; at < bytes.size(); at += longest_message) {
    requests_.emplace_back();
    MPI_Isend(bytes.data() + at, static_cast<int>(std::min(longest_message, bytes.size() - at)), MPI_CHAR, to, tag,
              MPI_COMM_WORLD, &requests_.back());
  }
}

// Receives into all bytes of `bytes`.
void Ranks::post_receive(int from, Bytes& bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += longest_message) {
    requests_.emplace_back();
    MPI_Irecv(bytes.data() + at, static_cast<int>(std::min(longest_message, bytes.size() - at)), MPI_CHAR, from, tag,
              MPI_COMM_WORLD, &requests_.back());
  }
}

std::vector<Bytes> Ranks::all_to_all(std::vector<Bytes> to) {
  std::vector<std::int64_t> sizes(to.size()), coming(to.size());
  std::ranges::transform(to, sizes.begin(), [](const Bytes& bytes) { return static_cast<std::int64_t>(bytes.size()); });
  ++traffic_.collectives;
  requests_.emplace_back();
  MPI_Ialltoall(sizes.data(), 1, MPI_INT64_T, coming.data(), 1, MPI_INT64_T, MPI_COMM_WORLD, &requests_.back());
  wait();
  std::vector<Bytes> from(to.size());
  for (int r = 0; r < count_; ++r) {
    if (r == rank_) continue;
    from[r].resize(static_cast<std::size_t>(coming[r]));
    post_receive(r, from[r]);
  }
  for (int r = 0; r < count_; ++r)
    if (r != rank_ && !to[r].empty()) post_send(r, to[r]);
  wait();
  from[rank_] = std::move(to[rank_]);
  return from;
}

std::vector<Bytes> Ranks::all_to_all(std::span<const int> partners, const std::vector<Bytes>& to) {
  std::vector<std::int64_t> sizes(partners.size()), coming(partners.size());
  for (std::size_t i = 0; i < partners.size(); ++i) {
    sizes[i] = static_cast<std::int64_t>(to[i].size());
    for (const bool sends : {false, true}) {
      requests_.emplace_back();
      if (sends)
        MPI_Isend(&sizes[i], 1, MPI_INT64_T, partners[i], tag, MPI_COMM_WORLD, &requests_.back());
      else
        MPI_Irecv(&coming[i], 1, MPI_INT64_T, partners[i], tag, MPI_COMM_WORLD, &requests_.back());
    }
    ++traffic_.messages;
    traffic_.bytes += static_cast<std::int64_t>(sizeof sizes[i]);
  }
  wait();
  std::vector<Bytes> from(partners.size());
  for (std::size_t i = 0; i < partners.size(); ++i) {
    from[i].resize(static_cast<std::size_t>(coming[i]));
    post_receive(partners[i], from[i]);
    if (!to[i].empty()) post_send(partners[i], to[i]);
  }
  wait();
  return from;
}

void Ranks::send(int to, const Bytes& bytes) {
  ++traffic_.messages;
  traffic_.bytes += static_cast<std::int64_t>(sizeof(std::int64_t));
  const auto size = static_cast<std::int64_t>(bytes.size());
  requests_.emplace_back();
  MPI_Isend(&size, 1, MPI_INT64_T, to, tag, MPI_COMM_WORLD, &requests_.back());
  post_send(to, bytes);
  wait();
}

Bytes Ranks::receive(int from) {
  std::int64_t size = 0;
  requests_.emplace_back();
  MPI_Irecv(&size, 1, MPI_INT64_T, from, tag, MPI_COMM_WORLD, &requests_.back());
  wait();
  Bytes bytes(static_cast<std::size_t>(size));
  post_receive(from, bytes);
  wait();
  return bytes;
}

}  // namespace hexpipe::lns_mpi
