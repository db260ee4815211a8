#pragma once
// Sizes that are asked for at surfaces, in bodies and in boxes, as sources of a size field.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "tools/tetmesh/sizing/size_field.hpp"
#include "tools/tetmesh/sizing/sizing.hpp"
#include "tools/tetmesh/solid/shells.hpp"

namespace hexpipe::tetmesh {

struct TetmeshOptions;

struct AskedSize {
  enum class Place : std::uint8_t { surface, body, box };
  Place place;
  std::string name;           // of a surface or a body; of a box, as it was given
  std::array<Vec3, 2> box{};  // its lowest corner and its highest
  sizing::Length size;
};

// "inlet=0.5" of a surface, "body bolt=1", "box 0,0,0,1,1,1=0.2". Throws UsageError.
AskedSize parse_asked_size(std::string_view text);

struct AskedSizes {
  sizing::SizeSources sources;  // those of the options, too
  double greatest;              // may be that of a body, the others then have theirs as a source
};

// `greatest` is the size where none is asked for. Throws DataError where there is nothing of that name.
AskedSizes asked_sizes(const solid::Surface& surface, const TetmeshOptions& options, double greatest);

}  // namespace hexpipe::tetmesh
