#include "tools/tetmesh/surface/surface_remesh.hpp"

#include <algorithm>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "common/mesh/facet_key.hpp"

namespace hexpipe::tetmesh::surface {
namespace {

// Right-angled triangles with legs of one size stay as they are.
constexpr double longest_edge = 1.5;

// M.-C. Rivara, "Algorithms for refining triangular grids" (1984): the longest edge of all is the longest edge of each
// of its triangles. So the triangles stay as good as they were.
class EdgeSplitter {
 public:
  EdgeSplitter(const solid::Surface& surface, const sizing::SizeField& size) : size_(size), soup_(surface) {
    shell_of_ = surface.shell_of;
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t) add_edges(static_cast<std::int32_t>(t));
    for (std::size_t i = 0; i < soup_.curves.size(); ++i) curve_of_[key_of(soup_.curves[i])] = soup_.curve_tags[i];
    for (const auto& [edge, triangles] : triangles_of_) enqueue(edge);
  }

  solid::Surface split(const solid::Surface& surface) {
    while (!queue_.empty()) {
      const VertexKey<2> edge = std::get<1>(queue_.top());
      queue_.pop();
      split(edge);
    }
    sort_by_sheet();
    soup_.curves.clear();
    soup_.curve_tags.clear();
    std::vector<std::pair<VertexKey<2>, std::int32_t>> curves(curve_of_.begin(), curve_of_.end());
    std::ranges::sort(curves);
    for (const auto& [edge, tag] : curves) {
      soup_.curves.push_back(edge);
      soup_.curve_tags.push_back(tag);
    }
    soup_.file_vertices.clear();
    return solid::with_shells_of(surface, std::move(soup_), std::move(shell_of_));
  }

 private:
  double length_squared(const VertexKey<2>& edge) const {
    return norm_squared(soup_.points[edge[1]] - soup_.points[edge[0]]);
  }

  void add_edges(std::int32_t t) {
    for (std::size_t i = 0; i < 3; ++i)
      triangles_of_[edge_key(soup_.triangles[t][i], soup_.triangles[t][(i + 1) % 3])].push_back(t);
  }

  void enqueue(const VertexKey<2>& edge) {
    const double length = length_squared(edge);
    const double size = size_.at(0.5 * (soup_.points[edge[0]] + soup_.points[edge[1]]));
    // Among edges of equal length, the one with the lower points goes first.
    if (length > longest_edge * longest_edge * size * size) queue_.emplace(length, VertexKey<2>{edge[0], edge[1]});
  }

  void split(const VertexKey<2>& edge) {
    const auto found = triangles_of_.find(edge);
    const std::vector<std::int32_t> triangles = found->second;
    triangles_of_.erase(found);
    const auto middle = static_cast<Vertex>(soup_.points.size());
    soup_.points.push_back(0.5 * (soup_.points[edge[0]] + soup_.points[edge[1]]));
    if (const auto curve = curve_of_.find(edge); curve != curve_of_.end()) {
      const std::int32_t tag = curve->second;
      curve_of_.erase(curve);
      for (const Vertex end : edge) curve_of_[edge_key(end, middle)] = tag;
    }
    for (const std::int32_t t : triangles) split(t, edge, middle);
    for (const Vertex end : edge) enqueue(edge_key(end, middle));
  }

  // The half at the lower end of the edge stays in the triangle's place.
  void split(std::int32_t t, const VertexKey<2>& edge, Vertex middle) {
    Triangle other = soup_.triangles[t];
    std::ranges::replace(other, edge[0], middle);
    std::ranges::replace(soup_.triangles[t], edge[1], middle);
    const auto made = static_cast<std::int32_t>(soup_.triangles.size());
    soup_.triangles.push_back(other);
    soup_.tags.push_back(soup_.tags[t]);
    soup_.places.push_back(soup_.places[t]);
    if (!soup_.sides.empty()) soup_.sides.push_back(soup_.sides[t]);
    shell_of_.push_back(shell_of_[t]);
    const Vertex across = other[0] ^ other[1] ^ other[2] ^ middle ^ edge[1];  // the corner that is left over
    std::ranges::replace(triangles_of_[edge_key(edge[1], across)], t, made);
    triangles_of_[edge_key(edge[0], middle)].push_back(t);
    triangles_of_[edge_key(edge[1], middle)].push_back(made);
    triangles_of_[edge_key(middle, across)] = {t, made};
    enqueue(edge_key(middle, across));
  }

  void sort_by_sheet() {
    std::vector<std::size_t> order(soup_.triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return shell_of_[i]; });
    const auto arrange = [&](auto& array) {
      auto old = array;
      for (std::size_t i = 0; i < array.size(); ++i) array[i] = old[order[i]];
    };
    arrange(soup_.triangles), arrange(soup_.tags), arrange(soup_.places), arrange(soup_.sides), arrange(shell_of_);
  }

  using Entry = std::pair<double, VertexKey<2>>;
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    }
  };

  const sizing::SizeField& size_;
  formats::SurfaceSoup soup_;
  std::vector<std::int32_t> shell_of_;
  KeyMap<2, std::vector<std::int32_t>> triangles_of_;
  KeyMap<2, std::int32_t> curve_of_;
  std::priority_queue<Entry, std::vector<Entry>, Later> queue_;
};

}  // namespace

solid::Surface split_long_edges(const solid::Surface& surface, const sizing::SizeField& size) {
  return EdgeSplitter(surface, size).split(surface);
}

}  // namespace hexpipe::tetmesh::surface
