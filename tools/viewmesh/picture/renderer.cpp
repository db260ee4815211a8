#include "tools/viewmesh/picture/renderer.hpp"

#include <fmt/format.h>

#include <string>

#include "common/run/error.hpp"

namespace hexpipe::viewmesh::picture {
namespace {

void attach(GLuint program, GLenum stage, std::string_view source) {
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

}  // namespace

Renderer::Renderer(int width, int height) : width_(width), height_(height), screen_(std::size_t{4} * width * height) {
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

void Renderer::use_program(std::string_view vertex, std::string_view fragment,
                           const std::vector<Attribute>& attributes) {
  program_ = glCreateProgram();
  attributes_ = attributes;
  attach(program_, GL_VERTEX_SHADER, vertex);
  attach(program_, GL_FRAGMENT_SHADER, fragment);
  for (GLuint i = 0; i < attributes.size(); ++i) glBindAttribLocation(program_, i, attributes[i].name);
  glLinkProgram(program_);
  GLint linked = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &linked);
  if (!linked) throw DataError("Mesa cannot link a shader");
  glUseProgram(program_);
}

void Renderer::draw_triangles(const void* vertices, std::size_t count, std::size_t stride) {
  GLuint array = 0, buffer = 0;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(count * stride), vertices, GL_STATIC_DRAW);
  for (GLuint i = 0; i < attributes_.size(); ++i) {
    const Attribute& attribute = attributes_[i];
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, attribute.size, attribute.type, attribute.normalized ? GL_TRUE : GL_FALSE,
                          static_cast<GLsizei>(stride),
                          // NOLINTNEXTLINE(performance-no-int-to-ptr): as OpenGL has its offsets
                          reinterpret_cast<const void*>(attribute.offset));
  }
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(count));
}

std::array<GLuint, 2> Renderer::draw_to_textures() {
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

const std::vector<std::uint8_t>& Renderer::finish() {
  glFinish();
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw DataError(fmt::format("Mesa cannot draw: OpenGL error {:#x}", error));
  return screen_;
}

}  // namespace hexpipe::viewmesh::picture
