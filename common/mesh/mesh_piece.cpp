#include "common/mesh/mesh_piece.hpp"

#include <algorithm>

#include "common/run/error.hpp"

namespace hexpipe {

void validate(const MeshPiece& piece, const char* source) {
  if (piece.parts < 1 || piece.part < 0 || piece.part >= piece.parts)
    throw DataError::at(source, "expected a piece from 0 to {}, found {}", piece.parts - 1, piece.part);
  if (piece.moved_tets.size() != piece.moved_to.size())
    throw DataError::at(source, "expected a part for each of {} tets, found {}", piece.moved_tets.size(),
                        piece.moved_to.size());
  const auto ascends = [](const auto& numbers) {
    return std::ranges::adjacent_find(numbers, std::ranges::greater_equal{}) == numbers.end();
  };
  if (!ascends(piece.moved_tets) || !ascends(piece.given_back))
    throw DataError::at(source, "expected ascending tets and candidates, found others");
  for (const std::int64_t tet : piece.moved_tets)
    if (tet < 0 || tet >= piece.whole.tets)
      throw DataError::at(source, "expected tets below {}, found {}", piece.whole.tets, tet);
  for (const std::int32_t part : piece.moved_to)
    if (part < 0 || part >= piece.parts)
      throw DataError::at(source, "expected parts below {}, found {}", piece.parts, part);
  for (const std::int64_t point : piece.point_number)
    if (point < 0) throw DataError::at(source, "expected numbers of points from 0, found {}", point);
}

void validate_against(const MeshPiece& piece, const MixedMesh& mesh, const char* source) {
  if (piece.point_number.size() != mesh.points.size())
    throw DataError::at(source, "expected a number for each of {} points, found {}", mesh.points.size(),
                        piece.point_number.size());
}

}  // namespace hexpipe
