#include "formats/streams/number_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace hexpipe::formats {
namespace {

// "1" to "1." and "1e-05" to "1.E-5".
std::string with_point(std::string text) {
  const std::size_t exponent = text.find('e');
  std::string mantissa = text.substr(0, exponent);
  if (mantissa.find('.') == std::string::npos) mantissa += '.';
  if (exponent == std::string::npos) return mantissa;
  int power = 0;
  const std::size_t digits = exponent + (text[exponent + 1] == '+' ? 2 : 1);
  std::from_chars(text.data() + digits, text.data() + text.size(), power);
  return fmt::format("{}E{}", mantissa, power);
}

double value_of(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::string number_within(double number, int width, bool needs_point) {
  const auto finish = [&](std::string text) { return needs_point ? with_point(std::move(text)) : text; };
  std::string best = finish(fmt::format("{}", number));
  if (std::ssize(best) <= width) return best;
  double least_error = std::numeric_limits<double>::infinity();
  for (int digits = 0; digits < width; ++digits)
    for (std::string text : {fmt::format("{:.{}e}", number, digits), fmt::format("{:.{}f}", number, digits)}) {
      text = finish(std::move(text));
      const double error = std::abs(value_of(text) - number);
      if (std::ssize(text) > width || error >= least_error) continue;
      least_error = error;
      best = std::move(text);
    }
  return best;
}

}  // namespace hexpipe::formats
