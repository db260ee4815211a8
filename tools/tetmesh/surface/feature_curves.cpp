#include "tools/tetmesh/surface/feature_curves.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace hexpipe::tetmesh::surface {
namespace {

// The end of a step that is nearer to a vertex of the curve than this share of a step moves to the vertex.
constexpr double snapping = 1e-3;
// The deviation adds steps up to this many times the number that the size asks for.
constexpr int most_refinement = 16;
// Where sizes differ, lengths are measured in this many steps a size.
constexpr double parts_a_size = 4, most_parts = 1e5;

class CurveFinder {
 public:
  explicit CurveFinder(const FeatureMesh& mesh) : mesh_(mesh), seen_(mesh.n_edges()) {}

  std::vector<FeatureCurve> find() {
    for (const bool from_corners : {true, false})
      for (const VertexH v : mesh_.vertices()) {
        if (!mesh_.is_on_feature(v) || (from_corners && !mesh_.is_kept(v))) continue;
        for (const auto h : mesh_.voh_range(v))
          if (is_unseen(h)) follow(h);
      }
    return std::move(curves_);
  }

 private:
  bool is_unseen(OpenMesh::HalfedgeHandle h) const {
    const auto e = mesh_.edge_handle(h);
    return mesh_.is_feature(e) && !seen_[e.idx()];
  }

  void follow(OpenMesh::HalfedgeHandle h) {
    FeatureCurve curve;
    const VertexH start = mesh_.from_vertex_handle(h);
    curve.vertices.push_back(start);
    while (h.is_valid()) {
      for (const auto copy : mesh_.copies(h)) seen_[mesh_.edge_handle(copy).idx()] = true;
      curve.vertices.push_back(mesh_.to_vertex_handle(h));
      h = continuation(mesh_.to_vertex_handle(h));
    }
    curve.closed = mesh_.place(curve.vertices.back()) == mesh_.place(start) && !mesh_.is_kept(start);
    curves_.push_back(std::move(curve));
  }

  OpenMesh::HalfedgeHandle continuation(VertexH v) const {
    if (!mesh_.is_kept(v))
      for (const auto h : mesh_.voh_range(v))
        if (is_unseen(h)) return h;
    return OpenMesh::HalfedgeHandle();
  }

  const FeatureMesh& mesh_;
  std::vector<bool> seen_;
  std::vector<FeatureCurve> curves_;
};

// The length of a curve, in steps.
class CurveLength {
 public:
  CurveLength(const MeasuredCurve& curve, const sizing::SizeField& size)
      : points_(1, curve.points.front()), lengths_(1, 0.0), vertices_(1, 0) {
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      add_segment(curve.points[i - 1], curve.points[i], curve.steps_per_size[i - 1], size);
      if (curve.vertices[i].is_valid()) vertices_.push_back(points_.size() - 1);
    }
  }

  double length() const { return lengths_.back(); }
  std::size_t segments() const { return vertices_.size() - 1; }
  double start_of(std::size_t segment) const { return lengths_[vertices_[segment]]; }

  Vec3 at(double s) const {
    const auto after = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, s) - lengths_.begin();
    const auto i = static_cast<std::size_t>(after);
    const double t = (s - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return points_[i - 1] + t * (points_[i] - points_[i - 1]);
  }

  // Whether `count` chords of even length leave the curve by more than the deviation.
  bool is_bent(int count, const sizing::SizeField& deviation) const {
    const double step = length() / count;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double k = std::min(std::floor(lengths_[i] / step), count - 1.0);
      const Vec3 from = at(k * step), along = at((k + 1) * step) - from, p = points_[i] - from;
      const double t = std::clamp(dot(p, along) / std::max(norm_squared(along), 1e-300), 0.0, 1.0);
      const double most = deviation.at(points_[i]);
      if (norm_squared(p - t * along) > most * most) return true;
    }
    return false;
  }

 private:
  // Adds it in steps over which the size hardly changes.
  void add_segment(const Vec3& from, const Vec3& to, double steps_per_size, const sizing::SizeField& size) {
    const double length = norm(to - from);
    const int parts =
        size.least() < size.greatest() ? parts_of(length / size.least_near(size.at(0.5 * (from + to)), length)) : 1;
    for (int i = 1; i <= parts; ++i) {
      const Vec3 start = points_.back();
      points_.push_back(i == parts ? to : from + (static_cast<double>(i) / parts) * (to - from));
      const double sizes = norm(points_.back() - start) / size.at(0.5 * (start + points_.back()));
      lengths_.push_back(lengths_.back() + steps_per_size * sizes);
    }
  }
  static int parts_of(double sizes) { return static_cast<int>(std::clamp(parts_a_size * sizes, 1.0, most_parts)); }

  std::vector<Vec3> points_;
  std::vector<double> lengths_;        // up to each point
  std::vector<std::size_t> vertices_;  // the points that are vertices of the curve
};

