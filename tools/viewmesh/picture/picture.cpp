#include "tools/viewmesh/picture/picture.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <optional>

#include "common/run/error.hpp"
#include "common/run/progress.hpp"
#include "tools/viewmesh/camera.hpp"
#include "tools/viewmesh/picture/axis_marks.hpp"
#include "tools/viewmesh/picture/legend_card.hpp"
#include "tools/viewmesh/picture/renderer.hpp"
#include "tools/viewmesh/resources.hpp"
#include "tools/viewmesh/skin.hpp"
#include "tools/viewmesh/visible_cells.hpp"

namespace hexpipe::viewmesh::picture {
namespace {

// Drawn this much larger each way and averaged.
constexpr int oversampling = 2;
// This share of the picture, or of the frame beside the legend, stays free around a model that fits.
constexpr double border = 0.05;
// Smaller pictures have neither legend nor axes.
constexpr int least_width = 360, least_height = 240;
constexpr float line_width = 2.5F * oversampling;

std::array<float, 3> part_of_255(const Rgb& colour) {
  return {colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F};
}

void set_colour(const Renderer& renderer, const char* name, const nlohmann::json& text) {
  const auto [r, g, b] = part_of_255(parse_colour(text));
  glUniform3f(renderer.uniform(name), r, g, b);
}

void set_camera(const Renderer& renderer, const Camera& camera) {
  glUniformMatrix4fv(renderer.uniform("modelViewMatrix"), 1, GL_FALSE, camera.view.data());
  glUniformMatrix4fv(renderer.uniform("projectionMatrix"), 1, GL_FALSE, camera.projection.data());
}

void draw_skin(Renderer& renderer, const std::vector<SkinVertex>& skin, const Camera& camera, const ViewState& state) {
  renderer.use_program(resources::skin_vertex, resources::skin_fragment,
                       {{"position", 3, GL_FLOAT, false, offsetof(SkinVertex, position)},
                        {"normal", 3, GL_BYTE, true, offsetof(SkinVertex, normal)},
                        {"colour", 4, GL_UNSIGNED_BYTE, true, offsetof(SkinVertex, colour)}});
  set_camera(renderer, camera);
  const Vec3 up = axes_of(state.up)[2];
  glUniform3f(renderer.uniform("up_axis"), static_cast<float>(up.x), static_cast<float>(up.y),
              static_cast<float>(up.z));
  glUniform1f(renderer.uniform("edge_width"), state.edges ? 1.0F * oversampling : 0.0F);
  glEnable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  renderer.draw_triangles(skin);
}

void bind_texture(const Renderer& renderer, const char* name, int place, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + place);
  glBindTexture(GL_TEXTURE_2D, texture);
  glUniform1i(renderer.uniform(name), place);
}

void darken(Renderer& renderer, const std::array<GLuint, 2>& textures, const Camera& camera, double reach, bool dark,
            int width, int height) {
  using Corner = std::array<float, 3>;
  renderer.use_program(resources::screen_vertex, resources::occlusion_fragment, {{"position", 3, GL_FLOAT, false, 0}});
  bind_texture(renderer, "image", 0, textures[0]);
  bind_texture(renderer, "depths", 1, textures[1]);
  glUniform2f(renderer.uniform("pixel"), 1.0F / static_cast<float>(width), 1.0F / static_cast<float>(height));
  glUniform2f(renderer.uniform("half_frustum"), camera.half_frustum[0], camera.half_frustum[1]);
  glUniform2f(renderer.uniform("near_far"), static_cast<float>(camera.near), static_cast<float>(camera.far));
  glUniform1f(renderer.uniform("reach"), static_cast<float>(reach));
  const auto& theme = page_colours()[dark ? "dark" : "light"];
  for (const char* place : {"top", "bottom"}) set_colour(renderer, place, theme[place]);
  glDisable(GL_DEPTH_TEST);
  renderer.draw_triangles(std::vector<Corner>{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}});
}

// The layout that page/line.vert expects.
struct LineVertex {
  std::array<float, 3> position, other;
  float side;
};

