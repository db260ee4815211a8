#pragma once
// From a CAD file to a surface of triangles.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/pipeline/exact_shape.hpp"
#include "formats/streams/input.hpp"
#include "formats/surfaces/surface_soup.hpp"
#include "tools/tessellate/join_bodies.hpp"

namespace hexpipe::tessellate {

struct TessellateOptions {
  std::optional<double> deviation = {};  // in the units that are written; nothing: a hundredth of tetmesh's size
  double angle = 15;                     // degrees
  std::optional<std::string> unit = {};  // m or mm; nothing: the file's own
  std::vector<std::string> bodies = {};  // names or numbers of those that are wanted; nothing: all
  bool keep_baffles = false;             // faces inside that bound no body
  bool open = false;                     // all faces, whether they bound bodies or not
  bool join = false;                     // bodies that touch share their common faces, edges and vertices
  Overlaps overlaps = Overlaps::refuse;  // where bodies are joined
};

struct TessellateResult {
  formats::SurfaceSoup surface;
  pipeline::ExactShape shape;
  std::size_t bodies = 0, faces = 0, curves = 0;
  double deviation = 0;             // in the units that are written
  std::string unit;                 // of the output; empty if the file names none
  std::size_t overlaps = 0;         // pairs of bodies that overlapped
  std::size_t crossings = 0;        // pairs of triangles that crossed each other at first
  std::size_t collapsed_edges = 0;  // short ones where triangles crossed, which became points
  std::size_t gap_triangles = 0;    // where OpenCASCADE's triangles left gaps
  std::size_t joined_nodes = 0;     // there, and at edges without a length
  std::vector<std::string> warnings;
};

// Throws DataError for a file that is no CAD, has no bodies, or cannot be triangulated.
TessellateResult tessellate(formats::Input& input, const TessellateOptions& options);

nlohmann::ordered_json to_json(const TessellateResult& result);

}  // namespace hexpipe::tessellate
