#pragma once
// The card of a picture that has its legend, in the upper right corner.

#include "tools/viewmesh/camera.hpp"
#include "tools/viewmesh/picture/canvas.hpp"
#include "tools/viewmesh/picture/legend.hpp"
#include "tools/viewmesh/picture/text.hpp"

namespace hexpipe::viewmesh::picture {

class LegendCard {
 public:
  // For a picture of this size, in letters of `em` pixels. Groups that have no room are counted in the last line.
  LegendCard(const Legend& legend, double em, int width, int height);

  // The frame that the card leaves free: left of it, in an upright picture below it.
  Frame free_frame() const;
  void draw(Picture& picture, bool dark) const;

 private:
  enum class Style { title, share, words, subject, scale, ticks, key };
  struct Row {
    Style style;
    std::string text{};
    Rgb colour{};  // of a key
  };

  void add_rows(const Legend& legend);
  double text_width(const Row& row) const;
  double height_of(const Row& row) const;
  double height_of_rows() const;
  void draw_row(Picture& picture, const Row& row, double top, const Rgb& ink, const Rgb& soft) const;
  void draw_ticks(Picture& picture, double baseline, const Rgb& colour) const;

  double em_;
  Font normal_, small_, title_, large_;
  int width_, height_;  // of the picture
  std::vector<Row> rows_;
  std::vector<std::string> ticks_;
  Box box_;
};

}  // namespace hexpipe::viewmesh::picture
