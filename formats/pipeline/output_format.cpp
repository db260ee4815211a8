#include "formats/pipeline/output_format.hpp"

namespace hexpipe::pipeline {

bool is_bundle_format(std::string_view format) {
  return format == bundle_format || format == compressed_bundle_format;
}

std::string_view ending_of(std::string_view path) {
  path = path.substr(path.rfind('/') + 1);
  if (path.ends_with(".tar.zst")) return compressed_bundle_format;
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string_view() : path.substr(dot + 1);
}

}  // namespace hexpipe::pipeline
