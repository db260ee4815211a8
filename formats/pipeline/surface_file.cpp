#include "formats/pipeline/surface_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <utility>

#include "common/run/error.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/mesh_surface.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/surface_bundle.hpp"
#include "formats/surfaces/surface_files.hpp"

namespace hexpipe::pipeline {
namespace {

// Triangles by tag, ascending.
std::map<std::int32_t, std::vector<std::size_t>> by_tag(const formats::SurfaceSoup& surface) {
  std::map<std::int32_t, std::vector<std::size_t>> result;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) result[surface.tags[i]].push_back(i);
  return result;
}

std::string name_of(const formats::SurfaceSoup& surface, std::int32_t tag) {
  const auto found = surface.names.surfaces.find(tag);
  return found == surface.names.surfaces.end() ? fmt::format("surface_{}", tag) : found->second;
}

// In OBJ a blank ends a name, and '#' begins a comment.
std::string obj_name(const std::string& name, std::vector<std::string>& changes) {
  std::string result = name;
  std::ranges::replace_if(
      result, [](char c) { return c == ' ' || c == '#'; }, '_');
  if (result != name)
    changes.push_back(fmt::format("the name '{}' is written as {}, because OBJ has no blanks", name, result));
  return result;
}

std::vector<std::string> write_obj(const formats::SurfaceSoup& surface, formats::Output& output) {
  std::vector<std::string> changes;
  for (const Vec3& p : surface.points) output.print("v {} {} {}\n", p.x, p.y, p.z);
  for (const auto& [tag, triangles] : by_tag(surface)) {
    output.print("g {}\n", obj_name(name_of(surface, tag), changes));
    for (const std::size_t i : triangles) {
      const auto [a, b, c] = surface.triangles[i];
      output.print("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
  }
  return changes;
}

std::vector<std::string> write_stl(const formats::SurfaceSoup& surface, formats::Output& output) {
  for (const auto& [tag, triangles] : by_tag(surface)) {
    const std::string name = name_of(surface, tag);
    output.print("solid {}\n", name);
    for (const std::size_t i : triangles) {
      const auto [a, b, c] = surface.triangles[i];
      const Vec3 &p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
      const Vec3 normal = cross(q - p, r - p), n = norm(normal) > 0 ? unit(normal) : normal;
      output.print("facet normal {:.6g} {:.6g} {:.6g}\nouter loop\n", n.x, n.y, n.z);
      for (const Vec3& corner : {p, q, r}) output.print("vertex {} {} {}\n", corner.x, corner.y, corner.z);
      output.print("endloop\nendfacet\n");
    }
    output.print("endsolid {}\n", name);
  }
  return {};
}

std::vector<std::string> write_msh(const formats::SurfaceSoup& surface, formats::Output& output) {
  MixedMesh mesh;
  mesh.points = surface.points;
  mesh.triangles = {surface.triangles, surface.tags, {}};
  formats::write_mixed_mesh(mesh, "msh", output);
  return {};
}

using Writer = std::vector<std::string> (*)(const formats::SurfaceSoup&, formats::Output&);
constexpr std::pair<std::string_view, Writer> writers[] = {{"obj", write_obj}, {"stl", write_stl}, {"msh", write_msh}};

}  // namespace

formats::SurfaceSoup read_surface_file(const std::string& path, std::vector<nlohmann::ordered_json>* history) {
  formats::Input input = formats::Input::open(path);
  if (looks_like_bundle(input))
    return read_surface_bundle(input, [&](BundleReader& member) {
      if (history != nullptr && is_history_entry(member.name())) history->push_back(read_history_entry(member));
    });
  return formats::looks_like_mesh_surface(input.peek(formats::bytes_that_tell_mesh)) ? formats::read_mesh_surface(input)
                                                                                     : formats::read_surface(input);
}

std::string_view surface_format_of(const std::string& path) {
  const bool to_stdout = path.empty() || path == "-";
  if (to_stdout && isatty(STDOUT_FILENO))
    throw UsageError("standard output is a terminal: pipe it to tetmesh, or write a file with -o");
  const std::string_view ending = ending_of(path);
  if (to_stdout || path.starts_with("/dev/") || is_bundle_format(ending)) return {};
  std::vector<std::string_view> known;
  for (const auto& [name, writer] : writers) known.push_back(name);
  if (std::ranges::find(known, ending) == known.end())
    throw UsageError(fmt::format("expected a surface as {} or tar, tar.zst, found '{}'", fmt::join(known, ", "), path));
  return ending;
}

std::vector<std::string> write_surface(const formats::SurfaceSoup& surface, std::string_view format,
                                       formats::Output& output) {
  for (const auto& [name, writer] : writers)
    if (name == format) return writer(surface, output);
  throw UsageError(fmt::format("expected a surface as obj, stl or msh, found '{}'", format));
}

void write_surface_bundle(const formats::SurfaceSoup& surface, const std::vector<nlohmann::ordered_json>& history,
                          bool compress, formats::Output& output, const ExactShape* shape) {
  BundleWriter writer(output, compress);
  write_surface_members(writer, surface);
  if (shape != nullptr) write_shape_members(writer, *shape);
  if (!surface.names.empty()) writer.add_text(std::string(formats::names_member), text_of(surface.names));
  write_history(writer, history);
  writer.close();
}

}  // namespace hexpipe::pipeline
