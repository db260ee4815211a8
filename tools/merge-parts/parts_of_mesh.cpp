#include "tools/merge-parts/merges.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/run/error.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/members.hpp"
#include "formats/pipeline/surface_bundle.hpp"
#include "tools/merge-parts/history.hpp"
#include "tools/merge-parts/interleaving.hpp"
#include "tools/merge-parts/part_numbers.hpp"

namespace hexpipe::merge_parts {
namespace {

// Rows of vertices, tets or candidates in the numbers of the whole; no_index stays.
class Renumber {
 public:
  // Throws DataError when the numbers are still to come.
  Renumber(PartReaders& parts, const Numbers& numbers) : parts_(parts), numbers_(numbers) {
    check_numbers_are_there(parts.front(), parts.size(), numbers.size());
  }

  std::int32_t operator()(std::size_t part, std::int32_t item) const {
    if (item < 0) return item;
    if (static_cast<std::size_t>(item) >= numbers_[part].size())
      throw DataError::at(parts_[part].bundle_name(), "expected items below {}, found {}", numbers_[part].size(), item);
    return numbers_[part][item];
  }
  template <std::size_t N>
  std::array<std::int32_t, N> operator()(std::size_t part, std::array<std::int32_t, N> row) const {
    for (std::int32_t& item : row) item = (*this)(part, item);
    return row;
  }

 private:
  const PartReaders& parts_;
  const Numbers& numbers_;
};

class Merger {
 public:
  Merger(PartReaders& parts, pipeline::BundleWriter& out) : parts_(parts), out_(out), keys_(parts.size()) {}

  void merge() {
    check_heads();
    for (next(parts_); !common_member(parts_).empty(); next(parts_)) {
      const std::string name = common_member(parts_);
      if (pipeline::is_history_entry(name))
        history_.take(parts_);
      else
        merge_member(name);
    }
    history_.write_before(std::nullopt, counts_, out_);
  }

 private:
  // All k parts of one mesh, each once.
  void check_heads() {
    std::map<std::int32_t, std::size_t> found;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      pipeline::StageData data;
      if (!parts_[p].at_member() || !pipeline::read_part_member(parts_[p].bundle(), data, nullptr) || !data.part)
        throw DataError::at(parts_[p].bundle_name(), "expected a part of a mesh as {}, found a whole",
                            parts_.front().bundle_name());
      heads_.push_back(std::move(*data.part));
      titles_.push_back(heads_[p].part);
      const MeshPart& first = heads_.front();
      if (heads_[p].whole != first.whole)
        throw DataError::at(parts_[p].bundle_name(), "expected a part of the same mesh as {}, found one of another",
                            parts_.front().bundle_name());
      if (heads_[p].parts != first.parts)
        throw DataError::at(parts_[p].bundle_name(), "expected one of {} parts as {}, found {}", first.parts,
                            parts_.front().bundle_name(), title_of(heads_[p]));
      const auto [twin, is_first] = found.emplace(heads_[p].part, p);
      if (!is_first)
        throw DataError::at(parts_[p].bundle_name(), "expected each part once, found {} as in {}", title_of(heads_[p]),
                            parts_[twin->second].bundle_name());
    }
    for (std::int32_t part = 0; part < heads_.front().parts; ++part)
      if (!found.contains(part))
        throw DataError(fmt::format("expected all {} parts, found no part {}", heads_.front().parts, part));
  }

  void merge_member(const std::string& name) {
    if (take_about_part(name) || merge_names(name)) return;
    // All parts have the surface of the whole.
    if (pipeline::is_surface_member(name)) return copy_common(parts_, out_);
    const auto role = pipeline::role_of_member(name);
    if (role) history_.write_before(*role, counts_, out_);
    if (!merge_mesh(name) && !merge_candidates(name) && !merge_graph(name) && !merge_solution(name))
      throw DataError::at(parts_.front().bundle().where(),
                          "expected members of mesh, candidates, graph and solution, found one that cannot be merged");
  }

  // Takes a member that only parts have; false if it is another member.
  bool take_about_part(const std::string& name);
  bool merge_names(const std::string& name);
  bool merge_mesh(const std::string& name);
  void merge_ridges();
  bool merge_candidates(const std::string& name);
  bool merge_graph(const std::string& name);
  bool merge_solution(const std::string& name);
  const CandidateOrder& candidates();

  Renumber to_points() const { return {parts_, point_numbers_}; }
  Renumber to_tets() const { return {parts_, tet_numbers_}; }

