#include "formats/meshes/library_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "common/run/error.hpp"
#include "formats/meshes/grouped_mesh.hpp"
#include "formats/meshes/mesh_blocks.hpp"
#include "formats/meshes/mesh_library.hpp"
#include "formats/meshes/netcdf_header.hpp"
#include "formats/streams/temporary_file.hpp"

namespace hexpipe::formats {
namespace {

using namespace std::string_view_literals;

// Blanks end names where solvers list them. The library that reads Exodus in Sandia's programs makes all letters small.
constexpr GroupRules exodus_rules{
    .names = {.format = "Exodus II", .longest = 240, .others = "-.:+%@~^", .folds_case = true, .ascii_only = false},
    .needs_sides = true};

// Code_Aster and Salome list names with commas between, and take no blanks. One name is one group, whatever is in it.
constexpr GroupRules med_rules{.names = {.format = "MED", .longest = 80, .others = "-.:+%@~^", .ascii_only = false},
                               .apart = true};

// A name has 32 characters, of which the ending of a kind takes 8: steel_pyramid. Sections stand beside the first
// three, families beside the last one.
constexpr GroupRules cgns_rules{.names = {.format = "CGNS", .longest = 24, .others = "-.:+%@~^ "},
                                .apart = true,
                                .reserved = {"GridCoordinates", "ZoneBC", "ZoneType", "Zone"}};

void write_by_library(const char* library, const GroupedMesh& mesh, Output& output) {
  const MeshLibrary& functions = mesh_library(library);
  output.write_by_path([&](const std::string& path) {
    try {
      functions.write(mesh, path);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw DataError::at(output.name(), "cannot write: {}", error.what());
    }
  });
}

bool is_file(const std::string& path) {
  std::error_code error;
  return !path.empty() && std::filesystem::is_regular_file(path, error);
}

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n"sv;

struct LibraryFormat {
  const char* library;
  const char* name;
  const char* option;  // of the build
  bool is_built;
  std::string_view hdf5_mark;  // which stands in its files among those of HDF5
};

#ifdef HEXPIPE_WITH_EXODUS
constexpr bool with_exodus = true;
#else
constexpr bool with_exodus = false;
#endif
#ifdef HEXPIPE_WITH_MED
constexpr bool with_med = true;
#else
constexpr bool with_med = false;
#endif

constexpr LibraryFormat exodus{"exodus", "Exodus II", "WITH_EXODUS", with_exodus, "api_version"sv};
constexpr LibraryFormat med{"med", "MED", "WITH_MED", with_med, "INFOS_GENERALES"sv};

const LibraryFormat* format_of(std::string_view bytes) {
  if (looks_like_classic_netcdf(bytes)) return &exodus;
  for (const LibraryFormat* const format : {&med, &exodus})
    if (bytes.find(format->hdf5_mark) != std::string_view::npos) return format;
  return nullptr;
}

}  // namespace

void write_exodus(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  check_numbers(std::max(mesh.points.size(), mesh.cell_count()), most_of_31_bits, output.name());
  GroupedMesh groups = grouped(mesh, writing, exodus_rules, output.name());
  name_blocks_by_kind(groups);
  write_by_library("exodus", groups, output);
}

void write_med(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  check_numbers(std::max(mesh.points.size(), mesh.cell_count()), most_of_31_bits, output.name());
  GroupRules rules = med_rules;
  if (writing.longest_name > 0) rules.names.longest = std::min(rules.names.longest, writing.longest_name);
  GroupedMesh groups = grouped(mesh, writing, rules, output.name());
  // FreeCAD finds no mesh of another name than the file's, and says nothing.
  if (output.is_named_file()) groups.name = std::filesystem::path(output.name()).stem().string();
  write_by_library("med", groups, output);
}

void write_cgns(const MixedMesh& mesh, const MeshWriting& writing, Output& output) {
  check_numbers(std::max(mesh.points.size(), element_count(mesh)), most_of_31_bits, output.name());
  GroupedMesh groups = grouped(mesh, writing, cgns_rules, output.name());
  name_blocks_by_kind(groups);
  write_by_library("cgns", groups, output);
}

bool looks_like_library_format(std::string_view bytes) {
  return looks_like_classic_netcdf(bytes) || bytes.starts_with(hdf5_signature);
}

MixedMesh read_by_library(std::string bytes, const std::string& name, const std::string& path, GroupNames* names) {
  const LibraryFormat* const format = format_of(bytes);
  if (format == nullptr && bytes.find("CGNSLibraryVersion") != std::string::npos)
    throw DataError::at(name, "cannot read CGNS: it is written only");
  if (format == nullptr) throw DataError::at(name, "expected a mesh of Exodus II or MED, found another file of HDF5");
  if (!format->is_built)
    throw DataError::at(name, "cannot read {}: this hexpipe was built without it ({}=OFF)", format->name,
                        format->option);
  if (looks_like_classic_netcdf(bytes)) check_netcdf_header(bytes, name);
  const MeshLibrary& functions = mesh_library(format->library);
  std::optional<TemporaryFile> copy;
  if (!is_file(path)) copy.emplace(bytes);
  bytes = {};
  try {
    GroupedMesh mesh = functions.read(copy ? copy->path() : path);
    for (auto* const groups : {&mesh.cells, &mesh.facets})
      for (ElementGroup& group : *groups) group.name = clean_name(group.name);
    if (format == &exodus) join_blocks_of_kinds(mesh);
    return ungrouped(std::move(mesh), names);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw DataError::at(name, "{}", error.what());
  }
}

}  // namespace hexpipe::formats
