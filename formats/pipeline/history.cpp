#include "formats/pipeline/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/run_context.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::pipeline {
namespace {

constexpr std::string_view history_folder = "history/";
constexpr std::size_t longest_entry = 1 << 20;
// Entries are copied and written level by level by nested calls; ours have four levels.
constexpr int deepest_nesting = 64;
constexpr std::size_t longest_tool = 64;

// The text need not be JSON. Brackets in strings do not count.
bool nests_too_deep(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"')
      in_string = !in_string;
    else if (in_string)
      i += c == '\\' ? 1 : 0;
    else if (c == '[' || c == '{')
      depth += 1;
    else if (c == ']' || c == '}')
      depth -= 1;
    if (depth > deepest_nesting) return true;
  }
  return false;
}

// The name becomes a part of a member's name.
void check_tool_name(const std::string& name, const std::string& where) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-'; };
  if (name.empty() || name.size() > longest_tool || !std::ranges::all_of(name, allowed))
    throw DataError::at(where, "expected a tool named by 1 to {} of a to z, 0 to 9 and '-', found {}", longest_tool,
                        name.empty() ? "''" : formats::quote_found(name));
}

}  // namespace

bool is_history_entry(std::string_view member) {
  return member.starts_with(history_folder);
}

nlohmann::ordered_json history_entry_of(const RunContext& context) {
  return {{"tool", context.info.name}, {"version", version()}, {"options", context.options}};
}

nlohmann::ordered_json read_history_entry(BundleReader& reader, std::string* text) {
  std::string read = reader.read_text(longest_entry);
  if (nests_too_deep(read))
    throw DataError::at(reader.where(), "expected a JSON object of at most {} levels, found more", deepest_nesting);
  auto entry = nlohmann::ordered_json::parse(read, nullptr, false);
  if (!entry.is_object() || (entry.contains("tool") && !entry["tool"].is_string()))
    throw DataError::at(reader.where(), "expected a JSON object with the name of a tool, found something else");
  if (entry.contains("tool")) check_tool_name(entry["tool"].get<std::string>(), reader.where());
  if (entry.contains("version") && !entry["version"].is_string())
    throw DataError::at(reader.where(), "expected a version that is text, found something else");
  if (entry.contains("options") && !entry["options"].is_object())
    throw DataError::at(reader.where(), "expected options as a JSON object, found something else");
  if (text) *text = std::move(read);
  return entry;
}

std::string tool_of(const nlohmann::ordered_json& entry) {
  return entry.value("tool", "stage");
}

std::string history_member(int number, const nlohmann::ordered_json& entry) {
  return fmt::format("{}{:02}-{}.json", history_folder, number, tool_of(entry));
}

void write_history_entry(BundleWriter& writer, const std::string& member, const nlohmann::ordered_json& entry) {
  writer.add_text(member, entry.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void write_history(BundleWriter& writer, const std::vector<nlohmann::ordered_json>& history) {
  int number = 0;
  for (const auto& entry : history) write_history_entry(writer, history_member(++number, entry), entry);
}

nlohmann::ordered_json settings_of(const std::string& tool, const std::vector<nlohmann::ordered_json>& history) {
  for (auto entry = history.rbegin(); entry != history.rend(); ++entry)
    if (tool_of(*entry) == tool)
      return {{"version", entry->value("version", "")},
              {"options", entry->value("options", nlohmann::ordered_json::object())}};
  return nullptr;
}

}  // namespace hexpipe::pipeline
