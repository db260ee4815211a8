#include "common/run/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe {
namespace {

// Options that name files written beside the product. viewmesh reads its --fragments; that file must not be overwritten
// either.
constexpr std::array<std::string_view, 6> beside_product{
    "stats", "log", "certificate", "fragments", "reduced-candidates", "png"};

struct NamedFile {
  std::string option;  // as the user types it
  std::string file;
};

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code none;
  return std::filesystem::path(a).lexically_normal() == std::filesystem::path(b).lexically_normal() ||
         std::filesystem::equivalent(a, b, none);
}

// Files in /dev may be named twice.
bool is_device(const std::string& file) {
  return file.starts_with("/dev/");
}

const NamedFile* find(const std::vector<NamedFile>& files, const std::string& file) {
  const auto found =
      std::ranges::find_if(files, [&](const NamedFile& other) { return is_same_file(other.file, file); });
  return found == files.end() ? nullptr : &*found;
}

bool is_given(const CLI::App& app, const std::string& name) {
  const CLI::Option* const option = app.get_option_no_throw(name);
  return option != nullptr && option->count() > 0;
}

bool is_written(const CLI::Option& option) {
  return option.check_lname("output") ||
         std::ranges::any_of(beside_product, [&](auto name) { return option.check_lname(std::string(name)); });
}

bool names_files(const CLI::Option& option) {
  return option.get_type_name().find("FILE") != std::string::npos || option.get_type_name() == "DIR";
}

// An unset shell variable leaves an empty name.
void check_none_is_empty(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options())
    if (names_files(*option) && std::ranges::find(option->results(), "") != option->results().end())
      throw UsageError(fmt::format("{}: expected the name of a file, found none", option->get_name()));
}

std::vector<NamedFile> inputs(const CLI::App& app) {
  std::vector<NamedFile> files;
  for (const CLI::Option* option : app.get_options()) {
    if (!names_files(*option) || is_written(*option)) continue;
    for (const std::string& file : option->results())
      if (file != "-") files.push_back({option->get_name(), file});
  }
  return files;
}

}  // namespace

void check_named_files(const CLI::App& app) {
  check_none_is_empty(app);
  const std::vector<NamedFile> read = inputs(app);
  std::vector<NamedFile> written;
  if (const CLI::Option* const product = app.get_option_no_throw("--output")) {
    // A missing -o means standard output. Exceptions: -o that names a directory, and viewmesh when it makes a picture
    // in place of the page.
    if (product->count() > 0)
      written.push_back({"--output", product->results().front()});
    else if (product->get_type_name() != "DIR" && !is_given(app, "--png"))
      written.push_back({"--output", "-"});
  }
  for (const std::string_view name : beside_product) {
    const std::string option = fmt::format("--{}", name);
    if (!is_given(app, option)) continue;
    NamedFile output{option, app.get_option(option)->results().front()};
    if (is_device(output.file)) continue;
    if (const NamedFile* const other = find(written, output.file))
      throw UsageError(fmt::format("expected different files for {} and {}, found {} for both", other->option,
                                   output.option, output.file == "-" ? "standard output" : output.file));
    if (const NamedFile* const input = find(read, output.file))
      throw UsageError(fmt::format("expected different files for {} and {}, found {} for both: it would be lost",
                                   input->option, output.option, output.file));
    written.push_back(std::move(output));
  }
}

}  // namespace hexpipe
