// The one file that includes TetGen (AGPL-3).

#include "tools/tetmesh/run_tetgen.hpp"

#include <fmt/format.h>
#include <tetgen.h>

#include <algorithm>
#include <cstring>

#include "tools/tetmesh/child_process.hpp"

namespace hexpipe {
namespace {

// p: a piecewise linear complex; Y: keep its triangles; F: no list of boundary triangles; Q: quiet; i: insert points;
// d: find intersecting triangles instead.
constexpr const char* mesh_switches = "pYFQ";
constexpr const char* mesh_switches_with_points = "pYFQi";
constexpr const char* diagnosis_switches = "pdQ";

// TetGen's exit codes, from terminatetetgen().
constexpr int out_of_memory = 1, self_intersection = 3;

const char* reason_of(int code) {
  switch (code) {
    case out_of_memory:
    case SharedResult::write_failed:
      return "there is not enough memory";
    case 2:
      return "it met an internal error";
    case self_intersection:
      return "it found triangles that intersect";
    case 4:
      return "it found features that are too small";
    case 5:
      return "it found triangles that are too close to each other";
    case 10:
      return "it does not accept the surface";
    default:
      return "it ended without a result";
  }
}

double* copy_of(std::span<const Vec3> points) {
  auto* coordinates = new double[3 * points.size()];  // tetgenio frees it
  std::memcpy(coordinates, points.data(), points.size_bytes());
  return coordinates;
}

void set_facet(tetgenio::facet& facet, const Triangle& triangle) {
  tetgenio::init(&facet);
  facet.numberofpolygons = 1;
  facet.polygonlist = new tetgenio::polygon[1];
  tetgenio::polygon& polygon = facet.polygonlist[0];
  polygon.numberofvertices = 3;
  polygon.vertexlist = new int[3]{triangle[0], triangle[1], triangle[2]};
}

void set_surface(tetgenio& complex, const TetGenInput& input) {
  complex.numberofpoints = static_cast<int>(input.surface_points.size());
  complex.pointlist = copy_of(input.surface_points);
  complex.numberoffacets = static_cast<int>(input.triangles.size());
  complex.facetlist = new tetgenio::facet[input.triangles.size()];
  for (std::size_t i = 0; i < input.triangles.size(); ++i) set_facet(complex.facetlist[i], input.triangles[i]);
}

void call_tetgen(const char* switches, tetgenio& complex, tetgenio& out, tetgenio* added) {
  std::string text = switches;  // TetGen wants to write to it
  tetrahedralize(text.data(), &complex, &out, added);
}

// In the child. A count and the rows behind it.
template <class Row>
void append_rows(SharedResult& result, const void* rows, int count) {
  result.append(&count, sizeof count);
  result.append(rows, static_cast<std::size_t>(count) * sizeof(Row));
}

template <class Row>
std::vector<Row> take_rows(SharedResult& result) {
  int count = 0;
  result.take(&count, sizeof count);
  std::vector<Row> rows(static_cast<std::size_t>(std::max(count, 0)));
  result.take(rows.data(), rows.size() * sizeof(Row));
  return rows;
}

void mesh_in_child(const TetGenInput& input, SharedResult& result) {
  tetgenio complex, added, out;
  set_surface(complex, input);
  const bool with_points = !input.interior_points.empty();
  if (with_points) {
    added.numberofpoints = static_cast<int>(input.interior_points.size());
    added.pointlist = copy_of(input.interior_points);
  }
  call_tetgen(with_points ? mesh_switches_with_points : mesh_switches, complex, out, with_points ? &added : nullptr);
  append_rows<Vec3>(result, out.pointlist, out.numberofpoints);
  append_rows<Tet>(result, out.tetrahedronlist, out.numberoftetrahedra);
}

void diagnose_in_child(const TetGenInput& input, SharedResult& result) {
  tetgenio complex, out;
  set_surface(complex, input);
  call_tetgen(diagnosis_switches, complex, out, nullptr);
  append_rows<Triangle>(result, out.trifacelist, out.numberoftrifaces);
}

std::vector<Triangle> find_intersecting(const TetGenInput& input, double timeout) {
  SharedResult shared;
  const ChildEnd end = run_in_child([&] { diagnose_in_child(input, shared); }, timeout);
  if (end.kind != ChildEnd::Kind::exited || end.code != 0) return {};
  return take_rows<Triangle>(shared);
}

std::string failure_of(const ChildEnd& end, double timeout) {
  switch (end.kind) {
    case ChildEnd::Kind::timed_out:
      return fmt::format("it took longer than {:g} seconds (--tetgen-timeout)", timeout);
    case ChildEnd::Kind::killed:
      return fmt::format("it was ended by signal {} ({})", end.code, strsignal(end.code));
    case ChildEnd::Kind::exited:
      break;
  }
  return end.code == 0 ? "" : reason_of(end.code);
}

}  // namespace

TetGenResult run_tetgen(const TetGenInput& input, double timeout) {
  TetGenResult result;
  SharedResult shared;
  const ChildEnd end = run_in_child([&] { mesh_in_child(input, shared); }, timeout);
  result.failure = failure_of(end, timeout);
  if (result.failure.empty()) {
    result.points = take_rows<Vec3>(shared);
    result.tets = take_rows<Tet>(shared);
  } else if (end.kind == ChildEnd::Kind::exited && end.code == self_intersection) {
    result.intersecting = find_intersecting(input, timeout);
  }
  return result;
}

}  // namespace hexpipe
