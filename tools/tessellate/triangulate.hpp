#pragma once
// Triangles of a CAD model: close to its surface, and the same along an edge for all faces that meet there.

#include <optional>
#include <string>

#include "formats/pipeline/exact_shape.hpp"
#include "formats/surfaces/surface_soup.hpp"
#include "tools/tessellate/cad_model.hpp"

namespace hexpipe::tessellate {

struct TriangulationOptions {
  std::optional<double> deviation = {};  // nothing: a hundredth of the size that tetmesh would choose
  double angle = 15;                     // degrees, between neighbours on a smooth face
  double smooth_angle = 2;               // degrees: a curve between faces that differ by no more does not count
  bool keep_baffles = false;             // faces inside stay, with the same body on both sides
  bool open = false;                     // faces need not enclose anything: triangles have no sides, and may leave gaps
};

// Triangles of one body that crossed each other as OpenCASCADE made them first.
struct MadeAnew {
  std::size_t crossings = 0;  // pairs
  bool helped = false;        // to make triangles anew
  std::size_t collapsed = 0;  // short edges whose collapse helped instead (short_edges.hpp)
};

struct Triangulation {
  formats::SurfaceSoup surface;  // in the model's units; sides, curves, names
  pipeline::ExactShape shape;    // what it was made of
  std::size_t faces = 0, curves = 0;
  double deviation = 0;
  std::size_t gap_triangles = 0;  // where OpenCASCADE's triangles left gaps (face_gaps.hpp)
  std::size_t joined_nodes = 0;   // there, and at edges without a length (short_edges.hpp)
  std::size_t empty_faces = 0;    // open ones of which OpenCASCADE made no triangles
  MadeAnew made_anew;
};

// The suitable distance of points for the bodies, as tetmesh chooses it.
double default_size_of(const CadModel& model);

// Where triangles of one body cross each other, those of their faces are made anew, finer; then all are, or, unless a
// deviation is asked for, those of these faces and of those beside them coarser. If that does not help, edges of the
// first triangles that are shorter than the deviation go; if that does not help either, these triangles stay. Throws
// DataError if a face cannot be triangulated, or its triangles leave a gap that cannot be closed.
Triangulation triangulate(const CadModel& model, const TriangulationOptions& options, const std::string& source);

}  // namespace hexpipe::tessellate
