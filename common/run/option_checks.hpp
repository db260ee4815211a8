#pragma once
// Three things that CLI11 lacks: stricter checks of values (its ranges let NaN pass, and its unsigned integers wrap
// around), a mark for options that stay out of the history, and groups of options that are declared together. And its
// templates for the types that most options have, which are compiled once.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

// For each tool again they would take as long as all the rest of its main.cpp.
extern template CLI::Option* CLI::App::add_option<std::string>(std::string, std::string&, std::string);
extern template CLI::Option* CLI::App::add_option<std::vector<std::string>>(std::string, std::vector<std::string>&,
                                                                            std::string);
extern template CLI::Option* CLI::App::add_option<std::optional<std::string>>(std::string, std::optional<std::string>&,
                                                                              std::string);
extern template CLI::Option* CLI::App::add_option<double>(std::string, double&, std::string);
extern template CLI::Option* CLI::App::add_option<std::optional<double>>(std::string, std::optional<double>&,
                                                                         std::string);
extern template CLI::Option* CLI::App::add_option<int>(std::string, int&, std::string);
extern template CLI::Option* CLI::App::add_option<std::uint64_t>(std::string, std::uint64_t&, std::string);
extern template CLI::Option* CLI::App::add_flag<bool>(std::string, bool&, std::string);

namespace hexpipe {

// Accepts a number in [low, high].
CLI::Validator number_between(double low, double high);

// Accepts a whole number in [low, high], and says so in --help.
CLI::Validator whole_number_between(std::int64_t low, std::int64_t high);

// Accepts an unsigned integer of 64 bits in decimal digits.
CLI::Validator whole_number_of_64_bits();

// Accepts a size of memory that CLI11 has turned into bytes. A small number is one whose unit was forgotten.
CLI::Validator enough_memory();

// Accepts one of these words, which --help lists.
CLI::Validator one_of(std::vector<std::string> words);

// The words are the keys.
template <class Value>
CLI::Validator one_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> words;
  for (const auto& [word, value] : values) words.push_back(word);
  return one_of(std::move(words));
}

// Groups of --help that several tools have. It lists `first` first, then a tool's own groups, then the others.
namespace group {
inline constexpr const char *first = "Options", *input = "Input", *output = "Output", *run = "This run",
                            *experts = "For experts";
}  // namespace group

// Lists the options that are declared from here on in this group.
inline void begin_group(CLI::App& app, const char* name) {
  app.option_defaults()->group(name);
}

// The options of the command line that are marked so; tool_main begins with none. CLI11 has no place for a mark. A
// named check would be one, but asking for it throws where it is missing, and the first exception of a process brings
// 0.3 MiB of tables into its memory.
inline std::set<const CLI::Option*>& options_outside_history() {
  static std::set<const CLI::Option*> options;
  return options;
}

// Marks an option that says where files are or how to run, but does not change the result. It stays out of the history,
// so that the same input and options give the same bytes.
inline CLI::Option* outside_history(CLI::Option* option) {
  options_outside_history().insert(option);
  return option;
}

}  // namespace hexpipe
