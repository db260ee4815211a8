#pragma once
// How a scene is looked at, as the page's links and --view write it: key=value joined by '&'.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/vec3.hpp"
#include "tools/viewmesh/scene.hpp"

namespace hexpipe::viewmesh {

struct ViewState {
  // The measures come last, as measure_names has them.
  enum class Colour { hexes, quality, kind, region, surface, orthogonality, weight, determinant, flatness };
  // A group that is not shown, by its tag, or by its name until resolve_groups() has found the tag.
  struct HiddenGroup {
    enum class Kind { region, surface } kind;
    std::optional<std::int32_t> tag;
    std::string name;
  };
  // Cells whose middle lies beyond `fraction` of the way along `normal` are taken away.
  struct Clip {
    Vec3 normal;
    double fraction;
  };

  // An axis, or its opposite.
  struct Up {
    int axis = 2;
    bool turned = false;
  };

  // The camera looks at `target` (in the scene's units) from `azimuth` and `elevation` (degrees, above the plane across
  // `up`); zoom 1 shows the whole scene. Where it is fitted, zoom and target are still to be found by what is shown.
  double azimuth = -52, elevation = 28, zoom = 1;
  Vec3 target;
  bool fitted = true;
  Up up;
  std::optional<Clip> clip;
  double least_quality = -1, greatest_quality = 1;
  int peel = 0;                                       // layers of cells taken off the surface
  std::array<bool, 4> kinds{true, true, true, true};  // as scene_kinds
  std::vector<HiddenGroup> hidden;                    // cells of a region, facets of a surface
  Colour colour = Colour::hexes;
  bool edges = true, axes = true, legend = true, dislocations = false;
  bool dark = false;
  int fragment = 0;  // from 1: only this fragment's cells; 0: all
};

// Keys that `text` does not name keep their defaults. Throws UsageError for unknown keys and for wrong values.
ViewState parse_view_state(std::string_view text);
std::string to_text(const ViewState& state);

// Gives hidden groups that are named their tags. Throws UsageError for groups that the scene does not have.
void resolve_groups(ViewState& state, const Scene& scene);

// Throws UsageError if the scene has not what its cells are to be coloured by.
void check_colour(const ViewState& state, const Scene& scene);

// The place of the measure among measure_names by which cells are coloured; none for other colours.
std::optional<std::size_t> measure_of(ViewState::Colour colour);

}  // namespace hexpipe::viewmesh
