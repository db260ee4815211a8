#include "tools/tetmesh/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hexpipe::tetmesh {
namespace {

std::string text_of(Step step, std::size_t count) {
  switch (step) {
    case Step::check:
      return fmt::format("checks {} triangles", count);
    case Step::remesh:
      return fmt::format("makes {} triangles anew", count);
    case Step::place:
      return fmt::format("places points within {} triangles", count);
    case Step::fill:
    case Step::fill_again:
      return fmt::format("TetGen joins {} points", count);
    case Step::follow_frames:
      return fmt::format("places points along a field on {} tets", count);
    case Step::improve:
      return fmt::format("searches for better points in {} tets", count);
    case Step::write:
      return fmt::format("writes {} tets", count);
  }
  return {};
}

}  // namespace

void StepReport::begin(Step step, std::size_t count) const {
  if (!show_) return;
  const auto number = std::ranges::find(steps_, step) - steps_.begin() + 1;
  show_(fmt::format("step {} of {}: {}", number, steps_.size(), text_of(step, count)));
}

}  // namespace hexpipe::tetmesh
