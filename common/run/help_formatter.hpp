#pragma once
// Lays out --help for people: descriptions are wrapped beside their options, to the width of a page.

#include <CLI/CLI.hpp>
#include <string>

namespace hexpipe {

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
};

}  // namespace hexpipe
