#include "formats/pipeline/surface_bundle.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/mesh/facet_key.hpp"
#include "common/run/error.hpp"
#include "formats/surfaces/surface_building.hpp"

namespace hexpipe::pipeline {
namespace {

constexpr std::string_view surface_folder = "surface/";

// Each member once, for reading and writing: visit(member name, array).
template <class Soup, class Visit>
void visit_members(Soup& soup, Visit&& visit) {
  visit("surface/points.npy", soup.points);
  visit("surface/triangles.npy", soup.triangles);
  visit("surface/triangle_tags.npy", soup.tags);
  visit("surface/sides.npy", soup.sides);
  visit("surface/curves.npy", soup.curves);
  visit("surface/curve_tags.npy", soup.curve_tags);
}

class Checker {
 public:
  explicit Checker(const formats::SurfaceSoup& soup) : soup_(soup) {}

  void check() const {
    check_count("triangle_tags", soup_.tags.size(), "triangles", soup_.triangles.size());
    if (!soup_.sides.empty()) check_count("sides", soup_.sides.size(), "triangles", soup_.triangles.size());
    check_count("curve_tags", soup_.curve_tags.size(), "curves", soup_.curves.size());
    check_corners("triangles", soup_.triangles);
    check_corners("curves", soup_.curves);
    for (std::size_t i = 0; i < soup_.points.size(); ++i)
      if (!is_place(soup_.points[i]))
        throw DataError::at(soup_.name, "surface/points.npy: row {}: expected coordinates up to {:g}, found {}, {}, {}",
                            i, largest_coordinate, soup_.points[i].x, soup_.points[i].y, soup_.points[i].z);
    check_sides();
    check_curves();
  }

 private:
  void check_count(const char* member, std::size_t found, const char* of, std::size_t wanted) const {
    if (found != wanted)
      throw DataError::at(soup_.name, "surface/{}.npy: expected a row for each of the {} {}, found {}", member, wanted,
                          of, found);
  }

  template <class Rows>
  void check_corners(const char* member, const Rows& rows) const {
    const auto count = static_cast<Vertex>(soup_.points.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (const Vertex v : rows[i])
        if (v < 0 || v >= count)
          throw DataError::at(soup_.name, "surface/{}.npy: row {}: expected points from 0 to {}, found {}", member, i,
                              count - 1, v);
  }

  void check_sides() const {
    const auto most = static_cast<std::int64_t>(soup_.triangles.size());
    for (std::size_t i = 0; i < soup_.sides.size(); ++i) {
      const auto [behind, before] = soup_.sides[i];
      if (behind < 0 || before < 0 || behind > most || before > most)
        throw DataError::at(soup_.name, "surface/sides.npy: row {}: expected regions from 0 to {}, found {}, {}", i,
                            most, behind, before);
      if (behind == 0 && before == 0)
        throw DataError::at(soup_.name, "surface/sides.npy: row {}: expected a region on a side, found none", i);
    }
  }

  void check_curves() const {
    if (soup_.curves.empty()) return;
    KeySet<2> edges;
    edges.reserve(2 * soup_.triangles.size());
    for (const auto& [a, b, c] : soup_.triangles)
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        edges.insert(key_of(formats::CurveEdge{from, to}));
    for (std::size_t i = 0; i < soup_.curves.size(); ++i)
      if (!edges.contains(key_of(soup_.curves[i])))
        throw DataError::at(soup_.name, "surface/curves.npy: row {}: expected an edge of a triangle, found {}, {}", i,
                            soup_.curves[i][0], soup_.curves[i][1]);
  }

  const formats::SurfaceSoup& soup_;
};

bool take_member(BundleReader& reader, formats::SurfaceSoup& soup, BundleWriter* copy) {
  bool known = false;
  visit_members(soup, [&]<class T>(std::string_view name, std::vector<T>& array) {
    if (known || reader.name() != name) return;
    known = true;
    array = reader.read_array<T>();
    if (copy) copy->add_array(reader.name(), array);
  });
  return known;
}

}  // namespace

bool is_surface_member(std::string_view name) {
  return name.starts_with(surface_folder);
}

formats::SurfaceSoup read_surface_bundle(formats::Input& input, const std::function<void(BundleReader&)>& other,
                                         BundleWriter* copy) {
  BundleReader reader(input);
  formats::SurfaceSoup soup;
  soup.name = input.name();
  bool has_surface = false, has_mesh = false;
  while (reader.next()) {
    has_mesh = has_mesh || reader.name().starts_with("mesh/");
    if (reader.name() == formats::names_member)
      soup.names = formats::parse_group_names(reader.read_text(), reader.where());
    else if (is_surface_member(reader.name()) && take_member(reader, soup, copy))
      has_surface = true;
    else if (other)
      other(reader);
  }
  if (!has_surface)
    throw DataError::at(soup.name, "expected a bundle with a surface, found {}",
                        has_mesh ? "one with a mesh; findhex takes it" : "none in it");
  return checked_surface(std::move(soup));
}

bool read_surface_member(BundleReader& reader, formats::SurfaceSoup& surface, BundleWriter* copy) {
  return take_member(reader, surface, copy);
}

formats::SurfaceSoup checked_surface(formats::SurfaceSoup soup) {
  soup.text = false;
  soup.from_bundle = true;
  soup.has_own_tags = !soup.tags.empty();
  if (soup.tags.empty()) soup.tags.resize(soup.triangles.size(), 0);
  if (soup.curve_tags.empty()) soup.curve_tags.resize(soup.curves.size(), 0);
  Checker(soup).check();
  soup.places.resize(soup.triangles.size());
  std::iota(soup.places.begin(), soup.places.end(), 1);
  soup = merge_equal_points(std::move(soup));
  check_extent(soup);
  return soup;
}

void write_surface_members(BundleWriter& writer, const formats::SurfaceSoup& surface) {
  visit_members(surface, [&](const char* name, const auto& array) {
    const bool may_be_missing =
        name != std::string_view("surface/points.npy") && name != std::string_view("surface/triangles.npy");
    if (!array.empty() || !may_be_missing) writer.add_array(name, array);
  });
}

}  // namespace hexpipe::pipeline
