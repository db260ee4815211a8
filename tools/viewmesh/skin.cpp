#include "tools/viewmesh/skin.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/viewmesh/facets.hpp"
#include "tools/viewmesh/resources.hpp"
#include "tools/viewmesh/visible_cells.hpp"

namespace hexpipe::viewmesh {
namespace {

// The surface of each facet of each cell, as far as it is asked for.
class SurfaceOfFacet {
 public:
  explicit SurfaceOfFacet(const Scene& scene) : facets_(scene.surface_facets) {}

  std::int32_t operator()(std::int32_t cell, std::int32_t facet) const {
    const auto found = std::lower_bound(facets_.begin(), facets_.end(), std::pair{cell, facet},
                                        [](const Scene::SurfaceFacet& a, const auto& b) {
                                          return std::pair{a.cell, a.facet} < b;
                                        });
    return found != facets_.end() && found->cell == cell && found->facet == facet ? found->surface : no_index;
  }

 private:
  const std::vector<Scene::SurfaceFacet>& facets_;  // ascending
};

class Painter {
 public:
  Painter(const Scene& scene, const ViewState& state) : scene_(scene), colour_(state.colour) {
    const auto& colours = page_colours();
    plain_ = parse_colour(colours["plain"]), invalid_ = parse_colour(colours["invalid"]);
    for (const auto& stop : colours["quality"]) quality_.push_back(parse_colour(stop));
    for (std::size_t k = 0; k < kinds_.size(); ++k) kinds_[k] = parse_colour(colours["kinds"][name_of(scene_kinds[k])]);
    if (const auto measure = measure_of(state.colour)) {
      measured_ = &scene.measures[*measure];
      const auto& range = colours["measures"][measure_names[*measure]];
      limit_ = range["limit"], best_ = range["best"];
    }
    for (const auto& group : colours["groups"]) groups_.push_back(parse_colour(group));
  }

  // `surface`: the place of the facet's surface, or no_index.
  Rgb colour_of(std::int32_t cell, std::int32_t surface) const {
    switch (colour_) {
      case ViewState::Colour::kind:
        return kinds_[scene_.kind_index(cell)];
      case ViewState::Colour::region:
        return groups_[place_of(scene_.regions, scene_.region[cell]) % groups_.size()];
      case ViewState::Colour::surface:
        return surface == no_index ? plain_ : groups_[surface % groups_.size()];
      case ViewState::Colour::hexes:
        return scene_.kind_of(cell) == CellKind::hex ? by_quality(scene_.quality[cell]) : plain_;
      case ViewState::Colour::quality:
        return by_quality(scene_.quality[cell]);
      default:
        return by_measure((*measured_)[cell]);
    }
  }

 private:
  Rgb by_quality(double quality) const { return quality > 0 ? mixed(quality_, quality) : invalid_; }

  // From what a measure allows to its best; what it does not allow is as an invalid cell.
  Rgb by_measure(double value) const {
    const double place = (value - limit_) / (best_ - limit_);
    return place < 0 ? invalid_ : mixed(quality_, place);
  }

  const Scene& scene_;
  ViewState::Colour colour_;
  Rgb plain_, invalid_;
  const std::vector<std::int32_t>* measured_ = nullptr;
  double limit_ = 0, best_ = 1;
  std::vector<Rgb> quality_, groups_;
  std::array<Rgb, 4> kinds_;
};

// The normal of a facet's mean plane (half the cross product of the diagonals of a quad).
std::array<std::int8_t, 4> normal_of(const Scene& scene, const FacetCorners& facet) {
  const auto at = [&](int i) { return scene.point(facet.vertices[i]); };
  const Vec3 across = facet.count == 3 ? cross(at(1) - at(0), at(2) - at(0)) : cross(at(2) - at(0), at(3) - at(1));
  const double length = norm(across);
  const double scale = length > 0 ? 127 / length : 0;
  const auto byte = [&](double value) { return static_cast<std::int8_t>(std::lround(scale * value)); };
  return {byte(across.x), byte(across.y), byte(across.z), 0};
}

void add_facet(const Scene& scene, const FacetCorners& facet, const Rgb& colour, std::vector<SkinVertex>& skin) {
  // A quad's two triangles hide the side opposite their corner 1, its diagonal.
  constexpr std::array<std::array<int, 3>, 2> triangles{{{0, 1, 2}, {2, 3, 0}}};
  const auto normal = normal_of(scene, facet);
  const int hidden = facet.count == 4 ? 2 : 0;
  for (int t = 0; t < facet.count - 2; ++t)
    for (int corner = 0; corner < 3; ++corner)
      skin.push_back({scene.points[facet.vertices[triangles[t][corner]]],
                      normal,
                      {colour[0], colour[1], colour[2], static_cast<std::uint8_t>(corner + 4 * hidden)}});
}

}  // namespace

std::vector<SkinVertex> visible_skin(const Scene& scene, const ViewState& state) {
  const Painter painter(scene, state);
  const std::vector<bool> visible = visible_cells(scene, state);
  const auto hidden = hidden_places(state, ViewState::HiddenGroup::Kind::surface, scene.surfaces);
  const SurfaceOfFacet surface_of(scene);
  const auto sides = facet_sides(scene);
  std::vector<SkinVertex> skin;
  for_each_facet(sides, [&](std::span<const FacetSide> facet) {
    std::array<const FacetSide*, 2> first{};
    for (const FacetSide& side : facet)
      if (visible[side.cell] && !first[side.side]) first[side.side] = &side;
    if ((first[0] == nullptr) == (first[1] == nullptr)) return;
    const FacetSide& shown = first[0] ? *first[0] : *first[1];
    const std::int32_t surface = surface_of(shown.cell, shown.facet);
    if (surface != no_index && hidden[surface]) return;
    add_facet(scene, facet_corners(scene, shown.cell, shown.facet), painter.colour_of(shown.cell, surface), skin);
  });
  return skin;
}

Rgb mixed(const std::vector<Rgb>& colours, double along) {
  const double place = std::min(along, 1.0) * static_cast<double>(colours.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  const double part = place - static_cast<double>(below);
  Rgb result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = static_cast<std::uint8_t>(std::lround(colours[below][i] * (1 - part) + colours[below + 1][i] * part));
  return result;
}

Rgb parse_colour(const std::string& text) {
  const unsigned long value = std::stoul(text.substr(1), nullptr, 16);
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8),
          static_cast<std::uint8_t>(value)};
}

const nlohmann::json& page_colours() {
  static const nlohmann::json colours = nlohmann::json::parse(resources::colours);
  return colours;
}

}  // namespace hexpipe::viewmesh
