#include "tools/lns-mpi/local_graph.hpp"

#include <tsl/robin_set.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace hexpipe::lns_mpi {
namespace {

// Finds places in an ascending list by its highest bits.
class KeyIndex {
 public:
  explicit KeyIndex(const std::vector<std::uint64_t>& keys) : keys_(keys) {
    if (keys.empty()) return;
    const std::uint64_t range = keys.back() - keys.front();
    while ((range >> shift_) >= keys.size()) ++shift_;
    starts_.assign(static_cast<std::size_t>(range >> shift_) + 2, 0);
    for (const std::uint64_t key : keys) ++starts_[bucket(key) + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  }

  std::optional<std::int32_t> find(std::uint64_t key) const {
    if (keys_.empty() || key < keys_.front() || key > keys_.back()) return std::nullopt;
    const auto begin = keys_.begin() + starts_[bucket(key)], end = keys_.begin() + starts_[bucket(key) + 1];
    const auto found = std::lower_bound(begin, end, key);
    if (found == end || *found != key) return std::nullopt;
    return static_cast<std::int32_t>(found - keys_.begin());
  }

 private:
  std::size_t bucket(std::uint64_t key) const { return static_cast<std::size_t>((key - keys_.front()) >> shift_); }

  const std::vector<std::uint64_t>& keys_;
  int shift_ = 0;
  std::vector<std::int32_t> starts_;
};

// The standard's hash of a number is the number itself, whose low bits are only the block.
struct MixedHash {
  std::size_t operator()(std::uint64_t key) const {
    key *= 0x9e3779b97f4a7c15u;
    return key ^ (key >> 32);
  }
};

// A vertex of the rank's own near which another block begins.
struct Reach {
  std::int32_t vertex, block, distance;
};

// Breadth first from each block over its borders, in steps of one edge, on all ranks at once.
std::vector<Reach> find_near_blocks(Ranks& ranks, const BlockOwners& owners, const OwnedRows& rows,
                                    const KeyIndex& index, std::int32_t farthest) {
  std::vector<Reach> reached;
  tsl::robin_set<std::uint64_t, MixedHash> seen;
  std::vector<std::pair<std::int32_t, std::int32_t>> frontier, next;  // vertex and block
  const auto reach = [&](std::int32_t v, std::int32_t block, std::int32_t distance) {
    const std::uint64_t both = (static_cast<std::uint64_t>(v) << 32) | static_cast<std::uint32_t>(block);
    if (!seen.insert(both).second) return;
    reached.push_back({v, block, distance});
    next.emplace_back(v, block);
  };
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(rows.keys.size()); ++v) {
    const auto begin = rows.neighbour_blocks.begin() + rows.offsets[v];
    const auto end = rows.neighbour_blocks.begin() + rows.offsets[v + 1];
    if (std::any_of(begin, end, [&](std::int32_t block) { return block != rows.blocks[v]; }))
      frontier.emplace_back(v, rows.blocks[v]);
  }
  for (std::int32_t distance = 1; distance <= farthest; ++distance) {
    std::vector<Packer> to(static_cast<std::size_t>(ranks.count()));
    for (const auto& [v, block] : frontier)
      for (std::int64_t e = rows.offsets[v]; e < rows.offsets[v + 1]; ++e) {
        if (rows.neighbour_blocks[e] == block) continue;
        const int rank = owners.rank_of(rows.neighbour_blocks[e]);
        if (rank == ranks.rank()) {
          reach(*index.find(rows.neighbours[e]), block, distance);
        } else {
          to[rank].put(rows.neighbours[e]);
          to[rank].put(block);
        }
      }
    std::vector<Bytes> bytes;
    bytes.reserve(to.size());
    for (Packer& packer : to) bytes.push_back(packer.take());
    for (const Bytes& from : ranks.all_to_all(std::move(bytes)))
      for (Unpacker unpacker(from); !unpacker.at_end();) {
        const auto key = unpacker.get<std::uint64_t>();
        const auto block = unpacker.get<std::int32_t>();
        if (const auto v = index.find(key)) reach(*v, block, distance);
      }
    frontier = std::move(next);
    next.clear();
  }
  std::ranges::sort(reached, {}, [](const Reach& r) { return std::pair(r.vertex, r.block); });
  return reached;
}

// Vertices as they travel, with as much of their rows as the receiver needs.
struct Held {
  std::vector<std::uint64_t> keys, neighbours;
  std::vector<std::int32_t> blocks, near_counts, degrees;
  std::vector<std::int64_t> weights;
  std::vector<std::uint8_t> chosen;
  std::vector<NearBlock> near;

