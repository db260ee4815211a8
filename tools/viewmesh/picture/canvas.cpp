#include "tools/viewmesh/picture/canvas.hpp"

#include <cmath>

namespace hexpipe::viewmesh::picture {
namespace {

// A pixel is covered by as much as its middle lies inside, from half a pixel outside to half a pixel inside.
double coverage(double distance) {
  return std::clamp(0.5 - distance, 0.0, 1.0);
}

// Calls paint(x, y, distance of the pixel's middle to the shape, negative inside) for all pixels of the box and one
// more around them.
template <class Distance, class Paint>
void for_each_pixel(const Picture& picture, const Box& box, Distance&& distance, Paint&& paint) {
  const int left = std::max(0, static_cast<int>(std::floor(box.left)) - 1);
  const int right = std::min(picture.width, static_cast<int>(std::ceil(box.right)) + 1);
  const int top = std::max(0, static_cast<int>(std::floor(box.top)) - 1);
  const int bottom = std::min(picture.height, static_cast<int>(std::ceil(box.bottom)) + 1);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) paint(x, y, coverage(distance(Place{x + 0.5, y + 0.5})));
}

double distance_to_box(const Box& box, double radius, Place p) {
  const double x = std::abs(p.x - (box.left + box.right) / 2) - (box.right - box.left) / 2 + radius;
  const double y = std::abs(p.y - (box.top + box.bottom) / 2) - (box.bottom - box.top) / 2 + radius;
  return std::hypot(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0) - radius;
}

double distance_to_line(Place from, Place to, Place p) {
  const double x = to.x - from.x, y = to.y - from.y, squared = x * x + y * y;
  const double along = squared > 0 ? std::clamp(((p.x - from.x) * x + (p.y - from.y) * y) / squared, 0.0, 1.0) : 0;
  return std::hypot(p.x - from.x - along * x, p.y - from.y - along * y);
}

}  // namespace

void mix(Picture& picture, int x, int y, const Rgb& colour, double share) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height || !(share > 0)) return;
  std::uint8_t* const pixel = picture.rgb.data() + 3 * (std::size_t{1} * y * picture.width + x);
  for (std::size_t i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(std::lround(pixel[i] * (1 - share) + colour[i] * share));
}

void fill_box(Picture& picture, const Box& box, double radius, const Rgb& colour, double share) {
  for_each_pixel(
      picture, box, [&](Place p) { return distance_to_box(box, radius, p); },
      [&](int x, int y, double covered) { mix(picture, x, y, colour, share * covered); });
}

void fill_ramp(Picture& picture, const Box& box, double radius, const std::vector<Rgb>& colours) {
  const auto colour_at = [&](int x) {
    const double along = std::clamp((x + 0.5 - box.left) / (box.right - box.left), 0.0, 1.0);
    return mixed(colours, along);
  };
  for_each_pixel(
      picture, box, [&](Place p) { return distance_to_box(box, radius, p); },
      [&](int x, int y, double covered) { mix(picture, x, y, colour_at(x), covered); });
}

void draw_line(Picture& picture, Place from, Place to, double width, const Rgb& colour) {
  const auto [left, right] = std::minmax(from.x, to.x);
  const auto [top, bottom] = std::minmax(from.y, to.y);
  const Box box{left - width, top - width, right + width, bottom + width};
  for_each_pixel(
      picture, box, [&](Place p) { return distance_to_line(from, to, p) - width / 2; },
      [&](int x, int y, double covered) { mix(picture, x, y, colour, covered); });
}

}  // namespace hexpipe::viewmesh::picture
