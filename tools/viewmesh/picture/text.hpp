#pragma once
// Text on a picture, by FreeType. The font, DejaVu Sans, is in the executable.

#include <memory>
#include <string>
#include <string_view>

#include "tools/viewmesh/picture/canvas.hpp"

namespace hexpipe::viewmesh::picture {

enum class Weight { normal, bold };

class Font {
 public:
  // `size`: pixels of an em. Throws DataError if FreeType cannot begin.
  explicit Font(double size);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  double size() const { return size_; }
  double width(std::string_view text, Weight weight = Weight::normal) const;
  // `left`: where the text begins on its baseline. The text is UTF-8.
  void draw(Picture& picture, Place left, std::string_view text, const Rgb& colour,
            Weight weight = Weight::normal) const;
  // The text, or as much of its beginning as has room, with an ellipsis.
  std::string cut_to(std::string text, double room, Weight weight = Weight::normal) const;

 private:
  struct Face;
  double size_;
  std::unique_ptr<Face> face_;
};

}  // namespace hexpipe::viewmesh::picture
