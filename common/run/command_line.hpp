#pragma once
// How a command line is explained: --help, messages about what is wrong in it, and checks of the files that it names.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hexpipe {

// Lays out --help for people: options in groups, those that matter most first, and descriptions wrapped beside their
// options, to the width of a page.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
};

// The explanation of a parse error: the arguments as they were typed, the line of a --config file, and the option that
// was probably meant.
std::string explanation_of(const CLI::App& app, const CLI::ParseError& error);

// The name in `known` (without dashes) that `given` was probably meant to be; `given` is as typed: "--siz", "-size",
// "--min_quality=0.5". If `given` begins only one name, that is the answer. Otherwise it is the name with the fewest
// letters changed, left out, inserted or swapped with the next one, at most a third of them. Empty if there is none.
std::string near_option(std::string_view given, const std::vector<std::string>& known);

// Throws UsageError in three cases. An option names a file by an empty text. Two options write the same file, or both
// write standard output: one of the two outputs would be lost. A file written beside the product, such as statistics,
// would replace a file that is read. The product itself may replace one, because it gets its name after everything is
// read.
void check_named_files(const CLI::App& app);

}  // namespace hexpipe
