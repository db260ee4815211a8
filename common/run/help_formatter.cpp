#include "common/run/command_line.hpp"

#include <sstream>

namespace hexpipe {
namespace {

constexpr std::size_t option_column = 28;
constexpr std::size_t page_width = 100;

// CLI11 shows what a flag sets, as in --no-reductions{false}; users do not type that.
std::string plain_name(const std::string& name) {
  const std::size_t brace = name.find('{');
  return brace == std::string::npos ? name : name.substr(0, brace);
}

std::string line_break() {
  return "\n" + std::string(option_column, ' ');
}

// The list of values to choose from may be longer than a line; cmake/Completion.cmake joins the lines again.
std::string broken_at_comma(const std::string& text) {
  const std::size_t comma = text.size() > page_width ? text.rfind(',', page_width - 1) : std::string::npos;
  return comma == std::string::npos ? text : text.substr(0, comma + 1) + line_break() + text.substr(comma + 1);
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  std::string text =
      broken_at_comma("  " + plain_name(make_option_name(option, is_positional)) + make_option_opts(option));
  if (text.size() + 1 > option_column)
    text += line_break();
  else
    text.resize(option_column, ' ');

  std::istringstream words(make_option_desc(option));
  std::size_t column = option_column;
  for (std::string word; words >> word;) {
    const bool first_in_line = column == option_column;
    if (!first_in_line && column + 1 + word.size() > page_width) {
      text += line_break();
      column = option_column;
    } else if (!first_in_line) {
      text += ' ';
      ++column;
    }
    text += word;
    column += word.size();
  }
  return text + "\n";
}

// CLI11 shows a default of several values in brackets, which users do not type, and shows empty brackets when there is
// no default. It also shows a default for required options.
std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  std::string text = CLI::Formatter::make_option_opts(option);
  const std::string shown = option->get_default_str();
  const std::size_t at = text.find("=" + shown);
  if (shown.empty() || at == std::string::npos) return text;
  if (option->get_required() || shown == "[]") return text.erase(at, 1 + shown.size());
  if (shown.front() == '[' && shown.back() == ']')
    text.replace(at + 1, shown.size(), shown.substr(1, shown.size() - 2));
  return text;
}

}  // namespace hexpipe
