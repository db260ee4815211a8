#include "tools/viewmesh/page.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>

#include "common/run/error.hpp"
#include "common/run/progress.hpp"
#include "formats/streams/base64.hpp"
#include "tools/viewmesh/camera.hpp"
#include "tools/viewmesh/resources.hpp"

namespace hexpipe::viewmesh {
namespace {

std::string compressed(const std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint8_t> packed(compressBound(bytes.size()));
  uLongf size = packed.size();
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), 6) != Z_OK) throw std::bad_alloc();
  packed.resize(size);
  return formats::base64({reinterpret_cast<const char*>(packed.data()), packed.size()});
}

template <class Word>
std::string pack_words(const std::vector<Word>& words) {
  std::vector<std::uint8_t> bytes(sizeof(Word) * words.size());
  for (std::size_t byte = 0; byte < sizeof(Word); ++byte)
    for (std::size_t i = 0; i < words.size(); ++i)
      bytes[byte * words.size() + i] = static_cast<std::uint8_t>(words[i] >> (8 * byte));
  return compressed(bytes);
}

std::string pack_points(const std::vector<std::array<float, 3>>& points) {
  std::vector<float> rows;
  rows.reserve(3 * points.size());
  for (int axis = 0; axis < 3; ++axis)
    for (const auto& point : points) rows.push_back(point[axis]);
  return pack_floats(rows);
}

// For each kind its name, how many corners it has, and which of them each facet has.
nlohmann::ordered_json kinds_to_json() {
  auto kinds = nlohmann::ordered_json::array();
  for (const CellKind kind : scene_kinds)
    with_topology(kind, [&](auto topology) {
      nlohmann::ordered_json facets = nlohmann::ordered_json::array();
      for (const auto& triangle : topology.triangles) facets.push_back(triangle);
      for (const auto& quad : topology.quads) facets.push_back(quad);
      kinds.push_back({{"name", name_of(kind)}, {"corners", corner_count(kind)}, {"facets", facets}});
    });
  return kinds;
}

nlohmann::ordered_json packed_fragments(const Scene& scene) {
  std::vector<std::int32_t> sizes, cells;
  for (const auto& fragment : scene.fragments) {
    sizes.push_back(static_cast<std::int32_t>(fragment.size()));
    cells.insert(cells.end(), fragment.begin(), fragment.end());
  }
  return {{"sizes", pack_integers(sizes, 1)}, {"cells", pack_integers(cells, 1)}};
}

// Each line's length is in the mesh's own units.
nlohmann::ordered_json packed_dislocations(const Scene& scene) {
  std::vector<std::int32_t> sizes;
  std::vector<float> lengths, points;
  for (const Polyline& line : scene.dislocations) {
    sizes.push_back(static_cast<std::int32_t>(line.size()));
    lengths.push_back(static_cast<float>(scene.unit * length_of(line)));
    for (const Vec3& p : line)
      points.insert(points.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  }
  return {{"sizes", pack_integers(sizes, 1)}, {"lengths", pack_floats(lengths)}, {"points", pack_floats(points)}};
}

nlohmann::ordered_json groups_to_json(const std::vector<Group>& groups) {
  auto json = nlohmann::ordered_json::array();
  for (const Group& group : groups) json.push_back({{"tag", group.tag}, {"name", group.name}});
  return json;
}

// Facets as the page numbers them: eight times the cell, and the facet's number in it.
nlohmann::ordered_json packed_surfaces(const Scene& scene) {
  std::vector<std::int32_t> facets, surfaces;
  for (const auto& facet : scene.surface_facets) {
    facets.push_back(8 * facet.cell + facet.facet);
    surfaces.push_back(facet.surface);
  }
  return {{"facets", pack_integers(facets, 1)}, {"surfaces", pack_integers(surfaces, 1)}};
}

nlohmann::ordered_json to_json(const Scene& scene, const ViewState& state, const std::string& title) {
  nlohmann::ordered_json json{{"title", title},
                              {"content", name_of(scene.content)},
                              {"state", to_text(state)},
                              {"centre", {scene.centre.x, scene.centre.y, scene.centre.z}},
                              {"unit", scene.unit},
                              {"reach", occlusion_reach(scene)},
                              {"pointCount", scene.points.size()},
                              {"kinds", kinds_to_json()},
                              {"kindBegin", scene.kind_begin},
                              {"points", pack_points(scene.points)}};
  for (std::size_t k = 0; k < scene_kinds.size(); ++k)
    json["corners"].push_back(pack_integers(scene.corners[k], corner_count(scene_kinds[k])));
  json["quality"] = pack_floats(scene.quality);
  json["measures"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < measure_names.size(); ++i)
    if (!scene.measures[i].empty()) json["measures"][measure_names[i]] = pack_integers(scene.measures[i], 1);
  json["region"] = pack_integers(scene.region, 1);
  json["layer"] = pack_integers({scene.layer.begin(), scene.layer.end()}, 1);
  json["number"] = pack_integers(scene.number, 1);
  json["volume"] = scene.volume;
  json["groups"] = {{"region", groups_to_json(scene.regions)}, {"surface", groups_to_json(scene.surfaces)}};
  json["surfaceFacets"] = packed_surfaces(scene);
  json["dislocations"] = packed_dislocations(scene);
  json["fragments"] = packed_fragments(scene);
  json["history"] = scene.history;
  return json;
}

// Inside a script element nothing may look like its end.
std::string for_script(const nlohmann::ordered_json& json) {
  std::string text = json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos; ++at) text.replace(at, 1, "\\u003c");
  return text;
}

std::string for_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else
      result += c;
  }
  return result;
}

}  // namespace

std::string pack_integers(const std::vector<std::int32_t>& numbers, int stride) {
  std::vector<std::uint32_t> words(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto before = i < static_cast<std::size_t>(stride) ? 0U : static_cast<std::uint32_t>(numbers[i - stride]);
    const std::uint32_t difference = static_cast<std::uint32_t>(numbers[i]) - before;
    words[i] = difference << 1 ^ (difference >> 31 ? ~0U : 0U);
  }
  return pack_words(words);
}

std::string pack_floats(const std::vector<float>& numbers) {
  std::vector<std::uint32_t> words(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) words[i] = std::bit_cast<std::uint32_t>(numbers[i]);
  return pack_words(words);
}

void write_page(const Scene& scene, const ViewState& state, const std::string& title, formats::Output& output) {
  const Step step("writing the page");
  const std::string heading = for_html(title), data = for_script(to_json(scene, state, title));
  const auto text_of = [&](std::string_view name) -> std::string_view {
    if (name == "title") return heading;
    if (name == "style") return resources::style;
    if (name == "script") return resources::script;
    return data;
  };
  std::string_view rest = resources::page;
  for (std::size_t open; (open = rest.find("{{")) != std::string_view::npos;) {
    const std::size_t close = rest.find("}}", open);
    output.write(rest.substr(0, open));
    output.write(text_of(rest.substr(open + 2, close - open - 2)));
    rest.remove_prefix(close + 2);
  }
  output.write(rest);
}

}  // namespace hexpipe::viewmesh
