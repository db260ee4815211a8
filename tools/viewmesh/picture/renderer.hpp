#pragma once
// Mesa with a picture in memory, and the few steps of OpenGL that the pictures need.

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// After osmesa.h, which sets up gl.h.
#include <GL/glext.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hexpipe::viewmesh::picture {

// A vertex attribute as it lies in memory.
struct Attribute {
  const char* name;
  GLint size;
  GLenum type;
  bool normalized;
  std::size_t offset;
};

// Everything that is made while an object exists goes with it.
class Renderer {
 public:
  // Throws DataError when Mesa cannot draw a picture of this size; so do the others where it cannot go on.
  Renderer(int width, int height);

  // A program that stays current until the next one; its uniforms are set by name.
  void use_program(std::string_view vertex, std::string_view fragment, const std::vector<Attribute>& attributes);
  GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }

  // Draws triangles of the current program's vertices.
  template <class Vertex>
  void draw_triangles(const std::vector<Vertex>& vertices) {
    draw_triangles(vertices.data(), vertices.size(), sizeof(Vertex));
  }

  // Draws into textures from now on: {colours, depths}.
  std::array<GLuint, 2> draw_to_textures();
  void draw_to_screen() { glBindFramebuffer(GL_FRAMEBUFFER, 0); }

  // The picture that was drawn, RGBA, rows from the bottom.
  const std::vector<std::uint8_t>& finish();

 private:
  struct FreeContext {
    void operator()(OSMesaContext context) const { OSMesaDestroyContext(context); }
  };

  void draw_triangles(const void* vertices, std::size_t count, std::size_t stride);

  int width_, height_;
  std::vector<std::uint8_t> screen_;
  std::unique_ptr<std::remove_pointer_t<OSMesaContext>, FreeContext> context_;
  GLuint program_ = 0;
  std::vector<Attribute> attributes_;
};

}  // namespace hexpipe::viewmesh::picture