std::vector<LineVertex> line_triangles(const std::vector<Polyline>& lines) {
  std::vector<LineVertex> vertices;
  const auto single = [](const Vec3& p) {
    return std::array{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  for (const Polyline& line : lines)
    for (std::size_t i = 1; i < line.size(); ++i) {
      const auto a = single(line[i - 1]), b = single(line[i]);
      // Left of a line seen from its end is right of it seen from its begin.
      const LineVertex left{a, b, 1}, right{a, b, -1}, far_right{b, a, 1}, far_left{b, a, -1};
      vertices.insert(vertices.end(), {left, right, far_right, left, far_right, far_left});
    }
  return vertices;
}

void draw_dislocations(Renderer& renderer, const Scene& scene, const ViewState& state, GLuint depths,
                       const Camera& camera, int width, int height) {
  renderer.use_program(resources::line_vertex, resources::line_fragment,
                       {{"position", 3, GL_FLOAT, false, offsetof(LineVertex, position)},
                        {"other", 3, GL_FLOAT, false, offsetof(LineVertex, other)},
                        {"side", 1, GL_FLOAT, false, offsetof(LineVertex, side)}});
  set_camera(renderer, camera);
  const auto pixels_across = static_cast<float>(width), pixels_up = static_cast<float>(height);
  glUniform2f(renderer.uniform("viewport"), pixels_across, pixels_up);
  glUniform2f(renderer.uniform("pixel"), 1 / pixels_across, 1 / pixels_up);
  glUniform1f(renderer.uniform("width"), line_width);
  const Vec3 normal = state.clip ? state.clip->normal : Vec3{};
  const double beyond = state.clip ? clip_plane(scene, *state.clip) : 1;
  glUniform4f(renderer.uniform("clip"), static_cast<float>(normal.x), static_cast<float>(normal.y),
              static_cast<float>(normal.z), static_cast<float>(beyond));
  set_colour(renderer, "line_colour", page_colours()["dislocations"]);
  bind_texture(renderer, "depths", 0, depths);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  renderer.draw_triangles(line_triangles(scene.dislocations));
}

Picture averaged(const std::vector<std::uint8_t>& large, int width, int height) {
  Picture picture{width, height, {}};
  picture.rgb.reserve(std::size_t{3} * width * height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      for (int channel = 0; channel < 3; ++channel) {
        int sum = oversampling * oversampling / 2;
        for (int y = 0; y < oversampling; ++y)
          for (int x = 0; x < oversampling; ++x) {
            const std::size_t line = std::size_t{1} * (height - 1 - row) * oversampling + y;
            sum += large[4 * (line * width * oversampling + std::size_t{1} * column * oversampling + x) + channel];
          }
        picture.rgb.push_back(static_cast<std::uint8_t>(sum / (oversampling * oversampling)));
      }
  return picture;
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
}

// libpng leaves by longjmp, so nothing that has a destructor is made here. False if it failed.
bool encode(png_structp png, png_infop info, const Picture& picture, std::string& bytes) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &bytes, append_bytes, nullptr);
  png_set_IHDR(png, info, picture.width, picture.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int row = 0; row < picture.height; ++row)
    png_write_row(png, picture.rgb.data() + std::size_t{3} * picture.width * row);
  png_write_end(png, info);
  return true;
}

// A letter's size that is read as easily in small pictures and in large ones.
double em_for(int width, int height) {
  return std::max(11.0, std::min(width / 1.6, 1.0 * height) / 60);
}

Frame with_border(const Frame& frame) {
  const double across = border * (frame.right - frame.left), up = border * (frame.top - frame.bottom);
  return {frame.left + across, frame.right - across, frame.bottom + up, frame.top - up};
}

}  // namespace

Picture draw_picture(const Scene& scene, ViewState state, const std::string& title, int width, int height) {
  const Step step("drawing the picture");
  const int large_width = oversampling * width, large_height = oversampling * height;
  const bool has_room = width >= least_width && height >= least_height;
  const double aspect = static_cast<double>(width) / height, em = em_for(width, height);
  const auto skin = visible_skin(scene, state);
  std::optional<LegendCard> card;
  if (state.legend && has_room) card.emplace(legend_of(scene, state, title), em, width, height);
  if (state.fitted) fit_camera(state, skin, aspect, with_border(card ? card->free_frame() : Frame{}));
  const Camera camera = camera_of(state, aspect);

  Renderer renderer(large_width, large_height);
  const auto textures = renderer.draw_to_textures();
  draw_skin(renderer, skin, camera, state);
  renderer.draw_to_screen();
  darken(renderer, textures, camera, occlusion_reach(scene), state.dark, large_width, large_height);
  if (state.dislocations && !scene.dislocations.empty())
    draw_dislocations(renderer, scene, state, textures[1], camera, large_width, large_height);
  Picture picture = averaged(renderer.finish(), width, height);
  if (state.axes && has_room) draw_axis_marks(picture, camera, scene.unit, em, state.dark);
  if (card) card->draw(picture, state.dark);
  return picture;
}

void write_png(const Picture& picture, formats::Output& output) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  std::string bytes;
  const bool done = info && encode(png, info, picture, bytes);
  png_destroy_write_struct(&png, &info);
  if (!done) throw DataError::at(output.name(), "libpng cannot encode the picture");
  output.write(bytes);
}

}  // namespace hexpipe::viewmesh::picture