  PartReaders& parts_;
  pipeline::BundleWriter& out_;
  std::vector<MeshPart> heads_;
  std::vector<std::int32_t> titles_;
  MergedHistory history_;
  MergedCounts counts_;
  Numbers point_numbers_, tet_numbers_;
  Interleaving points_, tets_, triangles_;
  std::vector<CandidateKeys> keys_;
  std::optional<CandidateOrder> candidates_;
  ListLengths lengths_;  // of the member of ends that was read last
};

bool Merger::take_about_part(const std::string& name) {
  const MeshFingerprint& whole = heads_.front().whole;
  if (name == "mesh/point_number.npy") {
    point_numbers_ = read_numbers(parts_, whole.points);
    points_ = interleave(point_numbers_, whole.points, "point");
  } else if (name == "mesh/tet_number.npy") {
    tet_numbers_ = read_numbers(parts_, whole.tets);
    tets_ = interleave(tet_numbers_, whole.tets, "tet");
  } else if (name == "mesh/triangle_number.npy") {
    triangles_ = interleave(read_numbers(parts_, whole.triangles), whole.triangles, "triangle");
  } else if (name == "candidates/key.npy" || name == "candidates/part.npy") {
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (name == "candidates/key.npy")
        keys_[p].key = parts_[p].bundle().read_array<std::uint64_t>();
      else
        keys_[p].part = parts_[p].bundle().read_array<std::int32_t>();
  } else {
    return name == "mesh/point_part.npy" || name == "mesh/tet_part.npy" || name == "mesh/tet_turned.npy";
  }
  return true;
}

// All parts have the names of the whole.
bool Merger::merge_names(const std::string& name) {
  if (name != formats::names_member) return false;
  const std::string text = parts_.front().bundle().read_text();
  for (std::size_t p = 1; p < parts_.size(); ++p)
    if (parts_[p].bundle().read_text() != text)
      throw DataError::at(parts_[p].bundle().where(), "expected the same names as in {}, found others",
                          parts_.front().bundle_name());
  out_.add_text(name, text);
  return true;
}

bool Merger::merge_mesh(const std::string& name) {
  if (name == "mesh/points.npy")
    merge_rows<Vec3>(parts_, points_, out_, unchanged);
  else if (name == "mesh/tets.npy")
    merge_rows<Tet>(parts_, tets_, out_, to_points());
  else if (name == "mesh/tet_tags.npy")
    merge_rows<std::int32_t>(parts_, tets_, out_, unchanged);
  else if (name == "mesh/triangles.npy")
    merge_rows<Triangle>(parts_, triangles_, out_, to_points());
  else if (name == "mesh/triangle_tags.npy")
    merge_rows<std::int32_t>(parts_, triangles_, out_, unchanged);
  else if (name == "mesh/ridges.npy")
    merge_ridges();
  else if (name == "mesh/dislocations.npy")  // all parts have those of the whole
    copy_common(parts_, out_);
  else
    return false;
  return true;
}

// A part has the ridges between its points; the whole lists them by their vertices (medit.cpp).
void Merger::merge_ridges() {
  const Renumber renumber = to_points();
  std::vector<Ridge> ridges;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (const Ridge& ridge : parts_[p].bundle().read_array<Ridge>()) ridges.push_back(renumber(p, ridge));
  std::ranges::sort(ridges);
  ridges.erase(std::ranges::unique(ridges).begin(), ridges.end());
  out_.add_array("mesh/ridges.npy", ridges);
}

const CandidateOrder& Merger::candidates() {
  if (!candidates_) {
    candidates_ = order_by_keys(keys_, titles_, parts_);
    keys_ = std::vector<CandidateKeys>(parts_.size());
  }
  return *candidates_;
}

bool Merger::merge_candidates(const std::string& name) {
  if (!name.starts_with("candidates/")) return false;
  const Interleaving& own = candidates().own;
  if (name == "candidates/vertices.npy")
    merge_rows<std::array<Vertex, 8>>(parts_, own, out_, to_points());
  else if (name == "candidates/kind.npy")
    merge_rows<std::uint8_t>(parts_, own, out_, unchanged);
  else if (name == "candidates/quality.npy" || name == "candidates/volume.npy")
    merge_rows<double>(parts_, own, out_, unchanged);
  else if (name == "candidates/tet_offsets.npy" || name == "candidates/boundary_tet_offsets.npy")
    lengths_ = merge_offsets(parts_, own, out_);
  else if (name == "candidates/tets.npy" || name == "candidates/boundary_tets.npy")
    merge_items(parts_, own, lengths_, out_, to_tets());
  else
    return false;
  return true;
}

bool Merger::merge_graph(const std::string& name) {
  if (!name.starts_with("graph/")) return false;
  const CandidateOrder& order = candidates();
  if (name == "graph/offsets.npy") {
    lengths_ = merge_offsets(parts_, order.own, out_);
  } else if (name == "graph/neighbours.npy") {
    const std::uint64_t ends = merge_items(parts_, order.own, lengths_, out_, Renumber(parts_, order.numbers));
    counts_.vertices = static_cast<std::int64_t>(order.own.size());
    counts_.edges = static_cast<std::int64_t>(ends / 2);
    lengths_ = {};
  } else if (name == "graph/weights.npy") {
    merge_rows<std::int64_t>(parts_, order.own, out_, unchanged);
  } else {
    return false;
  }
  return true;
}

// A part counts only for its own candidates.
bool Merger::merge_solution(const std::string& name) {
  if (name != "solution/chosen.npy") return false;
  const CandidateOrder& order = candidates();
  const Renumber to_candidates(parts_, order.numbers);
  std::vector<std::int32_t> chosen;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (const std::int32_t candidate : parts_[p].bundle().read_array<std::int32_t>()) {
      const std::int32_t number = to_candidates(p, candidate);
      if (candidate < 0) throw DataError::at(parts_[p].bundle().where(), "expected candidates, found {}", candidate);
      if (order.own.gives[p][candidate]) chosen.push_back(number);
    }
  std::sort(chosen.begin(), chosen.end());
  out_.add_array(name, chosen);
  return true;
}

}  // namespace

void merge_parts_of_mesh(PartReaders& parts, pipeline::BundleWriter& out) {
  Merger(parts, out).merge();
}

}  // namespace hexpipe::merge_parts
