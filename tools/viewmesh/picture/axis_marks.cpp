#include "tools/viewmesh/picture/axis_marks.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tools/viewmesh/picture/text.hpp"

namespace hexpipe::viewmesh::picture {
namespace {

// In ems.
constexpr double corner = 3.4, axis_length = 2.1, bar_begins = 7, longest_bar = 13, bar_thickness = 0.22;

struct Axis {
  const char* name;
  Vec3 direction;
  double towards;  // the eye
};

void draw_axes(Picture& picture, const Camera& camera, double em, const nlohmann::json& colours) {
  std::array axes{Axis{"x", {1, 0, 0}, 0}, Axis{"y", {0, 1, 0}, 0}, Axis{"z", {0, 0, 1}, 0}};
  for (Axis& axis : axes) axis.towards = dot(axis.direction, camera.towards);
  // The nearer axes are drawn over the farther ones.
  std::ranges::sort(axes, {}, &Axis::towards);
  const Font font(em);
  const Place middle{corner * em, picture.height - corner * em};
  for (const Axis& axis : axes) {
    const double across = dot(axis.direction, camera.right), up = dot(axis.direction, camera.up);
    const Rgb colour = parse_colour(colours[axis.name]);
    const auto at = [&](double ems) { return Place{middle.x + ems * em * across, middle.y - ems * em * up}; };
    draw_line(picture, middle, at(axis_length), 0.2 * em, colour);
    const Place label = at(axis_length + 0.62);
    font.draw(picture, {label.x - font.width(axis.name) / 2, label.y + 0.3 * em}, axis.name, colour, Weight::bold);
  }
}

// A pale rim keeps marks readable over the mesh.
struct Pen {
  Rgb ink, rim;
  double rim_width;
};

void draw_bar(Picture& picture, double left, double right, double base, double em, const Pen& pen) {
  for (const bool is_rim : {true, false}) {
    const double width = bar_thickness * em + (is_rim ? 2 * pen.rim_width : 0), tick = 0.3 * em;
    const Rgb& colour = is_rim ? pen.rim : pen.ink;
    draw_line(picture, {left, base}, {right, base}, width, colour);
    for (const double end : {left, right}) draw_line(picture, {end, base - tick}, {end, base + tick}, width, colour);
  }
}

void write_length(Picture& picture, Place middle, const std::string& text, double em, const Pen& pen) {
  const Font font(em);
  const Place left{middle.x - font.width(text) / 2, middle.y};
  for (const double x : {-1.0, 0.0, 1.0})
    for (const double y : {-1.0, 0.0, 1.0})
      font.draw(picture, {left.x + x * pen.rim_width, left.y + y * pen.rim_width}, text, pen.rim);
  font.draw(picture, left, text, pen.ink);
}

}  // namespace

double round_length(double length) {
  const double ten = std::pow(10, std::floor(std::log10(length)));
  for (const double times : {5.0, 2.0})
    if (times * ten <= length) return times * ten;
  return ten;
}

void draw_axis_marks(Picture& picture, const Camera& camera, double unit, double em, bool dark) {
  draw_axes(picture, camera, em, page_colours()["axes"]);
  // At the distance of the target.
  const double pixels = picture.height / (2.0 * camera.half_frustum[1] * camera.distance * unit);
  const double length = round_length(longest_bar * em / pixels);
  const auto& theme = page_colours()[dark ? "dark" : "light"];
  const Pen pen{parse_colour(theme["soft"]), parse_colour(theme["card"]), 0.12 * em};
  const double left = bar_begins * em, right = left + length * pixels, base = picture.height - 2 * em;
  draw_bar(picture, left, right, base, em, pen);
  write_length(picture, {(left + right) / 2, base - 0.6 * em}, fmt::format("{:g}", length), em, pen);
}

}  // namespace hexpipe::viewmesh::picture