  void add(const OwnedRows& rows, std::int32_t v, std::span<const Reach> reaches, bool with_row) {
    keys.push_back(rows.keys[v]);
    blocks.push_back(rows.blocks[v]);
    weights.push_back(rows.weights[v]);
    chosen.push_back(rows.chosen[v]);
    near_counts.push_back(static_cast<std::int32_t>(reaches.size()));
    for (const Reach& reach : reaches) near.push_back({reach.block, reach.distance});
    const std::int64_t begin = rows.offsets[v], end = with_row ? rows.offsets[v + 1] : begin;
    neighbours.insert(neighbours.end(), rows.neighbours.begin() + begin, rows.neighbours.begin() + end);
    degrees.push_back(static_cast<std::int32_t>(end - begin));
  }
  template <class Visit>
  void visit(Visit&& each) {
    each(keys), each(neighbours), each(blocks), each(near_counts), each(degrees), each(weights), each(chosen);
    each(near);
  }
  Bytes pack() {
    if (keys.empty()) return {};
    Packer packer;
    visit([&]<class T>(const std::vector<T>& values) { packer.put_all(std::span<const T>(values)); });
    return packer.take();
  }
  void append(const Bytes& bytes) {
    if (bytes.empty()) return;
    Unpacker unpacker(bytes);
    visit([&](auto& values) { unpacker.get_all(values); });
  }
};

// Each vertex to the ranks that have a block near it.
std::vector<Bytes> pack_halos(const Ranks& ranks, const BlockOwners& owners, const OwnedRows& rows,
                              std::span<const Reach> reached, std::int32_t overlap) {
  std::vector<Held> to(static_cast<std::size_t>(ranks.count()));
  std::vector<std::pair<int, std::int32_t>> nearest;  // of each rank
  for (std::size_t begin = 0, end = 0; begin < reached.size(); begin = end) {
    const std::int32_t v = reached[begin].vertex;
    nearest.clear();
    for (; end < reached.size() && reached[end].vertex == v; ++end)
      nearest.emplace_back(owners.rank_of(reached[end].block), reached[end].distance);
    std::ranges::sort(nearest);
    int last = ranks.rank();
    for (const auto& [rank, distance] : nearest) {
      if (rank == last || rank == ranks.rank()) continue;
      last = rank;
      to[rank].add(rows, v, reached.subspan(begin, end - begin), distance <= overlap);
    }
  }
  std::vector<Bytes> packed;
  packed.reserve(to.size());
  for (Held& held : to) packed.push_back(held.pack());
  return packed;
}

// Everything that the rank owns, in addition to what was received.
void append_own(const OwnedRows& rows, std::span<const Reach> reached, Held& held) {
  std::size_t next = 0;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(rows.keys.size()); ++v) {
    const std::size_t begin = next;
    while (next < reached.size() && reached[next].vertex == v) ++next;
    held.add(rows, v, reached.subspan(begin, next - begin), true);
  }
}

std::vector<std::int64_t> begins_of(const std::vector<std::int32_t>& counts) {
  std::vector<std::int64_t> begins(counts.size() + 1, 0);
  std::inclusive_scan(counts.begin(), counts.end(), begins.begin() + 1, std::plus<>(), std::int64_t{0});
  return begins;
}

// Vertices are in the order of the keys, neighbours by their places in it.
void build_rows(const Held& held, LocalGraph& local) {
  std::vector<std::int32_t> order(held.keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::int32_t i) { return held.keys[i]; });
  const std::vector<std::int64_t> rows = begins_of(held.degrees), nears = begins_of(held.near_counts);
  for (const std::int32_t i : order) local.keys.push_back(held.keys[i]);
  const KeyIndex index(local.keys);
  local.graph.neighbours.reserve(held.neighbours.size());
  for (const std::int32_t i : order) {
    local.block.push_back(held.blocks[i]);
    local.chosen.push_back(held.chosen[i]);
    local.graph.weights.push_back(held.weights[i]);
    for (std::int64_t e = rows[i]; e < rows[i + 1]; ++e)
      local.graph.neighbours.push_back(*index.find(held.neighbours[e]));
    local.graph.offsets.push_back(static_cast<std::int64_t>(local.graph.neighbours.size()));
    local.near.insert(local.near.end(), held.near.begin() + nears[i], held.near.begin() + nears[i + 1]);
    local.near_offsets.push_back(static_cast<std::int64_t>(local.near.size()));
  }
}

std::vector<LocalGraph::Partner> find_partners(const LocalGraph& local) {
  std::vector<std::vector<std::int32_t>> shared(static_cast<std::size_t>(local.owners.ranks()));
  const auto add = [&](std::int32_t v, std::int32_t block) {
    const int rank = local.owners.rank_of(block);
    if (rank != local.rank && (shared[rank].empty() || shared[rank].back() != v)) shared[rank].push_back(v);
  };
  for (std::int32_t v = 0; v < local.vertex_count(); ++v) {
    add(v, local.block[v]);
    for (const NearBlock& near : local.near_of(v)) add(v, near.block);
  }
  std::vector<LocalGraph::Partner> partners;
  for (int r = 0; r < local.owners.ranks(); ++r)
    if (!shared[r].empty()) partners.push_back({r, std::move(shared[r])});
  return partners;
}

}  // namespace

LocalGraph make_local_graph(Ranks& ranks, const BlockOwners& owners, OwnedRows rows, std::int32_t overlap) {
  expect_agreement(ranks, owners, rows);
  Held held;
  {
    const KeyIndex index(rows.keys);
    const std::vector<Reach> reached = find_near_blocks(ranks, owners, rows, index, overlap + 1);
    std::vector<Bytes> came = ranks.all_to_all(pack_halos(ranks, owners, rows, reached, overlap));
    // A rank needs most memory here: nothing grows, and each message is freed when it has been copied.
    std::size_t most = rows.neighbours.size();
    for (const Bytes& bytes : came) most += bytes.size() / sizeof(std::uint64_t);
    held.neighbours.reserve(most);
    append_own(rows, reached, held);
    rows = {};
    for (Bytes& bytes : came) {
      held.append(bytes);
      bytes = Bytes();
    }
  }
  LocalGraph local;
  local.owners = owners;
  local.rank = ranks.rank();
  local.overlap = overlap;
  build_rows(held, local);
  local.decided.assign(local.keys.size(), 0);
  local.partners = find_partners(local);
  return local;
}

}  // namespace hexpipe::lns_mpi