// The direction, from the loop's centre, of the axis that lies most in the loop's plane. With it, loops that are copies
// of each other, like the rims of a hole, start at the same angle, and their four quarters lie along the axes.
Vec3 start_direction(const std::vector<Vec3>& loop) {
  Vec3 area;
  for (std::size_t i = 1; i < loop.size(); ++i) area += cross(loop[i - 1] - loop[0], loop[i] - loop[0]);
  const Vec3 size{std::abs(area.x), std::abs(area.y), std::abs(area.z)};
  const Vec3 axis = size.x <= size.y && size.x <= size.z ? Vec3{1, 0, 0}
                    : size.y <= size.z                   ? Vec3{0, 1, 0}
                                                         : Vec3{0, 0, 1};
  return axis - (dot(axis, area) / std::max(norm_squared(area), 1e-300)) * area;
}

class CurveSampler {
 public:
  CurveSampler(FeatureMesh& mesh, const sizing::SizeField& size, const sizing::SizeField& deviation)
      : mesh_(mesh), size_(size), deviation_(deviation) {}

  void sample(MeasuredCurve curve) {
    if (curve.closed) turn_to_start(curve);
    CurveLength arc(curve, size_);
    if (arc.is_bent(curve.steps.value_or(whole_steps(arc, curve.closed)), deviation_)) {
      curve.steps.reset();  // the deviation asks for more steps than the rows
      std::ranges::fill(curve.steps_per_size, 1);
      arc = CurveLength(curve, size_);
    }
    std::vector<VertexH> vertices;
    std::ranges::copy_if(curve.vertices, std::back_inserter(vertices), [](VertexH v) { return v.is_valid(); });
    const int count = step_count(arc, curve.closed, curve.steps);
    if (curve.closed) mesh_.keep(vertices.front());
    const double step = arc.length() / count;
    int next = 1;
    for (std::size_t i = 0; i < arc.segments() && next < count; ++i) {
      VertexH from = vertices[i];
      const VertexH to = vertices[i + 1];
      const double end = arc.start_of(i + 1);
      for (; next < count && next * step < end + snapping * step; ++next) {
        if (std::abs(next * step - end) <= snapping * step)
          mesh_.keep(to);
        else
          from = place(from, to, arc.at(next * step));
      }
    }
  }

 private:
  VertexH place(VertexH from, VertexH to, const Vec3& p) {
    const VertexH v = mesh_.split_edge_at(mesh_.edge_handle(mesh_.find_halfedge(from, to)), p);
    mesh_.keep(v);
    return v;
  }

  static int whole_steps(const CurveLength& arc, bool closed) {
    if (!closed) return std::max(1, static_cast<int>(std::round(arc.length())));
    return std::max(4, 2 * static_cast<int>(std::round(arc.length() / 2)));
  }

  int step_count(const CurveLength& arc, bool closed, const std::optional<int>& planned) const {
    int count = planned.value_or(whole_steps(arc, closed));
    const int most = most_refinement * count;
    while (count < most && arc.is_bent(count, deviation_)) count += closed ? 2 : 1;
    return count;
  }

  // Cuts the loop at its start, a vertex of the mesh, and rotates it so that it begins there.
  void turn_to_start(MeasuredCurve& curve) const {
    const Vec3 direction = start_direction(curve.points);
    std::size_t first = curve.points.size();
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
      if (!curve.vertices[i].is_valid()) continue;
      if (first == curve.points.size() || dot(curve.points[i], direction) > dot(curve.points[first], direction))
        first = i;
    }
    curve.points.pop_back();
    curve.vertices.pop_back();
    const auto turn = [&](auto& values) {
      std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first), values.end());
    };
    turn(curve.points);
    turn(curve.vertices);
    turn(curve.steps_per_size);
    curve.points.push_back(curve.points.front());
    curve.vertices.push_back(curve.vertices.front());
  }

  FeatureMesh& mesh_;
  const sizing::SizeField &size_, &deviation_;
};

}  // namespace

std::vector<FeatureCurve> feature_curves(const FeatureMesh& mesh) {
  return CurveFinder(mesh).find();
}

void sample_feature_curves(FeatureMesh& mesh, std::span<const MeasuredCurve> curves, const sizing::SizeField& size,
                           const sizing::SizeField& deviation) {
  CurveSampler sampler(mesh, size, deviation);
  for (const MeasuredCurve& curve : curves) sampler.sample(curve);
}

void sample_feature_curves(FeatureMesh& mesh, const sizing::SizeField& size, const sizing::SizeField& deviation) {
  std::vector<MeasuredCurve> measured;
  for (FeatureCurve& curve : feature_curves(mesh)) {
    MeasuredCurve& even = measured.emplace_back();
    for (const auto v : curve.vertices) even.points.push_back(mesh.position(v));
    even.vertices = std::move(curve.vertices);
    even.steps_per_size.assign(even.points.size() - 1, 1);
    even.closed = curve.closed;
  }
  sample_feature_curves(mesh, measured, size, deviation);
}

}  // namespace hexpipe::tetmesh::surface
