#include "common/run/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <vector>

namespace hexpipe {
namespace {

// "did you mean --size? " when something that looks like an option resembles a known one.
std::string guess(const CLI::App& app, const std::vector<std::string>& given) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    known.insert(known.end(), option->get_lnames().begin(), option->get_lnames().end());
  for (const std::string& word : given) {
    const std::string near = word.starts_with('-') ? near_option(word, known) : std::string();
    if (!near.empty()) return fmt::format("did you mean --{}? ", near);
  }
  return {};
}

// CLI11 lists the leftover arguments from the last to the first.
std::string left_over(const std::vector<std::string>& arguments) {
  return fmt::format("The following argument{} not expected: {}", arguments.size() > 1 ? "s were" : " was",
                     fmt::join(arguments, " "));
}

// The number of the line that gives this key a value; 0 if no line does (keys in a section are not looked for).
std::size_t line_of(const std::string& key, const std::string& path) {
  std::ifstream file(path);
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    line.erase(0, std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.substr(0, line.find_first_of("= \t\r")) == key) return number;
  }
  return 0;
}

// CLI11's messages may have several lines; ours have one.
std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string explanation_of(const CLI::App& app, const CLI::ParseError& error) {
  std::string text = one_line(error.what()), meant;
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError) && !app.remaining().empty()) {
    text = left_over(app.remaining());
    meant = guess(app, app.remaining());
  }
  // CLI11 calls the file of --config "INI".
  constexpr std::string_view of_config = "INI was not able to parse ";
  if (text.starts_with(of_config)) {
    std::string key = text.substr(of_config.size());
    if (key.ends_with(".++")) key = fmt::format("[{}]", key.substr(0, key.size() - 3));  // a section
    const std::string path = app.get_config_ptr()->as<std::string>();
    const std::size_t line = line_of(key, path);
    text = fmt::format("{}{}: expected the name of an option, found '{}'", path,
                       line > 0 ? fmt::format(":{}", line) : std::string(), key);
    meant = guess(app, {"--" + key});
  }
  return fmt::format("{} ({}see {} --help)", text, meant, app.get_name());
}

}  // namespace hexpipe
