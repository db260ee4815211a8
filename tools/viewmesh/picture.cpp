#include "tools/viewmesh/picture.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// After osmesa.h, which sets up gl.h.
#include <GL/glext.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <memory>
#include <string>

#include "common/run/error.hpp"
#include "tools/viewmesh/camera.hpp"
#include "tools/viewmesh/resources.hpp"
#include "tools/viewmesh/skin.hpp"

namespace hexpipe::viewmesh {
namespace {

// Drawn this much larger each way and averaged.
constexpr int oversampling = 2;

struct FreeContext {
  void operator()(OSMesaContext context) const { OSMesaDestroyContext(context); }
};

// Mesa with a picture in memory. Everything that is made while an object exists goes with it.
class Renderer {
 public:
  Renderer(int width, int height) : width_(width), height_(height), screen_(std::size_t{4} * width * height) {
    const std::array attributes{OSMESA_FORMAT,
                                OSMESA_RGBA,
                                OSMESA_DEPTH_BITS,
                                24,
                                OSMESA_PROFILE,
                                OSMESA_CORE_PROFILE,
                                OSMESA_CONTEXT_MAJOR_VERSION,
                                3,
                                OSMESA_CONTEXT_MINOR_VERSION,
                                3,
                                0};
    context_.reset(OSMesaCreateContextAttribs(attributes.data(), nullptr));
    if (!context_ || !OSMesaMakeCurrent(context_.get(), screen_.data(), GL_UNSIGNED_BYTE, width, height))
      throw DataError(fmt::format("Mesa cannot draw a picture of {} x {} pixels", width, height));
    glViewport(0, 0, width, height);
  }

  // A program whose uniforms are set by name; it stays current until the next one is made.
  GLuint use_program(std::string_view vertex, std::string_view fragment) {
    const GLuint program = glCreateProgram();
    attach(program, GL_VERTEX_SHADER, vertex);
    attach(program, GL_FRAGMENT_SHADER, fragment);
    const char* names[] = {"position", "normal", "colour"};
    for (GLuint i = 0; i < 3; ++i) glBindAttribLocation(program, i, names[i]);
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) throw DataError("Mesa cannot link a shader");
    glUseProgram(program);
    return program;
  }

  // Draws into textures from now on: {colours, depths}.
  std::array<GLuint, 2> draw_to_textures() {
    std::array<GLuint, 2> textures{};
    glGenTextures(2, textures.data());
    const auto make = [&](GLuint texture, GLint inner, GLenum outer, GLenum type) {
      glBindTexture(GL_TEXTURE_2D, texture);
      glTexImage2D(GL_TEXTURE_2D, 0, inner, width_, height_, 0, outer, type, nullptr);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    };
    make(textures[0], GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE);
    make(textures[1], GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT);
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[0], 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, textures[1], 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw DataError("Mesa cannot draw into textures");
    return textures;
  }

  void draw_to_screen() { glBindFramebuffer(GL_FRAMEBUFFER, 0); }

  // The picture that was drawn, RGBA, rows from the bottom.
  const std::vector<std::uint8_t>& finish() {
    glFinish();
    if (const GLenum error = glGetError(); error != GL_NO_ERROR)
      throw DataError(fmt::format("Mesa cannot draw: OpenGL error {:#x}", error));
    return screen_;
  }

 private:
  static void attach(GLuint program, GLenum stage, std::string_view source) {
    const GLuint shader = glCreateShader(stage);
    const std::string text = "#version 330\n" + std::string(source);
    const char* const start = text.c_str();
    glShaderSource(shader, 1, &start, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) throw DataError("Mesa cannot compile a shader");
    glAttachShader(program, shader);
  }

  int width_, height_;
  std::vector<std::uint8_t> screen_;
  std::unique_ptr<std::remove_pointer_t<OSMesaContext>, FreeContext> context_;
};

template <class Vertex>
void upload(const std::vector<Vertex>& vertices) {
  GLuint array = 0, buffer = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
               GL_STATIC_DRAW);
}

void set_attribute(GLuint index, GLint size, GLenum type, bool normalized, std::size_t stride, std::size_t offset) {
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, size, type, normalized ? GL_TRUE : GL_FALSE, static_cast<GLsizei>(stride),
                        // NOLINTNEXTLINE(performance-no-int-to-ptr): as OpenGL has its offsets
                        reinterpret_cast<const void*>(offset));
}

void draw_skin(Renderer& renderer, const std::vector<SkinVertex>& skin, const Camera& camera, bool edges) {
  const GLuint program = renderer.use_program(resources::skin_vertex, resources::skin_fragment);
  glUniformMatrix4fv(glGetUniformLocation(program, "modelViewMatrix"), 1, GL_FALSE, camera.view.data());
  glUniformMatrix4fv(glGetUniformLocation(program, "projectionMatrix"), 1, GL_FALSE, camera.projection.data());
  glUniform1f(glGetUniformLocation(program, "edge_width"), edges ? 1.0F * oversampling : 0.0F);
  upload(skin);
  set_attribute(0, 3, GL_FLOAT, false, sizeof(SkinVertex), offsetof(SkinVertex, position));
  set_attribute(1, 3, GL_BYTE, true, sizeof(SkinVertex), offsetof(SkinVertex, normal));
  set_attribute(2, 4, GL_UNSIGNED_BYTE, true, sizeof(SkinVertex), offsetof(SkinVertex, colour));
  glEnable(GL_DEPTH_TEST);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(skin.size()));
}

void darken(Renderer& renderer, const std::array<GLuint, 2>& textures, const Camera& camera, double reach,
            const ViewState& state, int width, int height) {
  const GLuint program = renderer.use_program(resources::screen_vertex, resources::occlusion_fragment);
  const auto uniform = [&](const char* name) { return glGetUniformLocation(program, name); };
  for (int i = 0; i < 2; ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    glBindTexture(GL_TEXTURE_2D, textures[i]);
    glUniform1i(uniform(i == 0 ? "image" : "depths"), i);
  }
  glUniform2f(uniform("pixel"), 1.0F / static_cast<float>(width), 1.0F / static_cast<float>(height));
  glUniform2f(uniform("half_frustum"), camera.half_frustum[0], camera.half_frustum[1]);
  glUniform2f(uniform("near_far"), static_cast<float>(camera.near), static_cast<float>(camera.far));
  glUniform1f(uniform("reach"), static_cast<float>(reach));
  const auto& background = page_colours()[state.dark ? "dark" : "light"];
  for (const char* place : {"top", "bottom"}) {
    const Rgb colour = parse_colour(background[place]);
    glUniform3f(uniform(place), colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F);
  }
  glDisable(GL_DEPTH_TEST);
  using Corner = std::array<float, 3>;
  upload(std::vector<Corner>{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}});
  set_attribute(0, 3, GL_FLOAT, false, sizeof(Corner), 0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
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

}  // namespace

Picture draw_picture(const Scene& scene, const ViewState& state, int width, int height) {
  const int large_width = oversampling * width, large_height = oversampling * height;
  const Camera camera = camera_of(state, static_cast<double>(width) / height);
  Renderer renderer(large_width, large_height);
  const auto textures = renderer.draw_to_textures();
  draw_skin(renderer, visible_skin(scene, state), camera, state.edges);
  renderer.draw_to_screen();
  darken(renderer, textures, camera, occlusion_reach(scene), state, large_width, large_height);
  return averaged(renderer.finish(), width, height);
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

}  // namespace hexpipe::viewmesh
