#pragma once
// Sizes that the user asks for at surfaces, in bodies and in boxes.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "tools/tetmesh/sizing/size_demand.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh {

struct AskedSize {
  enum class Place : std::uint8_t { surface, body, box };
  Place place;
  std::string name;           // of a surface or a body; of a box, the text of the user
  std::array<Vec3, 2> box{};  // its lowest corner and its highest one
  sizing::Length size;
};

// Reads "inlet=0.5" as the size at a surface, "body bolt=1" as that in a body, and "box 0,0,0,1,1,1=0.2" as that in a
// box. Throws UsageError for anything else.
AskedSize parse_asked_size(std::string_view text);

// Adds the sizes to the places of the demand. If a body has a greater size than the rest, that becomes the greatest
// size, and the rest gets its own size as a place. TetGen fills bodies with few tets for that; it may take
// `tetgen_timeout` seconds. Throws DataError if there is nothing of a name.
void add_asked_sizes(const solid::Surface& surface, std::span<const AskedSize> asked, double tetgen_timeout,
                     sizing::SizeDemand& demand);

}  // namespace hexpipe::tetmesh
