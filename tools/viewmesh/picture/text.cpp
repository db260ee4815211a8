#include "tools/viewmesh/picture/text.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <cmath>
#include <cstdint>

#include "common/run/error.hpp"
#include "tools/viewmesh/resources.hpp"

namespace hexpipe::viewmesh::picture {
namespace {

constexpr double ft_unit = 64;  // of FreeType's lengths in a pixel
constexpr std::uint32_t replacement = 0xfffd;

// Takes one character off the text; a byte that is not UTF-8 becomes U+FFFD.
std::uint32_t take_character(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  text.remove_prefix(1);
  if (first < 0x80) return first;
  const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 0;
  if (more == 0) return replacement;
  std::uint32_t code = first & (0x3fU >> more);
  for (int i = 0; i < more; ++i) {
    if (text.empty() || (static_cast<unsigned char>(text.front()) & 0xc0) != 0x80) return replacement;
    code = code << 6 | (static_cast<unsigned char>(text.front()) & 0x3f);
    text.remove_prefix(1);
  }
  return code;
}

}  // namespace

struct Font::Face {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  Face() = default;
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    if (library) FT_Done_FreeType(library);  // and its face
  }

  // The glyph in the face's slot; null if it cannot be drawn.
  FT_GlyphSlot load(std::uint32_t character, Weight weight, double size) const {
    if (FT_Load_Char(face, character, FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP)) return nullptr;
    if (weight == Weight::bold && face->glyph->format == FT_GLYPH_FORMAT_OUTLINE)
      FT_Outline_Embolden(&face->glyph->outline, std::lround(size * ft_unit / 22));
    return face->glyph;
  }

  // How far the next character stands.
  static double advance(FT_GlyphSlot glyph, Weight weight, double size) {
    return static_cast<double>(glyph->linearHoriAdvance) / 65536 + (weight == Weight::bold ? size / 22 : 0);
  }
};

Font::Font(double size) : size_(size), face_(std::make_unique<Face>()) {
  const std::string_view bytes = resources::font;
  if (FT_Init_FreeType(&face_->library) ||
      FT_New_Memory_Face(face_->library, reinterpret_cast<const FT_Byte*>(bytes.data()),
                         static_cast<FT_Long>(bytes.size()), 0, &face_->face) ||
      FT_Set_Char_Size(face_->face, 0, std::lround(size * ft_unit), 72, 72))
    throw DataError("FreeType cannot draw the legend");
}

Font::~Font() = default;

double Font::width(std::string_view text, Weight weight) const {
  double sum = 0;
  while (!text.empty())
    if (const FT_GlyphSlot glyph = face_->load(take_character(text), weight, size_))
      sum += Face::advance(glyph, weight, size_);
  return sum;
}

void Font::draw(Picture& picture, Place left, std::string_view text, const Rgb& colour, Weight weight) const {
  while (!text.empty()) {
    const FT_GlyphSlot glyph = face_->load(take_character(text), weight, size_);
    if (!glyph) continue;
    const double advance = Face::advance(glyph, weight, size_), whole = std::floor(left.x);
    FT_Outline_Translate(&glyph->outline, std::lround((left.x - whole) * ft_unit), 0);
    left.x += advance;
    if (FT_Render_Glyph(glyph, FT_RENDER_MODE_NORMAL)) continue;
    const FT_Bitmap& bitmap = glyph->bitmap;
    const int x = static_cast<int>(whole) + glyph->bitmap_left;
    const int y = static_cast<int>(std::lround(left.y)) - glyph->bitmap_top;
    for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
      for (int column = 0; column < static_cast<int>(bitmap.width); ++column)
        mix(picture, x + column, y + row, colour, bitmap.buffer[row * bitmap.pitch + column] / 255.0);
  }
}

std::string Font::cut_to(std::string text, double room, Weight weight) const {
  if (width(text, weight) <= room) return text;
  const std::string_view dots = "…";
  while (!text.empty() && width(text + std::string(dots), weight) > room) {
    // All bytes of the last character.
    while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + std::string(dots);
}

}  // namespace hexpipe::viewmesh::picture
