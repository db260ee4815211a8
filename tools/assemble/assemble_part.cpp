// Each part of a mesh is assembled on its own, and its seam stays as it is. In rounds each piece tells the others which
// cells went back to their tets, because cells beside these now face tets. Only lists of cells and tets go from part to
// part, lists only grow, and each round starts from the input. So all pieces agree in a round in which no list has
// grown.

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "common/mesh/adjacency.hpp"
#include "common/mesh/item_lists.hpp"
#include "common/mesh/orientation.hpp"
#include "common/run/error.hpp"
#include "formats/pipeline/part_bundle.hpp"
#include "tools/assemble/assemble.hpp"
#include "tools/assemble/hybrid/surface_tags.hpp"
#include "tools/assemble/pieces/pieces.hpp"

namespace hexpipe::assemble {
namespace {

struct Before {
  pieces::RoundBefore said;
  bool is_there = false;
  MeshPiece own;
};

void check_piece(const MeshPiece& piece, const MeshPart& part, const std::string& path) {
  if (piece.whole != part.whole) throw DataError::at(path, "expected a piece of the same mesh, found one of another");
  if (piece.parts != part.parts)
    throw DataError::at(path, "expected one of {} pieces, found one of {}", part.parts, piece.parts);
}

Before read_round_before(const MeshPart& part, const std::vector<std::string>& paths, const std::string& source) {
  Before before;
  std::map<std::int64_t, std::int32_t> moved;
  std::map<std::int32_t, std::string> found;
  for (const std::string& path : paths) {
    pipeline::PieceBundle bundle = pipeline::read_piece_bundle(path, false);
    MeshPiece& piece = bundle.piece;
    check_piece(piece, part, path);
    const auto [twin, is_first] = found.emplace(piece.part, path);
    if (!is_first) throw DataError::at(path, "expected each piece once, found {} as in {}", piece.part, twin->second);
    const bool is_own = piece.part == part.part;
    if (!is_own && !std::ranges::binary_search(part.neighbours, piece.part)) continue;
    std::ranges::copy(piece.given_back, std::back_inserter(before.said.given_back));
    before.said.known_homes.push_back(piece.part);
    for (std::size_t i = 0; i < piece.moved_tets.size(); ++i) moved.emplace(piece.moved_tets[i], piece.moved_to[i]);
    if (is_own) before.own = std::move(piece);
  }
  before.is_there = !paths.empty();
  if (!before.is_there) return before;
  std::ranges::sort(before.said.known_homes);
  for (const std::int32_t neighbour : part.neighbours)
    if (!found.contains(neighbour))
      throw DataError::at(source, "expected the pieces of {} and its neighbours, found no piece {}", title_of(part),
                          neighbour);
  if (!found.contains(part.part))
    throw DataError::at(source, "expected the pieces of {} and its neighbours, found no piece {}", title_of(part),
                        part.part);
  for (const auto& [tet, to] : moved) {
    before.said.moved_tets.push_back(tet);
    before.said.moved_to.push_back(to);
  }
  sort_unique(before.said.given_back);
  return before;
}

// Added points are numbered behind those of the whole, with a number that tells the part.
std::vector<std::int64_t> point_numbers(const std::vector<Vertex>& origin, const pieces::PieceInput& input,
                                        const MeshPart& part) {
  std::vector<std::int64_t> numbers;
  numbers.reserve(origin.size());
  std::int64_t added = 0;
  for (const Vertex v : origin) {
    const bool is_input = static_cast<std::size_t>(v) < input.point_number.size();
    numbers.push_back(is_input ? input.point_number[v] : part.whole.points + part.parts * added++ + part.part);
  }
  return numbers;
}

// Names for messages about these cells of the view.
choice::InputNames names_of_cells(choice::InputNames names, const pieces::PartView& view,
                                  std::span<const CandidateIndex> cells) {
  names.bundles = view.bundles;
  names.origins.clear();
  for (const CandidateIndex i : cells) names.origins.push_back(view.origins[i]);
  return names;
}

}  // namespace

PartResult assemble_part(pieces::PartView view, const std::vector<std::string>& before_paths, BuildRules rules,
                         const choice::InputNames& bundle_names) {
  const Before before = read_round_before(view.part, before_paths, bundle_names.solution);
  const choice::InputNames names = names_of_cells(bundle_names, view, choice::all_of(view.cells));
  // This is checked here, because the piece's tets are not numbered as the bundle's.
  check_orientation(view.mesh, names);
  const TetAdjacency adjacency(view.mesh, names.mesh.c_str());
  check_sides(view.mesh, adjacency, names.mesh.c_str());
  hybrid::complete_surface(view.mesh, adjacency);
  const hybrid::SurfaceTags tags(view.mesh);
  const pieces::Pieces pieces = pieces::divide_tets(view, tags, adjacency, before.said, names);
  const pieces::SeamCells cells = pieces::cells_at_seams(view, tags, pieces, before.said.given_back, names);
  pieces::PieceInput input = pieces::cut_piece(view, adjacency, tags, pieces, cells);

  PartResult result;
  MeshPiece& piece = result.piece;
  piece.part = view.part.part;
  piece.parts = view.part.parts;
  piece.whole = view.part.whole;
  piece.moved_tets = pieces.moved_tets;
  piece.moved_to = pieces.moved_to;
  piece.given_back = before.said.given_back;
  for (const CandidateIndex i : cells.given_back) piece.given_back.push_back(view.keys.key[i]);
  if (!input.mesh.tets.empty()) {
    rules.seam = &input.seam;
    AssembleResult assembled =
        assemble_piece(std::move(input.mesh), input.cells, rules, names_of_cells(bundle_names, view, input.view_cells));
    std::vector<CandidateIndex> given_back;
    std::ranges::set_difference(choice::all_of(input.cells), assembled.left, std::back_inserter(given_back));
    for (const CandidateIndex c : given_back) piece.given_back.push_back(view.keys.key[input.view_cells[c]]);
    piece.point_number = point_numbers(assembled.origin, input, view.part);
    result.mesh = std::move(assembled.mesh);
    result.statistics = std::move(assembled.statistics);
  }
  std::ranges::sort(piece.given_back);
  piece.settled = before.is_there && piece.given_back == before.own.given_back;
  return result;
}

}  // namespace hexpipe::assemble
