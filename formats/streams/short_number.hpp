#pragma once
// Numbers for formats whose fields have a greatest width: a reader cuts what is longer, and reads another number.

#include <string>

namespace hexpipe::formats {

// The text of at most `width` characters (8 or more) that reads back nearest to the number; exactly equal if that fits.
// With `needs_point` it has a decimal point; without one, some formats take a number for an integer.
std::string number_within(double number, int width, bool needs_point = false);

}  // namespace hexpipe::formats
