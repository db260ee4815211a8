#pragma once
// A picture in memory, and what is drawn on it: bars, lines and whatever has a coverage for each pixel.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tools/viewmesh/skin.hpp"

namespace hexpipe::viewmesh::picture {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top
};

// In pixels from the upper left corner, to the right and down.
struct Place {
  double x = 0, y = 0;
};

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};

// Mixes a colour into a pixel; `share` from 0 to 1. Pixels outside stay out.
void mix(Picture& picture, int x, int y, const Rgb& colour, double share);

// With round corners.
void fill_box(Picture& picture, const Box& box, double radius, const Rgb& colour, double share = 1);
// From the left to the right through all colours.
void fill_ramp(Picture& picture, const Box& box, double radius, const std::vector<Rgb>& colours);
// With round ends.
void draw_line(Picture& picture, Place from, Place to, double width, const Rgb& colour);

}  // namespace hexpipe::viewmesh::picture
