#pragma once
// The format that the ending of an output's name asks for.

#include <string_view>

namespace hexpipe::pipeline {

constexpr std::string_view bundle_format = "tar";
constexpr std::string_view compressed_bundle_format = "tar.zst";

bool is_bundle_format(std::string_view format);

// The text after the last dot of the file's name; "tar.zst" as a whole; empty if there is no dot.
std::string_view ending_of(std::string_view path);

}  // namespace hexpipe::pipeline
