// The one file that includes TetGen (AGPL-3).

#include "tools/tetmesh/tetgen/run_tetgen.hpp"

#include <fmt/format.h>
#include <tetgen.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <numeric>

#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/random.hpp"
#include "tools/tetmesh/tetgen/child_process.hpp"

namespace hexpipe::tetmesh::tetgen {
namespace {

// p: a piecewise linear complex; Y: keep its triangles; F: no list of boundary triangles; Q: quiet; d: find
// intersecting triangles instead. Points inside are given with the complex. Switch -i adds them after the surface is in
// place. That takes up to twice as long on fine surfaces, because these are harder to recover while nothing is inside;
// on surfaces of few triangles it saves up to a quarter. T: lengths below this, as a share of the box around all
// points, count as touching; TetGen's default is 1e-8.
constexpr const char* mesh_switches = "pYFQ";
constexpr const char* strict_switches = "pYFQT1e-15";
constexpr const char* diagnosis_switches = "pdQ";

// TetGen's exit codes, from terminatetetgen().
constexpr int out_of_memory = 1, self_intersection = 3;

const char* reason_of(int code) {
  switch (code) {
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

// Points and triangles in the order in which TetGen is given them.
struct ShuffledInput {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Vertex> original;  // for each point, its number in the input
};

std::vector<std::int32_t> shuffled_order(std::size_t count, Random* random) {
  std::vector<std::int32_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  if (random) random->shuffle(std::span(order));
  return order;
}

ShuffledInput shuffle(const TetGenInput& input) {
  Random random(input.shuffle);
  Random* const source = input.shuffle == 0 ? nullptr : &random;
  const std::size_t surface_count = input.surface_points.size();
  ShuffledInput shuffled;
  shuffled.original = shuffled_order(surface_count + input.interior_points.size(), source);
  std::vector<Vertex> new_number(shuffled.original.size());
  for (const Vertex v : shuffled.original) {
    new_number[v] = static_cast<Vertex>(shuffled.points.size());
    const auto i = static_cast<std::size_t>(v);
    shuffled.points.push_back(i < surface_count ? input.surface_points[i] : input.interior_points[i - surface_count]);
  }
  for (const std::int32_t t : shuffled_order(input.triangles.size(), source)) {
    const auto [a, b, c] = input.triangles[t];
    shuffled.triangles.push_back({new_number[a], new_number[b], new_number[c]});
  }
  return shuffled;
}

// Points that TetGen added keep their numbers. A point that it dropped makes the numbers of others wrong, which
// build_mesh notices because points are not where they were.
void undo_shuffle(std::span<const Vertex> original, TetGenResult& result) {
  if (result.points.size() < original.size()) return;
  std::vector<Vec3> points = result.points;
  for (std::size_t i = 0; i < original.size(); ++i) points[original[i]] = result.points[i];
  result.points = std::move(points);
  for (Tet& tet : result.tets)
    for (Vertex& v : tet)
      if (static_cast<std::size_t>(v) < original.size()) v = original[v];
}

void set_facet(tetgenio::facet& facet, const Triangle& triangle) {
  tetgenio::init(&facet);
  facet.numberofpolygons = 1;
  facet.polygonlist = new tetgenio::polygon[1];
  tetgenio::polygon& polygon = facet.polygonlist[0];
  polygon.numberofvertices = 3;
  polygon.vertexlist = new int[3]{triangle[0], triangle[1], triangle[2]};
}

// tetgenio frees the arrays that it is given.
void set_complex(tetgenio& complex, std::span<const Vec3> points, std::span<const Triangle> triangles) {
  complex.numberofpoints = static_cast<int>(points.size());
  complex.pointlist = new double[3 * points.size()];
  std::memcpy(complex.pointlist, points.data(), points.size_bytes());
  complex.numberoffacets = static_cast<int>(triangles.size());
  complex.facetlist = new tetgenio::facet[triangles.size()];
  for (std::size_t i = 0; i < triangles.size(); ++i) set_facet(complex.facetlist[i], triangles[i]);
}

void call_tetgen(const char* switches, tetgenio& complex, tetgenio& out) {
  std::string text = switches;  // a copy, because TetGen wants to write to it
  tetrahedralize(text.data(), &complex, &out);
}

// Called in the child: writes a count and the rows after it.
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

void mesh_in_child(const ShuffledInput& input, bool strict, SharedResult& result) {
  tetgenio complex, out;
  set_complex(complex, input.points, input.triangles);
  call_tetgen(strict ? strict_switches : mesh_switches, complex, out);
  append_rows<Vec3>(result, out.pointlist, out.numberofpoints);
  append_rows<Tet>(result, out.tetrahedronlist, out.numberoftetrahedra);
}

void diagnose_in_child(const TetGenInput& input, SharedResult& result) {
  tetgenio complex, out;
  set_complex(complex, input.surface_points, input.triangles);
  call_tetgen(diagnosis_switches, complex, out);
  append_rows<Triangle>(result, out.trifacelist, out.numberoftrifaces);
}

std::vector<Triangle> find_intersecting(const TetGenInput& input, double timeout) {
  SharedResult shared;
  const ChildEnd end = ChildProcess([&] { diagnose_in_child(input, shared); }, timeout).wait();
  if (end.kind != ChildEnd::Kind::exited || end.code != 0) return {};
  return take_rows<Triangle>(shared);
}

// Throws for failures that have nothing to do with the surface and would not go better in another order.
void check_system(const ChildEnd& end) {
  const bool by_kernel = end.kind == ChildEnd::Kind::killed && end.code == SIGKILL;
  const bool by_itself =
      end.kind == ChildEnd::Kind::exited &&
      (end.code == out_of_memory || end.code == SharedResult::write_failed || end.code == uncaught_exception);
  if (by_itself) throw DataError("TetGen failed: there is not enough memory");
  if (by_kernel) throw DataError("TetGen's process was killed; there may not be enough memory");
}

std::string failure_of(const ChildEnd& end) {
  switch (end.kind) {
    case ChildEnd::Kind::timed_out:
      return "it took longer than --tetgen-timeout allows";
    case ChildEnd::Kind::killed:
      return fmt::format("it was ended by signal {} ({})", end.code, strsignal(end.code));
    case ChildEnd::Kind::exited:
      break;
  }
  return end.code == 0 ? "" : reason_of(end.code);
}

}  // namespace

struct TetGenRun::Work {
  TetGenInput input;
  Deadline deadline;
  ShuffledInput shuffled = shuffle(input);
  SharedResult shared = {};
  ChildProcess child{[this] { mesh_in_child(shuffled, input.strict, shared); }, deadline.remaining()};
};

TetGenRun::TetGenRun(const TetGenInput& input, double timeout) : work_(new Work{input, Deadline(timeout)}) {}

TetGenRun::~TetGenRun() = default;

TetGenResult TetGenRun::wait() {
  const std::unique_ptr<Work> work = std::move(work_);
  const ChildEnd end = work->child.wait();
  check_system(end);
  TetGenResult result;
  result.seconds = end.seconds;
  result.failure = failure_of(end);
  if (result.failure.empty()) {
    result.points = take_rows<Vec3>(work->shared);
    result.tets = take_rows<Tet>(work->shared);
    undo_shuffle(work->shuffled.original, result);
  } else if (work->input.names_intersecting && end.kind == ChildEnd::Kind::exited && end.code == self_intersection) {
    result.intersecting = find_intersecting(work->input, work->deadline.remaining());
  }
  return result;
}

}  // namespace hexpipe::tetmesh::tetgen
