#include "common/run/command_line.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "common/run/option_checks.hpp"

namespace hexpipe {
namespace {

constexpr std::size_t option_column = 28;
constexpr std::size_t page_width = 100;

// CLI11 shows what a flag sets, as in --no-reductions{false}; users do not type that.
std::string plain_name(const std::string& name) {
  const std::size_t brace = name.find('{');
  return brace == std::string::npos ? name : name.substr(0, brace);
}

// That of an option with several values: CLI11 2.4 writes braces.
bool is_empty_default(std::string_view text) {
  return text == "[]" || text == "{}";
}

std::string line_break() {
  return "\n" + std::string(option_column, ' ');
}

// The list of values to choose from may be longer than a line; cmake/Completion.cmake joins the lines again.
std::string broken_at_comma(const std::string& text) {
  const std::size_t comma = text.size() > page_width ? text.rfind(',', page_width - 1) : std::string::npos;
  return comma == std::string::npos ? text : text.substr(0, comma + 1) + line_break() + text.substr(comma + 1);
}

// CLI11's order is that of the first option in each group, which is --help.
std::vector<std::string> ordered_groups(const CLI::App& app) {
  const auto rank = [](const std::string& name) {
    const std::string_view order[] = {group::first, "", group::input, group::output, group::run, group::experts};
    const auto* const found = std::ranges::find(order, name);
    return found == std::end(order) ? std::ranges::find(order, "") : found;
  };
  std::vector<std::string> groups = app.get_groups();
  std::ranges::stable_sort(groups, {}, rank);
  return groups;
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const {
  std::string text = make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
  for (const std::string& group : ordered_groups(*app)) {
    const auto options = app->get_options(
        [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
    if (!options.empty()) text += make_group(group, false, options);
  }
  return text + "\n" + make_footer(app);
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  std::string text =
      broken_at_comma("  " + plain_name(make_option_name(option, is_positional)) + make_option_opts(option));
  // help2man tells an option from its description by two blanks.
  if (text.size() + 2 > option_column)
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
// no default. It also shows a default for required options. From version 2.4 on, each default is in brackets.
std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  std::string text = CLI::Formatter::make_option_opts(option);
  const std::string shown = option->get_default_str();
  const std::string in_brackets = " [" + shown + "] ";
  if (const std::size_t found = text.find(in_brackets); found != std::string::npos)
    text.replace(found, in_brackets.size(), "=" + shown);
  const std::size_t at = text.find("=" + shown);
  if (shown.empty() || at == std::string::npos) return text;
  if (option->get_required() || is_empty_default(shown)) return text.erase(at, 1 + shown.size());
  if (shown.front() == '[' && shown.back() == ']')
    text.replace(at + 1, shown.size(), shown.substr(1, shown.size() - 2));
  return text;
}

}  // namespace hexpipe
