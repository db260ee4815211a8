#include "tools/viewmesh/dislocation_lines.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "common/mesh/tet_mesh.hpp"

namespace hexpipe::viewmesh {
namespace {

using Place = std::array<double, 3>;

Vec3 to_vec(const Place& p) {
  return {p[0], p[1], p[2]};
}

class Joiner {
 public:
  explicit Joiner(const pipeline::DislocationSegments& segments) : used_(segments.size()) {
    ends_.reserve(segments.size());
    for (const auto& [x0, y0, z0, x1, y1, z1] : segments) {
      ends_.push_back({Place{x0, y0, z0}, Place{x1, y1, z1}});
      const auto number = static_cast<std::int32_t>(ends_.size()) - 1;
      for (const Place& end : ends_.back()) at_[end].push_back(number);
    }
  }

  std::vector<Polyline> join() {
    std::vector<Polyline> lines;
    // Open lines first: what is left then goes round.
    for (const auto& [place, segments] : at_)
      if (segments.size() != 2)
        for (const std::int32_t segment : segments)
          if (!used_[segment]) lines.push_back(follow(place, segment));
    for (std::size_t i = 0; i < ends_.size(); ++i)
      if (!used_[i]) lines.push_back(follow(ends_[i][0], static_cast<std::int32_t>(i)));
    return lines;
  }

 private:
  Polyline follow(Place from, std::int32_t segment) {
    Polyline line{to_vec(from)};
    while (segment != no_index) {
      used_[segment] = true;
      const auto& [a, b] = ends_[segment];
      from = from == a ? b : a;
      line.push_back(to_vec(from));
      segment = next_at(from);
    }
    return line;
  }

  // The segment that goes on from a place where two meet; none at the end of a line.
  std::int32_t next_at(const Place& place) const {
    const auto& segments = at_.at(place);
    if (segments.size() != 2) return no_index;
    const auto unused = std::ranges::find_if(segments, [&](std::int32_t segment) { return !used_[segment]; });
    return unused == segments.end() ? no_index : *unused;
  }

  std::vector<std::array<Place, 2>> ends_;
  std::map<Place, std::vector<std::int32_t>> at_;
  std::vector<bool> used_;
};

}  // namespace

double length_of(const Polyline& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += norm(line[i] - line[i - 1]);
  return length;
}

std::vector<Polyline> join_segments(const pipeline::DislocationSegments& segments) {
  std::vector<Polyline> lines = Joiner(segments).join();
  std::ranges::stable_sort(lines, std::ranges::greater(), length_of);
  return lines;
}

}  // namespace hexpipe::viewmesh
