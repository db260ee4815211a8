#include "common/run/option_checks.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

template CLI::Option* CLI::App::add_option<std::string>(std::string, std::string&, std::string);
template CLI::Option* CLI::App::add_option<std::vector<std::string>>(std::string, std::vector<std::string>&,
                                                                     std::string);
template CLI::Option* CLI::App::add_option<std::optional<std::string>>(std::string, std::optional<std::string>&,
                                                                       std::string);
template CLI::Option* CLI::App::add_option<double>(std::string, double&, std::string);
template CLI::Option* CLI::App::add_option<std::optional<double>>(std::string, std::optional<double>&, std::string);
template CLI::Option* CLI::App::add_option<int>(std::string, int&, std::string);
template CLI::Option* CLI::App::add_option<std::uint64_t>(std::string, std::uint64_t&, std::string);
template CLI::Option* CLI::App::add_flag<bool>(std::string, bool&, std::string);

namespace hexpipe {

CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? std::string() : fmt::format("expected a number from {:g} to {:g}, found {}", low, high, text);
      },
      "");
}

CLI::Validator whole_number_between(std::int64_t low, std::int64_t high) {
  return CLI::Range(low, high);
}

CLI::Validator whole_number_of_64_bits() {
  return CLI::Validator(
      [](const std::string& text) {
        std::uint64_t value = 0;
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        const bool good = error == std::errc() && end == last;
        return good ? std::string() : fmt::format("expected a whole number from 0 to {}, found {}", UINT64_MAX, text);
      },
      "");
}

CLI::Validator enough_memory() {
  return CLI::Validator(
      [](const std::string& text) {
        std::uint64_t bytes = 0;
        const bool good = CLI::detail::lexical_cast(text, bytes);
        if (good && bytes >= std::uint64_t{1} << 20 && bytes <= std::uint64_t{1} << 62) return std::string();
        if (good && bytes > 0 && bytes < 1024)
          return fmt::format("expected at least 1M, found {} bytes; {}G are {} gibibytes", text, text, text);
        return fmt::format("expected at least 1M, such as 8G, found {}", text);
      },
      "");
}

CLI::Validator one_of(std::vector<std::string> words) {
  return CLI::IsMember(std::move(words));
}

}  // namespace hexpipe
