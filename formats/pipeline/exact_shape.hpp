#pragma once
// The CAD's own faces and curves in a bundle, beside the triangles that were made of them: the members
// surface/shape.brep and surface/shape.json.

#include <cstdint>
#include <string>
#include <vector>

#include "formats/pipeline/bundle.hpp"

namespace hexpipe::pipeline {

struct ExactShape {
  std::string brep;  // OpenCASCADE's text format, with the triangles of each face
  double unit = 1;   // length of the bundle's unit in that of the shape
  // The tag of each face, as in surface/triangle_tags.npy, and the curve tag of each edge, 0 for none. Faces and edges
  // are in the order in which a walk through the shape first meets them.
  std::vector<std::int32_t> face_tags, edge_tags;

  bool empty() const { return brep.empty(); }
};

// Reads the current member into `shape` when it is one of the two, and also writes it to `copy` unless that is null.
bool read_shape_member(BundleReader& reader, ExactShape& shape, BundleWriter* copy);

void write_shape_members(BundleWriter& writer, const ExactShape& shape);

}  // namespace hexpipe::pipeline
